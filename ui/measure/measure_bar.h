#pragma once

#include <array>
#include <optional>

#include "core/placing/measure.h"
#include "ui/length_unit.h"
#include "ui/view_bar.h"

class QHBoxLayout;
class QLabel;
class QPushButton;

namespace nearfit::ui {

/// What the measuring tool asks for and tells, over the lower edge of the view.
class MeasureBar : public ViewBar {
  Q_OBJECT

 public:
  explicit MeasureBar(QWidget* view);

  /// @param hint  What is under the pointer; may be empty.
  void showPrompt(const QString& prompt, const QString& hint);
  /// Nothing: there is none yet.
  /// @param measurement  In the world.
  void showMeasurement(const std::optional<Measurement>& measurement, LengthUnit unit);

 signals:
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
