#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/math/rigid_transform.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// A pose in single precision, for bounds only.
class SinglePose {
 public:
  explicit SinglePose(const RigidTransform& pose) noexcept;

  /// Three of the rotation, then the translation; fourth entries 0.
  const std::array<std::array<float, 4>, 4>& columns() const noexcept { return columns_; }

 private:
  std::array<std::array<float, 4>, 4> columns_;
};

/// What a pair of bounds is held against besides the bounds themselves.
struct CullLimits {
  float cutoff;   ///< [m]
  float padding;  ///< What a box may be off by through rounding of the pose, or motion to come [m].
  float turn;     ///< What directions may be off by through rounding, or turning to come [rad].
};

/// A motion of the part that bounds must allow for besides: each of its points x goes from where it is by up
/// to shift + spin x (x - about), either way.
struct CullSweep {
  std::array<float, 3> shift{}, spin{}, about{};
  float spinLength = 0.0F;
};

/// Eight pairs of bounds, each side in its own frame, lane by lane.
struct alignas(64) BoundPairs {
  NormalConeTree::Node scene, part;  ///< Of each, the bounds; the children are the leaves.
};

/// Which of eight pairs of bounds can hold a minimum: bit per lane.
///
/// A minimum's d joins a point of one box to a point of the other, is no longer than the cutoff, and its
/// direction is within the limits of both. Culls where the projections on the axes of either box rule that
/// out. Never culls a pair that holds a minimum.
/// Real-time safe. Source: Johnson & Cohen 2001, with oriented boxes in place of spheres.
using PairCullKernel = std::uint32_t (*)(const BoundPairs& pairs, const SinglePose& sceneFromPart,
                                         const CullLimits& limits) noexcept;

/// The same for every pose along a sweep, in the scene's frame.
using SweptPairCullKernel = std::uint32_t (*)(const BoundPairs& pairs, const SinglePose& sceneFromPart,
                                              const CullLimits& limits, const CullSweep& sweep) noexcept;

enum class SimdLevel : std::uint8_t { Portable, Avx2, Avx512 };

/// Levels that this machine runs, best last.
std::span<const SimdLevel> availableSimdLevels() noexcept;

/// The kernels for a level that the machine has.
PairCullKernel pairCullKernel(SimdLevel level) noexcept;
SweptPairCullKernel sweptPairCullKernel(SimdLevel level) noexcept;

/// The level that queries use: the best, unless the environment variable NEARFIT_SIMD (portable, avx2,
/// avx512) names a lower one.
SimdLevel defaultSimdLevel() noexcept;

}  // namespace nearfit
