#pragma once

#include <QLabel>

#include "core/placing/gizmo_drag.h"
#include "ui/length_unit.h"

namespace nearfit::ui {

/// How far a drag has come, beside the pointer.
class DragReadout : public QLabel {
  Q_OBJECT

 public:
  explicit DragReadout(QWidget* view);

  /// @param note  A second line, for what is in the way; may be empty.
  void showAt(const QPoint& pointer, const QString& text, const QString& note);
};

/// "X +12.30 mm", "Y +1.00  Z −3.40 mm" or "+15.0°": along the gizmo's axes, of which those count that the
/// handle moves along.
/// @param shift  In the world [m].   @param angle  [rad].   @param pixel  What a pixel is wide there [m]: no
///               digits are shown that the pointer cannot reach.
QString dragText(const GizmoDrag& drag, const glm::dvec3& shift, double angle, double pixel, LengthUnit unit);

}  // namespace nearfit::ui
