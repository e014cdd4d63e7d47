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

/// Operates a gizmo by mouse: shows it over a view, highlights the handle under the pointer and turns drags
/// into motions. Knows nothing of parts. Takes only drags of a handle, or of what setDirectDrag() allows; all
/// other events pass on to the view.
///
/// Digits typed during a drag are its amount, in the shown unit of length or in degrees: Return or the release of the
/// button applies it, Backspace corrects it, a minus changes its sign, Escape cancels the drag.
class GizmoControl : public QObject {
  Q_OBJECT

 public:
  /// @param view     Outlives this; the parent.
  /// @param name     Object name of the gizmo's overlay.
  /// @param readout  Object name of the drag's readout.
  explicit GizmoControl(Viewport& view, const QString& name = QStringLiteral("gizmo"),
                        const QString& readout = QStringLiteral("dragReadout"));

  /// Sets where the gizmo stands in the world; nullopt hides it. Does not end a drag.
  void setFrame(const std::optional<GizmoFrame>& frame);
  /// Sets which handles the gizmo has.
  void setMode(GizmoMode mode);
  /// Sets the steps for snapping.
  void setSteps(const SnapSteps& steps) { steps_ = steps; }
  /// Turns snapping on or off; Ctrl inverts that while held.
  void setSnapping(bool isSnapping);
  /// Sets a function that returns the world point grabbed by a direct drag from a pixel of
  /// the view; nullopt: none.
  void setDirectDrag(std::function<std::optional<glm::dvec3>(const QPoint&)> grab) {
    grab_ = std::move(grab);
  }

  /// Sets a function for the text beside the pointer during a drag; if that is empty, the shift or turn.
  void setReadout(std::function<QString()> text) { text_ = std::move(text); }

  bool isDragging() const noexcept { return drag_.has_value(); }
  /// The handle dragged; only while dragging.
  GizmoGrip handle() const noexcept { return drag_->handle(); }
  /// The frame when the drag began; only while dragging.
  const GizmoFrame& frameAtStart() const noexcept { return drag_->frame(); }
  /// Shows how far the dragged object has come, which may be less than the pointer asks for.
  /// @param motion  As in dragged().
  /// @param note    What is in the way; may be empty.
  void showReached(const RigidTransform& motion, const QString& note);
  /// Ends a drag without a signal.
  void abandon();

  bool eventFilter(QObject* watched, QEvent* event) override;

 signals:
  /// Emitted when a drag begins; a receiver that cannot follow calls abandon().
  void began(nearfit::GizmoGrip handle);
  /// Emitted when a drag moves: what was at a world point p at its start is wanted at motion(p).
  void dragged(const nearfit::RigidTransform& motion);
  /// Emitted when the button is released, or a typed amount is applied.
  void ended();
  /// Emitted when Escape or another button cancels the drag: everything must be as before.
  void cancelled();

 private:
  /// A press that may become a drag.
  struct Pressed {
    QPoint at;
    GizmoGrip handle = GizmoGrip::None;
    std::optional<glm::dvec3> grabbed;
  };

  bool press(const QMouseEvent& event);
  bool move(const QMouseEvent& event);
  bool release(const QMouseEvent& event);
  bool key(QEvent& event);
  /// True if a key belongs to an amount that is typed.
  bool isOfAmount(const QKeyEvent& event) const;
  void type(const QKeyEvent& event);
  /// Ends the drag where it is, while the button is still down.
  void apply();
  QString typedText() const;
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
  QString typed_;              ///< Amount being typed; empty: the pointer decides.
  bool isSwallowing_ = false;  ///< A drag is over, but its button is still down.
  QPoint pointer_;
  GizmoGrip hot_ = GizmoGrip::None;
  RigidTransform reached_;
  QString note_;
};

}  // namespace nearfit::ui
