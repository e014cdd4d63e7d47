#pragma once

#include <QObject>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/scene/part.h"
#include "core/session/scene_events.h"
#include "ui/widgets/error_box.h"

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class HandState;
class MoveGuard;
class PosePanel;
class SceneWork;
class Selection;
class ShownPoses;
class Viewport;

/// Shows the selected parts, or the part or group in hand while none is selected, in the pose panel, wherever they
/// are moved from. Requests moves by the panel's numbers, and by the arrow keys of the view, whose steps the panel
/// holds.
class SelectedPose : public QObject {
  Q_OBJECT

 public:
  /// What is shown. All outlive this.
  struct Context {
    Session& session;
    const Selection& selection;
    const ShownPoses& poses;
    const HandState& hand;
    const MoveGuard& guard;
    const SceneWork& work;
    const Viewport& view;
  };

  /// @param panel  The parent.
  SelectedPose(const Context& context, PosePanel& panel);

 public slots:
  /// Shows everything anew.
  void refresh();

 signals:
  /// Emitted when the current part, or the hand that holds it, is to have that pose.
  void moveRequested(const nearfit::RigidTransform& worldFromPart);
  /// Emitted when it is to be shifted [m], and turned, in the world.
  void stepRequested(const glm::dvec3& shift, const glm::dquat& turn);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);

 private:
  void connectPanel();
  /// Returns the parts shown: those selected, else those in hand. The last is current().
  std::vector<PartId> subjects() const;
  /// Returns the part whose pose is shown; null if there is none, or it has just left the scene.
  const Part* current() const;
  /// Returns the pivot of the parts shown, in the frame of the current one [m].
  glm::dvec3 pivotInCurrent() const;
  void showHeldPose();
  void setDensity(double density);
  void showJoints();
  void removeJoints();

  const Context context_;
  PosePanel& panel_;
  Subscription changes_;
};

}  // namespace nearfit::ui
