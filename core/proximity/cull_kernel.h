#pragma once

#include <cstdint>

#include "core/math/rigid_transform.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// A pose in single precision, for bounds only.
struct SinglePose {
  float r[3][3];
  float t[3];

  explicit SinglePose(const RigidTransform& pose) noexcept;
  NormalConeTree::Bound apply(const NormalConeTree::Bound& b) const noexcept;
};

/// Which children of a node can hold a minimum together with features inside `other`: bit per lane.
///
/// Culls by distance, by cones that cannot oppose each other, and by directions between the spheres that
/// neither cone allows. Never culls a pair that holds a minimum within the padding's reach.
/// @param other  A bound of the other body in the node's frame.
/// @param cutoff   [m]
/// @param padding  What the spheres may be off by through rounding of the pose [m]; added to both.
/// Real-time safe. Source: Johnson & Cohen 2001.
std::uint32_t survivingChildren(const NormalConeTree::Node& node, const NormalConeTree::Bound& other,
                                float cutoff, float padding) noexcept;

}  // namespace nearfit
