#include "tests/stress/pose_checks.h"

namespace nearfit::stress {
PoseChecks::PoseChecks(const StressScene& scene) : scene_(scene) {
  for (const ServoScene::Body& body : scene.scene->bodies)
    certifiers_.emplace_back(body.geometry->mesh, scene.scene->moving.geometry->mesh);
}

void PoseChecks::add(const RigidTransform& worldFromPart, std::uint64_t tick) {
  if (last_ && *last_ == worldFromPart) return;
  last_ = worldFromPart;
  ++certified_;
  if (!isBad(worldFromPart)) return;
  ++meetings_;
  if (firstBad_) return;
  firstBad_ = tick;
  firstBadPose_ = worldFromPart;
}

bool PoseChecks::isBad(const RigidTransform& pose) const {
  for (std::size_t b = 0; b < certifiers_.size(); ++b) {
    const RigidTransform& worldFromBody = scene_.scene->bodies[b].worldFromPart;
    if (certifiers_[b].doMeet(worldFromBody.inverse() * pose)) return true;
  }
  return scene_.isKept && !scene_.isKept(pose);
}

}  // namespace nearfit::stress
