#include "ui/model/hand_state.h"

#include <utility>

#include "core/scene/moving_body.h"
#include "ui/model/shown_poses.h"

namespace nearfit::ui {

HandState::HandState(Session& session, ShownPoses& poses, QObject* parent)
    : QObject(parent), session_(session), poses_(poses) {
  changes_ = session_.onChange(SceneEvents::Stage::Model, [this] { followSession(); });
  // A part that is dragged, previewed or replayed is not where it was felt.
  connect(&poses_, &ShownPoses::changed, this, &HandState::clearKept);
}

std::optional<PartId> HandState::part() const {
  return status_.isRunning ? session_.scene().movingPart() : std::nullopt;
}

bool HandState::holds(std::optional<PartId> part) const {
  return part && status_.isRunning && session_.scene().isMoving(*part);
}

bool HandState::holdsGroup() const {
  return status_.isRunning && session_.scene().movingGroup().has_value();
}

RigidTransform HandState::partPose() const {
  const Part* held = session_.scene().find(part().value_or(PartId{}));
  return held != nullptr ? poses_.heldPoseOf(*held) : RigidTransform{};
}

void HandState::showStatus(const ServoStatus& status) {
  const ServoStatus before = std::exchange(status_, status);
  const bool hasChanged = status.isRunning != before.isRunning || status.isOpening != before.isOpening ||
                          status.hand != before.hand;
  if (hasChanged && part()) {
    const Part* held = session_.scene().find(*part());
    if (held != nullptr) handPose_ = held->worldFromPart;
  }
  emit statusChanged(status);
  if (!hasChanged) return;
  if (!status.isRunning) poses_.show(ShownPoses::Source::Hand, {});
  const bool isPutDown = before.isRunning && !status.isTaken();
  if (isPutDown) keepLast();
  if (!isPutDown && !(before.isRunning && status.isRunning)) clearLast();
  emit changed();
}

void HandState::keepLast() {
  // The servo also stops when its part or its scene is gone.
  const bool isThere = last_ != nullptr && sceneSerial_ == session_.sceneSerial() &&
                       last_->moving == session_.scene().movingPart();
  if (!isThere) return clearLast();
  keptState_ = session_.stateSerial();
  emit snapshotKept(*last_);
}

void HandState::clearLast() {
  last_.reset();
  keptState_.reset();
  emit snapshotCleared();
}

void HandState::clearKept() {
  if (keptState_) clearLast();
}

void HandState::followSession() {
  // Saving changes nothing of the scene. Serials of states go on counting when another scene is opened.
  if (keptState_ && *keptState_ != session_.stateSerial()) clearLast();
}

void HandState::showSnapshot(const ServoSnapshot& snapshot) {
  // Before the view shows the tick.
  const bool isThere = snapshot.moving == session_.scene().movingPart();
  poses_.show(ShownPoses::Source::Hand, isThere ? movedPoses(session_.scene(), snapshot.proxy)
                                                : ShownPoses::Poses{{snapshot.moving, snapshot.proxy}});
  if (last_ == nullptr) last_ = std::make_unique<ServoSnapshot>();
  *last_ = snapshot;
  sceneSerial_ = session_.sceneSerial();
  emit snapshotShown(snapshot);
}

void HandState::noteDrawn(const ServoSnapshot& snapshot) {
  if (status_.isRunning) emit snapshotDrawn(snapshot);
}

}  // namespace nearfit::ui
