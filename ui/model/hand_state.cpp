#include "ui/model/hand_state.h"

#include <utility>

#include "ui/model/shown_poses.h"

namespace nearfit::ui {

HandState::HandState(const Session& session, ShownPoses& poses, QObject* parent)
    : QObject(parent), session_(session), poses_(poses) {}

std::optional<PartId> HandState::part() const {
  return status_.isRunning ? session_.scene().movingPart() : std::nullopt;
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
  if (!status.isRunning) {
    poses_.show(ShownPoses::Source::Hand, {});
    emit snapshotCleared();
  }
  emit changed();
}

void HandState::showSnapshot(const ServoSnapshot& snapshot) {
  // Before the view shows the tick.
  poses_.show(ShownPoses::Source::Hand, {{snapshot.moving, snapshot.proxy}});
  emit snapshotShown(snapshot);
}

}  // namespace nearfit::ui
