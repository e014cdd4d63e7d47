#pragma once

#include <QObject>
#include <QPoint>
#include <functional>
#include <optional>

#include "core/placing/gizmo_drag.h"
#include "core/placing/gizmo_layout.h"

class QKeyEvent;
class QMouseEvent;

namespace nearfit::ui {

class DragReadout;
class GizmoOverlay;
class Viewport;

/// The gizmo as the mouse has it: shows it over a view, lights up what is under the pointer, and turns drags
/// into motions. Knows nothing of parts. Whatever is no drag of a handle, or of what may be dragged directly,
/// is the view's.
class GizmoControl : public QObject {
  Q_OBJECT

 public:
  /// @param view  Outlives this.
  /// @param name, readout  Of what is drawn of it, and of what a drag says.
  explicit GizmoControl(Viewport& view, const QString& name = QStringLiteral("gizmo"),
                        const QString& readout = QStringLiteral("dragReadout"));

  /// Where it stands; nothing: there is none. A drag goes on.
  void setFrame(const std::optional<GizmoFrame>& frame);
  void setMode(GizmoMode mode);
  /// What turns and shifts snap to, whenever they do.
  void setSteps(const SnapSteps& steps) { steps_ = steps; }
  /// Whether they do; Ctrl makes it the other way round while it is held.
  void setSnapping(bool isSnapping);
  /// Says of a place of the view which point of the world is dragged directly from there; nothing: none.
  void setDirectDrag(std::function<std::optional<glm::dvec3>(const QPoint&)> grab) {
    grab_ = std::move(grab);
  }

  /// Says beside the pointer what a drag has come to, instead of how far it has gone; empty: the latter.
  void setReadout(std::function<QString()> text) { text_ = std::move(text); }

  bool isDragging() const noexcept { return drag_.has_value(); }
  /// Of the drag.
  GizmoHandle handle() const noexcept { return drag_->handle(); }
  /// Of the drag, as it stood when that began.
  const GizmoFrame& frameAtStart() const noexcept { return drag_->frame(); }
  /// Shows how far what is dragged has come, which may be less than the pointer asks for.
  /// @param note  What is in the way; may be empty.
  void showReached(const RigidTransform& motion, const QString& note);
  /// Ends a drag without telling anybody.
  void abandon();

  bool eventFilter(QObject* watched, QEvent* event) override;

 signals:
  /// A drag begins; whoever cannot follow calls abandon().
  void began(nearfit::GizmoHandle handle);
  /// What stood at a point p of the world at the start is wanted at motion(p).
  void dragged(const nearfit::RigidTransform& motion);
  void ended();
  /// By Escape or another button: all is to be as it was.
  void cancelled();

 private:
  /// What was pressed and may become a drag.
  struct Pressed {
    QPoint at;
    GizmoHandle handle = GizmoHandle::None;
    std::optional<glm::dvec3> grabbed;
  };

  bool press(const QMouseEvent& event);
  bool move(const QMouseEvent& event);
  bool release(const QMouseEvent& event);
  bool key(QEvent& event);
  void begin(const Pressed& pressed);
  void follow();
  void letGo();
  void cancel();
  void forgetDrag();
  void hover(const QPoint& pointer);
  void refresh();
  SnapSteps steps() const;

  Viewport& view_;
  GizmoOverlay* overlay_;
  DragReadout* readout_;
  std::function<std::optional<glm::dvec3>(const QPoint&)> grab_;
  std::function<QString()> text_;
  std::optional<GizmoFrame> frame_;
  GizmoMode mode_ = GizmoMode::Hidden;
  SnapSteps steps_;
  bool isSnapping_ = false, isControlHeld_ = false;

  std::optional<Pressed> pressed_;
  std::optional<GizmoDrag> drag_;
  bool isSwallowing_ = false;  ///< The button of a drag that is over is still down.
  QPoint pointer_;
  GizmoHandle hot_ = GizmoHandle::None;
  RigidTransform reached_;
  QString note_;
};

}  // namespace nearfit::ui
