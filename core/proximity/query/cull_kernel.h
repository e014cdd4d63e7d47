#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/math/rigid_transform.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit {

/// Pose in single precision, for bounds only.
class SinglePose {
 public:
  explicit SinglePose(const RigidTransform& pose) noexcept;

  /// Three columns of the rotation, then the translation [m]; fourth entries are 0.
  const std::array<std::array<float, 4>, 4>& columns() const noexcept { return columns_; }

 private:
  std::array<std::array<float, 4>, 4> columns_;
};

/// Cutoff and tolerances of a cull.
struct CullLimits {
  float cutoff;   ///< [m]
  float padding;  ///< Error of a box through rounding of the pose or future motion [m].
  float turn;     ///< Error of directions through rounding or future rotation [rad].
};

/// Motion of the part that bounds must also allow for: it moves each point x by up to shift + spin x (x -
/// about), in either sense. `spinLength` is |spin| rounded up [rad]; lengths are in metres.
struct CullSweep {
  std::array<float, 3> shift{}, spin{}, about{};
  float spinLength = 0.0F;
};

/// Eight pairs of bounds, one per lane, each side in its own frame.
struct alignas(64) BoundPairs {
  NormalConeTree::Node scene, part;  ///< The bounds of each side; its children are the leaves.
};

/// Returns which of eight pairs of bounds can hold a minimum, one bit per lane.
///
/// A minimum's d joins a point of one box to a point of the other, is no longer than the cutoff, and its
/// direction is within the limits of both. Culls where the projections on the axes of either box rule that
/// out. Never culls a pair that holds a minimum. Real-time safe. Source: Johnson & Cohen 2001, with oriented
/// boxes in place of spheres.
using PairCullKernel = std::uint32_t (*)(const BoundPairs& pairs, const SinglePose& sceneFromPart,
                                         const CullLimits& limits) noexcept;

/// The same for every pose along a sweep; `sweep` is in the scene's frame.
using SweptPairCullKernel = std::uint32_t (*)(const BoundPairs& pairs, const SinglePose& sceneFromPart,
                                              const CullLimits& limits, const CullSweep& sweep) noexcept;

/// Instruction set that kernels are compiled for.
enum class SimdLevel : std::uint8_t { Portable, Avx2, Avx512 };

/// Instruction sets that this machine supports, best last.
std::span<const SimdLevel> availableSimdLevels() noexcept;

/// Returns the kernel for an instruction set that the machine has.
PairCullKernel pairCullKernel(SimdLevel level) noexcept;
SweptPairCullKernel sweptPairCullKernel(SimdLevel level) noexcept;

/// Returns the instruction set that queries use: the best available, unless the environment variable
/// NEARFIT_SIMD (portable, avx2, avx512) names a lower one.
SimdLevel defaultSimdLevel() noexcept;

}  // namespace nearfit
