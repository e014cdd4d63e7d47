#pragma once

#include <QWidget>
#include <functional>
#include <vector>

#include "core/haptics/haptic_settings.h"

class QCheckBox;
class QLabel;

namespace nearfit::ui {

class NumberField;

/// Some of the haptic settings as fields. Each change asks for the whole settings with that one value
/// changed: the others stay what they were, also where a field shows them rounded.
class FeelPage : public QWidget {
  Q_OBJECT

 public:
  using QWidget::QWidget;

  /// Is no edit. Leaves alone what is being typed unless something has changed.
  void showSettings(const HapticSettings& settings);

 signals:
  void edited(const nearfit::HapticSettings& settings);

 protected:
  struct Number {
    const char* name;  ///< Of the object.
    QString toolTip;
    QString unit;
    double lower, upper;  ///< In SI.
    int decimals = 3;
    bool isLength = false;  ///< In the user's unit, then, and decimals are of millimetres.
  };
  using NumberOf = std::function<double&(HapticSettings&)>;
  using SwitchOf = std::function<bool&(HapticSettings&)>;

  /// A field for a value; its limits stand in the tool tip.
  NumberField* addNumber(const Number& number, const NumberOf& valueOf);
  QCheckBox* addSwitch(const QString& name, const QString& text, const QString& toolTip,
                       const SwitchOf& valueOf);
  QLabel* addNote();

  const HapticSettings& settings() const noexcept { return settings_; }
  /// Takes the settings for its own and asks for them.
  void change(const HapticSettings& next);
  /// As change, where other fields of this page than the one that was edited have to follow.
  void replace(const HapticSettings& next);
  /// After every change of settings(), for what depends on it.
  virtual void refresh() {}

 private:
  HapticSettings settings_;
  bool hasShown_ = false;
  std::vector<std::function<void()>> showers_;  ///< Each puts one value into its field.
};

}  // namespace nearfit::ui
