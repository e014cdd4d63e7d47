#pragma once

#include <QLabel>
#include <QPainter>
#include <QWidget>
#include <optional>

#include "core/placing/gizmo_drag.h"
#include "core/placing/gizmo_layout.h"
#include "ui/widgets/length_unit.h"

namespace nearfit::ui {

/// The state in which a gizmo is drawn.
struct GizmoPicture {
  GizmoLayout layout;
  GizmoGrip hot = GizmoGrip::None;  ///< The handle under the pointer, or dragged.
  bool isDragging = false;          ///< Fades all handles but the hot one.
  std::optional<GizmoGuide> guide;
};

/// Paints a gizmo over a view and all its parts, antialiased at the screen's resolution. A light rim keeps it
/// readable on any part. Only as large as what it shows; ignores the mouse.
class GizmoOverlay : public QWidget {
  Q_OBJECT

 public:
  /// @param view  The parent; layouts are in its pixels.
  explicit GizmoOverlay(QWidget* view);

  /// Shows a gizmo; hides it if its layout is empty.
  void showPicture(GizmoPicture picture);
  void clear();
  const std::optional<GizmoPicture>& picture() const noexcept { return picture_; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QRect extent() const;
  void paintFigure(QPainter& painter, const GizmoFigure& figure) const;
  static void paintGuide(QPainter& painter, const GizmoGuide& guide, const QColor& colour);

  std::optional<GizmoPicture> picture_;
};

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
