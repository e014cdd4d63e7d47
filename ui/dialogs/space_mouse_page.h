#pragma once

#include <QWidget>
#include <array>
#include <functional>
#include <vector>

#include "core/haptics/rate_settings.h"

class QCheckBox;
class QGridLayout;

namespace nearfit::ui {

class NumberField;

/// How a space mouse drives the hand: dead zone, curve, speeds, and which axes, which way. The user's, not
/// the scene's: it is kept from one run to the next, and undo leaves it alone.
class SpaceMousePage : public QWidget {
  Q_OBJECT

 public:
  explicit SpaceMousePage(QWidget* parent = nullptr);

  /// Is no edit.
  void showSettings(const RateSettings& settings);

 signals:
  void edited(const nearfit::RateSettings& settings);

 private:
  struct Number {
    const char* name;
    QString toolTip, unit;
    double lower, upper;  ///< In SI.
    double RateSettings::* value;
  };
  NumberField* addNumber(const Number& number);
  QGridLayout* makeAxes();
  QCheckBox* addSwitch(const QString& name, const QString& toolTip,
                       std::array<bool, 6> RateSettings::* values, std::size_t axis);
  void change(const RateSettings& settings);

  RateSettings settings_;
  std::vector<std::function<void()>> showers_;  ///< Each puts one value into its field.
};

}  // namespace nearfit::ui
