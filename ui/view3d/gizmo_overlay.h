#pragma once

#include <QPainter>
#include <QWidget>
#include <optional>

#include "core/placing/gizmo_layout.h"

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

}  // namespace nearfit::ui
