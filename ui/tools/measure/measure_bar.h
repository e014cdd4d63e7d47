#pragma once

#include <array>
#include <optional>

#include "core/placing/measure.h"
#include "ui/widgets/length_unit.h"
#include "ui/widgets/view_bar.h"

class QHBoxLayout;
class QLabel;
class QPushButton;

namespace nearfit::ui {

/// The measuring tool's bar: prompt, values, copy and close.
class MeasureBar : public ViewBar {
  Q_OBJECT

 public:
  explicit MeasureBar(QWidget* view);

  /// Shows what to do next.
  /// @param hint  The feature under the pointer; may be empty.
  void showPrompt(const QString& prompt, const QString& hint);
  /// Shows the values in that unit; nullopt clears them.
  /// @param measurement  World frame.
  void showMeasurement(const std::optional<Measurement>& measurement, LengthUnit unit);

 signals:
  /// Emitted by Close.
  void closed();

 private:
  struct Value {
    QLabel *name, *number;
  };
  Value addValue(QHBoxLayout& row, const char* name, const QString& title, const QString& toolTip);
  void copy() const;

  QLabel *prompt_, *hint_;
  std::array<Value, 6> values_;  ///< Distance, x, y, z, perpendicular, angle.
  QPushButton *copy_, *close_;
};

}  // namespace nearfit::ui
