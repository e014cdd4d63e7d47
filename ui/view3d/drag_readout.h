#pragma once

#include <QLabel>

#include "core/placing/gizmo_drag.h"
#include "ui/widgets/length_unit.h"

namespace nearfit::ui {

/// A label beside the pointer that shows how far a drag has come.
class DragReadout : public QLabel {
  Q_OBJECT

 public:
  explicit DragReadout(QWidget* view);

  /// Shows the label.
  /// @param pointer  Pixel of the view.
  /// @param note     Second line, for what is in the way; may be empty.
  void showAt(const QPoint& pointer, const QString& text, const QString& note);
};

/// Returns "X +12.30 mm", "Y +1.00  Z −3.40 mm" or "+15.0°": the shift along those axes of the gizmo that the
/// handle moves along, or the turn.
/// @param shift  World [m].
/// @param angle  [rad]
/// @param pixel  Size of a pixel at the gizmo [m]; sets the decimals, down to about a tenth of a pixel.
QString dragText(const GizmoDrag& drag, const glm::dvec3& shift, double angle, double pixel, LengthUnit unit);

}  // namespace nearfit::ui
