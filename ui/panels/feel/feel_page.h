#pragma once

#include <QWidget>
#include <functional>
#include <vector>

#include "core/haptics/haptic_settings.h"

class QCheckBox;
class QLabel;

namespace nearfit::ui {

class NumberField;

/// Shows some of the haptic settings as fields. Each edit asks for the whole settings with that one value
/// changed; the others keep their exact values even if a field shows them rounded.
class FeelPage : public QWidget {
  Q_OBJECT

 public:
  using QWidget::QWidget;

  /// Shows settings; counts as no edit. Leaves alone what is being typed unless something has changed.
  void showSettings(const HapticSettings& settings);

 signals:
  /// Emitted with the settings that the user asks for.
  void edited(const nearfit::HapticSettings& settings);

 protected:
  struct Number {
    const char* name;  ///< Object name of the field.
    QString toolTip;
    QString unit;
    double lower, upper;  ///< In SI units.
    int decimals = 3;
    bool isLength = false;  ///< In the user's unit; `decimals` are of millimetres.
  };
  using NumberOf = std::function<double&(HapticSettings&)>;
  using SwitchOf = std::function<bool&(HapticSettings&)>;

  /// Adds a field for a value; its tooltip tells the limits.
  NumberField* addNumber(const Number& number, const NumberOf& valueOf);
  QCheckBox* addSwitch(const QString& name, const QString& text, const QString& toolTip,
                       const SwitchOf& valueOf);
  QLabel* addNote();

  const HapticSettings& settings() const noexcept { return settings_; }
  /// Adopts the settings and emits edited().
  void change(const HapticSettings& next);
  /// Same as change(), but also updates the other fields of this page.
  void replace(const HapticSettings& next);
  /// Called after every change of settings(), to update what depends on it.
  virtual void refresh() {}

 private:
  HapticSettings settings_;
  bool hasShown_ = false;
  std::vector<std::function<void()>> showers_;  ///< Each shows one value in its field.
};

}  // namespace nearfit::ui
