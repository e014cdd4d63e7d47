#pragma once

#include "core/scene/joint_set.h"

namespace nearfit {

/// The pose nearest to `wanted` at which a part is on its joints (JointSet::nearestPose): for typed poses, and for a
/// part that is dragged by itself. Throws UsageError if there is no such part.
inline RigidTransform poseOnJoints(const Scene& scene, PartId id, const RigidTransform& wanted) {
  const Part& part = scene.get(id);
  const glm::dvec3 centre = part.geometry != nullptr ? part.geometry->mass.centre : glm::dvec3(0.0);
  return jointsOf(scene, id).nearestPose(wanted, centre);
}

}  // namespace nearfit
