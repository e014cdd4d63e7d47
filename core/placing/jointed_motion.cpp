#include "core/placing/jointed_motion.h"

#include <algorithm>
#include <map>
#include <set>

#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"
#include "core/placing/keep.h"

namespace nearfit {
namespace {

/// Max rounds over the parts: for joints that fit together, each round brings them nearer.
constexpr int kMaxRounds = 16;

}  // namespace

JointedMotion::JointedMotion(const Scene& scene, const std::vector<PartId>& parts) {
  const std::set<PartId> moved(parts.begin(), parts.end());
  std::map<PartId, std::vector<JointSet::Placed>> placed;
  for (const Joint& joint : scene.joints()) {
    const bool isInner = joint.base && moved.contains(*joint.base);
    if (joint.isOn && moved.contains(joint.part) && !isInner)
      placed[joint.part].push_back(placedJoint(joint, worldFromBase(scene, joint)));
  }
  for (const auto& [id, joints] : placed) {
    const Part& part = scene.get(id);
    const glm::dvec3 centre = part.geometry != nullptr ? part.geometry->mass.centre : glm::dvec3(0.0);
    kept_.push_back({JointSet(joints, part.worldFromPart), part.worldFromPart, centre});
  }
}

RigidTransform JointedMotion::nearest(const RigidTransform& wanted) const noexcept {
  RigidTransform motion = wanted;
  for (int round = 0; round < kMaxRounds; ++round) {
    bool isKept = true;
    for (const Kept& part : kept_) {
      const RigidTransform pose = (motion * part.start).normalized();
      const RigidTransform on = part.joints.nearestPose(pose, part.centre);
      if (on == pose) continue;
      isKept = false;
      motion = (on * part.start.inverse()).normalized();
    }
    if (isKept || kept_.size() == 1) break;
  }
  // Rounding must not make a step of undo of a motion that the joints do not allow.
  return areApart(wanted, motion) && !areApart(motion, {}) ? RigidTransform{} : motion;
}

bool JointedMotion::areApart(const RigidTransform& a, const RigidTransform& b) const noexcept {
  const double angle = glm::length(rotationVector(b.rotation * glm::conjugate(a.rotation)));
  return std::ranges::any_of(kept_, [&](const Kept& part) {
    const glm::dvec3 centre = part.start.applyToPoint(part.centre);
    return glm::distance(a.applyToPoint(centre), b.applyToPoint(centre)) > JointSet::kMaxMisfit ||
           angle > JointSet::kMaxMisfitAngle;
  });
}

}  // namespace nearfit
