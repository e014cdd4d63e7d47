#include "ui/model/hand_state.h"

#include <utility>

namespace nearfit::ui {

HandState::HandState(const Session& session, QObject* parent) : QObject(parent), session_(session) {}

std::optional<PartId> HandState::part() const {
  return status_.isRunning ? session_.scene().movingPart() : std::nullopt;
}

void HandState::showStatus(const ServoStatus& status) {
  const ServoStatus before = std::exchange(status_, status);
  const bool hasChanged = status.isRunning != before.isRunning || status.isOpening != before.isOpening ||
                          status.hand != before.hand;
  if (hasChanged && part()) {
    const Part* held = session_.scene().find(*part());
    if (held != nullptr) handPose_ = partPose_ = held->worldFromPart;
  }
  emit statusChanged(status);
  if (!hasChanged) return;
  if (!status.isRunning) emit snapshotCleared();
  emit changed();
}

void HandState::showSnapshot(const ServoSnapshot& snapshot) {
  partPose_ = snapshot.proxy;
  emit snapshotShown(snapshot);
}

}  // namespace nearfit::ui
