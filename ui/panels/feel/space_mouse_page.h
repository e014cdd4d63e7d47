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

/// Edits how a space mouse drives the hand: dead zone, curve, speeds, and which axes in which direction. The
/// settings belong to the user, not to the scene: they are kept between runs, and undo leaves them alone.
class SpaceMousePage : public QWidget {
  Q_OBJECT

 public:
  explicit SpaceMousePage(QWidget* parent = nullptr);

  /// Shows settings; counts as no edit.
  void showSettings(const RateSettings& settings);

 signals:
  /// Emitted with the settings that the user asks for.
  void edited(const nearfit::RateSettings& settings);

 private:
  struct Number {
    const char* name;
    QString toolTip, unit;
    double lower, upper;  ///< In SI units.
    double RateSettings::* value;
  };
  NumberField* addNumber(const Number& number);
  QGridLayout* makeAxes();
  QCheckBox* addSwitch(const QString& name, const QString& toolTip,
                       std::array<bool, 6> RateSettings::* values, std::size_t axis);
  void change(const RateSettings& settings);

  RateSettings settings_;
  std::vector<std::function<void()>> showers_;  ///< Each shows one value in its field.
};

}  // namespace nearfit::ui
