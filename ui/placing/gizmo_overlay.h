#pragma once

#include <QPainter>
#include <QWidget>
#include <optional>

#include "core/placing/gizmo_layout.h"

namespace nearfit::ui {

/// What of a gizmo is to be seen.
struct GizmoPicture {
  GizmoLayout layout;
  GizmoHandle hot = GizmoHandle::None;  ///< Under the pointer, or dragged.
  bool isDragging = false;              ///< The others step back.
  std::optional<GizmoGuide> guide;
};

/// Draws a gizmo over a view, as sharp as the screen allows: over all parts, and light-rimmed, so that it is
/// read on light and dark ones. As large as what it shows; the mouse goes through.
class GizmoOverlay : public QWidget {
  Q_OBJECT

 public:
  /// @param view  What it lies over; pixels of pictures are this widget's.
  explicit GizmoOverlay(QWidget* view);

  /// Nothing is shown of an empty layout.
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
