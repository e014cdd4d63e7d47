#pragma once

#include <QObject>
#include <optional>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/scene/part.h"
#include "core/session/scene_events.h"
#include "ui/model/pose_subject.h"
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

/// Shows the selected parts, or the part or group in hand (PoseSubject), in the pose panel, wherever they are moved
/// from. Requests moves by the panel's numbers, and by the arrow keys of the view, whose steps the panel holds.
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
  /// Emitted when the part that leads what is shown, or the hand that holds it, is to have that pose.
  void moveRequested(const nearfit::RigidTransform& worldFromPart);
  /// Emitted when it is to be shifted [m], and turned, in the world.
  void stepRequested(const glm::dvec3& shift, const glm::dquat& turn);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);

 private:
  void connectPanel();
  PoseSubject subject() const;
  /// Returns the part whose pose is shown; null if there is none, or it has just left the scene.
  const Part* lead(const PoseSubject& subject) const;
  void showHeldPose();
  void showMass(const PoseSubject& subject);
  /// Shows where the centre of mass of the group in hand is now.
  void showCentre(const Part& lead);
  void setDensity(double density);
  void showJoints(const PoseSubject& subject);
  /// Returns the joints of the part that leads; of the group in hand those that keep its parts on others.
  std::vector<Joint> shownJoints(const PoseSubject& subject) const;
  void removeJoints();

  const Context context_;
  PosePanel& panel_;
  /// Centre of mass of the group in hand, in the frame of the part that leads it [m]; nullopt: something else is shown.
  std::optional<glm::dvec3> centreInLead_;
  Subscription changes_;
};

}  // namespace nearfit::ui
