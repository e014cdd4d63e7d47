#include "core/proximity/query/cull_kernel.h"

#include <array>
#include <cstdlib>
#include <string_view>

#include "core/proximity/query/box_cull.h"

namespace nearfit {
namespace {

using simd::Floats8;

/// The part's bounds in the scene's frame.
NEARFIT_INLINE simd::Box<Floats8> partBoxes(const BoundPairs& pairs, const SinglePose& pose) {
  const auto& m = pose.columns();
  const auto column = [&m](std::size_t k) __attribute__((always_inline)) {
    return simd::Triple<Floats8>{Floats8{} + m[k][0], Floats8{} + m[k][1], Floats8{} + m[k][2]};
  };
  const simd::Poses<Floats8> poses{column(0), column(1), column(2), column(3)};
  simd::Box<Floats8> part = simd::boxes(pairs.part);
  simd::move(part, poses);
  return part;
}

/// At least 0 in lanes that survive.
NEARFIT_INLINE simd::Lanes<Floats8> cullPairs(const BoundPairs& pairs, const SinglePose& pose,
                                              const CullLimits& limits) {
  return simd::cull(simd::boxes(pairs.scene), partBoxes(pairs, pose), limits, simd::still<Floats8>(limits));
}
NEARFIT_INLINE simd::Lanes<Floats8> cullSwept(const BoundPairs& pairs, const SinglePose& pose,
                                              const CullLimits& limits, const CullSweep& sweep) {
  const simd::Box<Floats8> scene = simd::boxes(pairs.scene), part = partBoxes(pairs, pose);
  return simd::cull(scene, part, limits, simd::swept(scene, part, simd::spread(sweep), limits));
}

std::uint32_t cullPairsPortable(const BoundPairs& pairs, const SinglePose& pose,
                                const CullLimits& limits) noexcept {
  return simd::notNegative(cullPairs(pairs, pose, limits).value);
}
std::uint32_t cullSweptPortable(const BoundPairs& pairs, const SinglePose& pose, const CullLimits& limits,
                                const CullSweep& sweep) noexcept {
  return simd::notNegative(cullSwept(pairs, pose, limits, sweep).value);
}

#if defined(__x86_64__)
#define NEARFIT_BITS(margin) \
  static_cast<std::uint32_t>(__builtin_ia32_movmskps256(reinterpret_cast<Floats8>((margin).value >= 0.0F)))

NEARFIT_AVX2 std::uint32_t cullPairsAvx2(const BoundPairs& pairs, const SinglePose& pose,
                                         const CullLimits& limits) noexcept {
  return NEARFIT_BITS(cullPairs(pairs, pose, limits));
}
NEARFIT_AVX2 std::uint32_t cullSweptAvx2(const BoundPairs& pairs, const SinglePose& pose,
                                         const CullLimits& limits, const CullSweep& sweep) noexcept {
  return NEARFIT_BITS(cullSwept(pairs, pose, limits, sweep));
}
NEARFIT_AVX512 std::uint32_t cullPairsAvx512(const BoundPairs& pairs, const SinglePose& pose,
                                             const CullLimits& limits) noexcept {
  return NEARFIT_BITS(cullPairs(pairs, pose, limits));
}
NEARFIT_AVX512 std::uint32_t cullSweptAvx512(const BoundPairs& pairs, const SinglePose& pose,
                                             const CullLimits& limits, const CullSweep& sweep) noexcept {
  return NEARFIT_BITS(cullSwept(pairs, pose, limits, sweep));
}
#endif

}  // namespace

SinglePose::SinglePose(const RigidTransform& pose) noexcept {
  const glm::dmat3 m = glm::mat3_cast(pose.rotation);
  for (std::size_t row = 0; row < 3; ++row) {
    const auto i = static_cast<int>(row);
    for (std::size_t column = 0; column < 3; ++column) {
      columns_[column][row] = static_cast<float>(m[static_cast<int>(column)][i]);
    }
    columns_[3][row] = static_cast<float>(pose.translation[i]);
  }
  for (auto& column : columns_)
    column[3] = 0.0F;
}

std::span<const SimdLevel> availableSimdLevels() noexcept {
  static constexpr std::array<SimdLevel, 3> kLevels{SimdLevel::Portable, SimdLevel::Avx2, SimdLevel::Avx512};
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("fma")) {
    return kLevels;
  }
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return std::span(kLevels).first(2);
#endif
  return std::span(kLevels).first(1);
}

PairCullKernel pairCullKernel(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return cullPairsAvx512;
  if (level == SimdLevel::Avx2) return cullPairsAvx2;
#endif
  static_cast<void>(level);
  return cullPairsPortable;
}

SweptPairCullKernel sweptPairCullKernel(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return cullSweptAvx512;
  if (level == SimdLevel::Avx2) return cullSweptAvx2;
#endif
  static_cast<void>(level);
  return cullSweptPortable;
}

SimdLevel defaultSimdLevel() noexcept {
  static const SimdLevel chosen = [] {
    const std::span<const SimdLevel> available = availableSimdLevels();
    const char* wanted = std::getenv("NEARFIT_SIMD");
    const std::string_view name = wanted == nullptr ? "" : wanted;
    for (const SimdLevel level : available) {
      if ((level == SimdLevel::Portable && name == "portable") ||
          (level == SimdLevel::Avx2 && name == "avx2")) {
        return level;
      }
    }
    return available.back();
  }();
  return chosen;
}

}  // namespace nearfit
