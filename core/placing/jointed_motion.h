#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/placing/joint_set.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Keeps parts that are moved together on their joints. Joints between two of them move along and hold nothing.
class JointedMotion {
 public:
  /// No joints: every motion is as wanted.
  JointedMotion() = default;
  /// @param scene  All parts where they are at the start.
  /// @param parts  Parts of `scene`. O(n log n) in them and the joints.
  JointedMotion(const Scene& scene, const std::vector<PartId>& parts);

  /// True if no joint holds the parts.
  bool isFree() const noexcept { return kept_.empty(); }
  /// The motion near the wanted one that leaves the parts on their joints. With joints on several parts that is found
  /// by turns, and as near to all of them as a few rounds lead.
  /// Exactly the identity if they allow next to nothing of it.
  /// @param wanted  worldFromWorld, from the start; unit quaternion. Returned as it is if isFree(), or if it leaves the
  ///                parts on their joints.
  RigidTransform nearest(const RigidTransform& wanted) const noexcept;
  /// True if two motions put a part that joints hold at poses apart by more than joints on picked features fit
  /// together (JointSet::kMaxMisfit, kMaxMisfitAngle).
  bool areApart(const RigidTransform& a, const RigidTransform& b) const noexcept;

 private:
  struct Kept {
    JointSet joints;
    RigidTransform start;  ///< worldFromPart.
    glm::dvec3 centre;     ///< In the part's frame [m].
  };
  std::vector<Kept> kept_;
};

}  // namespace nearfit
