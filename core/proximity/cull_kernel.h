#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/math/rigid_transform.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// A pose in single precision, for bounds only.
struct SinglePose {
  std::array<std::array<float, 4>, 4>
      columns;  ///< Three of the rotation, then the translation; fourth entry 0.

  explicit SinglePose(const RigidTransform& pose) noexcept;
  NormalConeTree::Bound apply(const NormalConeTree::Bound& b) const noexcept;
};

/// What a pair of bounds is held against besides the bounds themselves.
struct CullLimits {
  float cutoff;   ///< [m]
  float padding;  ///< What the spheres may be off by through rounding of the pose [m]; added to both.
};

/// Which children of a node can hold a minimum together with features inside `other`: bit per lane.
///
/// Culls by distance, by cones that cannot oppose each other, and by directions between the spheres that
/// neither cone allows. Never culls a pair that holds a minimum.
/// @param other  A bound of the other body in the node's frame.
/// Real-time safe. Source: Johnson & Cohen 2001.
using CullKernel = std::uint32_t (*)(const NormalConeTree::Node& node, const NormalConeTree::Bound& other,
                                     const CullLimits& limits) noexcept;

enum class SimdLevel : std::uint8_t { Portable, Avx2, Avx512 };

/// Levels that this machine runs, best last.
std::span<const SimdLevel> availableSimdLevels() noexcept;

/// The kernel for a level that the machine has.
CullKernel cullKernel(SimdLevel level) noexcept;

/// The level that queries use: the best, unless the environment variable NEARFIT_SIMD (portable, avx2,
/// avx512) names a lower one.
SimdLevel defaultSimdLevel() noexcept;

}  // namespace nearfit
