#pragma once

#include <QObject>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

class QAction;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class HandState;
class MoveGuard;
class PlacingTools;
class Selection;
class Viewport;

/// Moves the manual hand: by mouse, keys, numbers and the gizmo. Numbers and keys for a part that is not in
/// hand go to the placing tools.
class HandControl : public QObject {
  Q_OBJECT

 public:
  /// What it moves, and by what. All outlive this.
  struct Context {
    const Session& session;
    const Selection& selection;
    const MoveGuard& guard;
    HandState& hand;
    PlacingTools& placing;
    Viewport& view;
  };
  HandControl(const Context& context, QObject* parent);

  /// Returns the action that puts the hand where the part is, so that it presses no more.
  QAction* letGoAction() const noexcept { return letGo_; }

 public slots:
  /// Moves the selected parts, or what is in hand while none is selected, so that the part that leads them gets that
  /// pose (PoseSubject). What is in the manual hand is moved by that hand.
  void place(const nearfit::RigidTransform& worldFromPart);
  /// Moves the manual hand, if it holds a part, else the selected parts.
  /// @param shift  World [m].
  /// @param turn   In the world frame, about the part's pivot, or that of the group in hand; of the hand, about the
  ///               centre of mass.
  void step(const glm::dvec3& shift, const glm::dquat& turn);

 signals:
  /// Emitted when the manual hand moves; the pose is where it wants the part.
  void handMoved(const nearfit::RigidTransform& worldFromPart);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 private:
  void connectHand();
  /// Tells the placing tools what the servo holds.
  void showHeld();
  /// Moves the hand, except along or about axes that the scene locks, and only where joints let the part be.
  void moveHand(const RigidTransform& worldFromPart);
  /// Moves the hand by a step; does nothing with other hands.
  void stepHand(const glm::dvec3& shift, const glm::dquat& turn);
  void letGo();

  const Context context_;
  QAction* letGo_;
};

}  // namespace nearfit::ui
