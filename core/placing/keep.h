#pragma once

#include <optional>

#include "core/math/rigid_transform.h"
#include "core/placing/feature.h"
#include "core/placing/joint_set.h"
#include "core/scene/joint.h"
#include "core/scene/scene.h"

namespace nearfit {

/// The joint that keeps features of these shapes together once they are aligned: two axes or circles on an axis, two
/// planes in a plane, two points at a point. std::nullopt for any other pair.
std::optional<JointKind> jointKindOf(FeatureShape onPart, FeatureShape onBase) noexcept;

/// A feature of a part, and where the part is.
struct FeatureAt {
  PartId part{};
  AlignFeature inPart;           ///< In the part's frame.
  RigidTransform worldFromPart;  ///< With unit quaternion.
};

/// The joint that keeps a feature on that of a base as they are now.
/// @param kind  As jointKindOf() gives it.
/// @param kept  Aligned with the base's feature. Faces that look the same way are kept so.
/// @param gap   Distance of planes along the base's direction [m]; only InPlane.
Joint jointBetween(JointKind kind, const FeatureAt& kept, const FeatureAt& base, double gap = 0.0);

/// Where the scene has the base of a joint; the identity for the world.
RigidTransform worldFromBase(const Scene& scene, const Joint& joint);

/// A joint in the world, with its base at this pose.
JointSet::Placed placedJoint(const Joint& joint, const RigidTransform& worldFromBase);

/// The pose nearest to `wanted` on a new joint and all others of its part; std::nullopt if the joints contradict each
/// other. Throws UsageError if the scene cannot hold the joint.
/// @param wanted  worldFromPart; it also chooses the sense of axes.
std::optional<RigidTransform> keptPose(const Scene& scene, const Joint& joint, const RigidTransform& wanted);

/// True if a part is off a joint by more than joints on picked features fit together (JointSet::kMaxMisfit). False for
/// a joint that is off.
bool isViolated(const Joint& joint, const RigidTransform& worldFromBase, const RigidTransform& worldFromPart);

}  // namespace nearfit
