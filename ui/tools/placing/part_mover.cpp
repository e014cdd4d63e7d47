#include "ui/tools/placing/part_mover.h"

namespace nearfit::ui {

PartMover::PartMover(QObject* parent) : QObject(parent) {
  connect(&runner_, &SolidRunner::reached, this, &PartMover::showReached);
  connect(&runner_, &SolidRunner::failed, this, [this](const std::exception_ptr& error) {
    giveUp();
    emit failed(error);
  });
}

void PartMover::begin(const Scene& scene, const std::vector<PartId>& parts, bool isSolid) {
  giveUp();
  parts_ = parts;
  isSolid_ = isSolid;
  for (const PartId id : parts)
    start_[id] = scene.find(id)->worldFromPart;
  poses_ = start_;
  joints_ = JointedMotion(scene, parts);
  if (isSolid) runner_.start(scene, parts);
}

void PartMover::moveTo(const RigidTransform& wanted) {
  if (!isUnderWay() || isEnding_) return;
  const RigidTransform motion = joints_.nearest(wanted);
  isHeldByJoints_ = joints_.areApart(wanted, motion);
  if (isSolid_) {
    wanted_ = runner_.want(motion);
    // They stand still until the first answer; show that contact is being prepared.
    if (!hasReached_) emit moved();
    return;
  }
  motion_ = motion;
  hasArrived_ = true;
  for (const auto& [id, pose] : start_)
    poses_[id] = motion * pose;
  emit moved();
}

void PartMover::showReached(const SolidReached& reached) {
  if (!isUnderWay()) return;
  hasReached_ = true;
  for (std::size_t i = 0; i < parts_.size(); ++i)
    poses_[parts_[i]] = reached.poses[i];
  motion_ = reached.motion;
  touching_ = reached.touching;
  hasArrived_ = reached.hasArrived && reached.wanted == wanted_;
  if (reached.isSettled) settled_ = reached.wanted;
  emit moved();
  if (isEnding_ && settled_ == wanted_) endHere();
}

void PartMover::end() {
  if (!isUnderWay() || isEnding_) return;
  if (!isSolid_ || settled_ == wanted_) return endHere();
  isEnding_ = true;
}

void PartMover::endHere() {
  if (!isUnderWay()) return;
  runner_.stop();
  emit ended();
}

void PartMover::giveUp() {
  runner_.stop();
  parts_.clear();
  start_.clear();
  poses_.clear();
  touching_.clear();
  motion_ = {};
  wanted_ = settled_ = 0;
  joints_ = {};
  isSolid_ = isEnding_ = hasReached_ = hasArrived_ = isHeldByJoints_ = false;
}

}  // namespace nearfit::ui
