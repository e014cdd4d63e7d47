#pragma once

#include <QObject>
#include <functional>
#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/scene/part.h"
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
class Viewport;

/// Shows the selected parts in the pose panel, wherever they are moved from. Requests moves by the panel's
/// numbers, and by the arrow keys of the view, whose steps the panel holds.
class SelectedPose : public QObject {
  Q_OBJECT

 public:
  /// What is shown. All outlive this.
  struct Context {
    Session& session;
    const Selection& selection;
    const HandState& hand;
    const MoveGuard& guard;
    const SceneWork& work;
    const Viewport& view;
  };
  /// Returns where a part is now (worldFromPart): dragged, replayed and in hand included.
  using PoseOf = std::function<RigidTransform(const Part&)>;

  /// @param panel  The parent.
  SelectedPose(const Context& context, PoseOf poseOf, PosePanel& panel);

 public slots:
  /// Shows everything anew.
  void refresh();
  /// Shows the pose anew, unless the part is in hand, whose ticks show it.
  void refreshPose();

 signals:
  /// Emitted when the current part, or the hand that holds it, is to have that pose.
  void moveRequested(const nearfit::RigidTransform& worldFromPart);
  /// Emitted when it is to be shifted [m], and turned about its centre of mass, in the world.
  void stepRequested(const glm::dvec3& shift, const glm::dquat& turn);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);

 private:
  void connectPanel();
  /// Returns the current part; null if there is none, or it has just left the scene.
  const Part* current() const;
  void showHeldPose();
  void setDensity(double density);

  const Context context_;
  const PoseOf poseOf_;
  PosePanel& panel_;
};

}  // namespace nearfit::ui
