#include "core/proximity/cull_kernel.h"

#include <array>
#include <cstdlib>
#include <cstring>
#include <string_view>

// The kernel is written once, on eight numbers at a time, and compiled for each instruction set. Everything
// in it is forced inline: a function of its own compiled for AVX could be the copy that the linker keeps for
// all.
#define NEARFIT_INLINE inline __attribute__((always_inline))

namespace nearfit {
namespace {

/// Added to every projection of limits on directions: some thirty roundings of single precision.
constexpr float kDirectionSlack = 4e-6F;

/// Directions that are nearly square to n say nothing of how far they reach along it.
constexpr float kLeastSlope = 1e-2F;

using Floats = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));
static_assert(sizeof(Floats) == NormalConeTree::kWidth * sizeof(float));

struct Vectors {
  Floats x, y, z;
};

NEARFIT_INLINE Floats load(const std::array<float, NormalConeTree::kWidth>& lanes) {
  Floats out;
  __builtin_memcpy(&out, &lanes, sizeof out);
  return out;
}
NEARFIT_INLINE Vectors load(const std::array<std::array<float, NormalConeTree::kWidth>, 3>& lanes) {
  return {load(lanes[0]), load(lanes[1]), load(lanes[2])};
}
NEARFIT_INLINE Floats all(float value) {
  return Floats{} + value;
}
NEARFIT_INLINE Floats least(Floats a, Floats b) {
  return a < b ? a : b;
}
NEARFIT_INLINE Floats most(Floats a, Floats b) {
  return a > b ? a : b;
}
NEARFIT_INLINE Floats magnitude(Floats a) {
  const Ints bits = reinterpret_cast<Ints>(a) & 0x7FFFFFFF;
  return reinterpret_cast<Floats>(bits);
}
NEARFIT_INLINE Floats dot(const Vectors& a, const std::array<float, 3>& b) {
  return a.x * b[0] + a.y * b[1] + a.z * b[2];
}
NEARFIT_INLINE Floats dot(const Vectors& a, const Vectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Limits on the directions of a body's minima, in its axes.
struct Limits {
  Floats leastN, mostU, mostV;
};

/// Whether directions d within limits `a` and -d within limits `b` can be the same: b's projected on a's
/// axes. The rows hold the product of each of a's axes with b's n, u and v.
NEARFIT_INLINE Ints canFace(const Limits& a, const Limits& b, const Vectors& n, const Vectors& u,
                            const Vectors& v) {
  const auto side = [&b](const Vectors& row) __attribute__((always_inline)) {
    return magnitude(row.y) * b.mostU + magnitude(row.z) * b.mostV + kDirectionSlack;
  };
  const Floats nEnd = -n.x, uEnd = -u.x, vEnd = -v.x;
  const Floats nLeast = nEnd * b.leastN, uLeast = uEnd * b.leastN, vLeast = vEnd * b.leastN;
  const Floats uSide = side(u), vSide = side(v);
  return (most(nEnd, nLeast) + side(n) >= a.leastN) & (least(uEnd, uLeast) - uSide <= a.mostU) &
         (most(uEnd, uLeast) + uSide >= -a.mostU) & (least(vEnd, vLeast) - vSide <= a.mostV) &
         (most(vEnd, vLeast) + vSide >= -a.mostV);
}

/// All bits set in the lanes that survive.
NEARFIT_INLINE Ints cull(const NormalConeTree::Node& node, const NormalConeTree::Bound& other,
                         const CullLimits& limits) {
  const Vectors n = load(node.n), u = load(node.u), half = load(node.half), centre = load(node.centre);
  const Vectors v{n.y * u.z - n.z * u.y, n.z * u.x - n.x * u.z, n.x * u.y - n.y * u.x};
  const Limits own{load(node.leastN), load(node.mostU), load(node.mostV)};
  const Limits its{all(other.leastN), all(other.mostU), all(other.mostV)};
  const Vectors d{other.centre[0] - centre.x, other.centre[1] - centre.y, other.centre[2] - centre.z};

  // Products of axes, own by row, the other's by column.
  const Vectors cn{dot(n, other.n), dot(n, other.u), dot(n, other.v)};
  const Vectors cu{dot(u, other.n), dot(u, other.u), dot(u, other.v)};
  const Vectors cv{dot(v, other.n), dot(v, other.u), dot(v, other.v)};

  // d lies within `extent` of the centres' difference along each axis of either box, and points outward of
  // both.
  const auto ownExtent = [&](Floats h, const Vectors& row) __attribute__((always_inline)) {
    return h + magnitude(row.x) * other.half[0] + magnitude(row.y) * other.half[1] +
           magnitude(row.z) * other.half[2] + limits.padding;
  };
  const auto itsExtent = [&](float h, Floats byN, Floats byU, Floats byV) __attribute__((always_inline)) {
    return magnitude(byN) * half.x + magnitude(byU) * half.y + magnitude(byV) * half.z + (h + limits.padding);
  };
  const Floats zero = all(0.0F), cutoff = all(limits.cutoff);
  const Floats tn = dot(n, d), en = ownExtent(half.x, cn);
  const Floats sn = -dot(d, other.n), fn = itsExtent(other.half[0], cn.x, cu.x, cv.x);
  Ints alive = (tn - en <= cutoff) & (tn + en >= least(zero, own.leastN * cutoff)) & (sn - fn <= cutoff) &
               (sn + fn >= least(zero, its.leastN * cutoff));

  // What d can reach along n bounds its length, and that what it can reach sideways.
  Floats reach = least(cutoff, own.leastN > kLeastSlope ? (tn + en) / own.leastN : cutoff);
  reach = least(reach, its.leastN > kLeastSlope ? (sn + fn) / its.leastN : cutoff);
  alive &= (magnitude(dot(u, d)) - ownExtent(half.y, cu) <= own.mostU * reach) &
           (magnitude(dot(v, d)) - ownExtent(half.z, cv) <= own.mostV * reach) &
           (magnitude(dot(d, other.u)) - itsExtent(other.half[1], cn.y, cu.y, cv.y) <= its.mostU * reach) &
           (magnitude(dot(d, other.v)) - itsExtent(other.half[2], cn.z, cu.z, cv.z) <= its.mostV * reach);

  return alive & canFace(own, its, cn, cu, cv) &
         canFace(its, own, {cn.x, cu.x, cv.x}, {cn.y, cu.y, cv.y}, {cn.z, cu.z, cv.z});
}

NEARFIT_INLINE std::uint32_t bitsOf(Ints lanes) {
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < NormalConeTree::kWidth; ++i)
    bits |= (lanes[i] != 0 ? 1U : 0U) << i;
  return bits;
}

std::uint32_t cullPortable(const NormalConeTree::Node& node, const NormalConeTree::Bound& other,
                           const CullLimits& limits) noexcept {
  return bitsOf(cull(node, other, limits));
}

#if defined(__x86_64__)
__attribute__((target("avx2,fma"))) std::uint32_t cullAvx2(const NormalConeTree::Node& node,
                                                           const NormalConeTree::Bound& other,
                                                           const CullLimits& limits) noexcept {
  return static_cast<std::uint32_t>(
      __builtin_ia32_movmskps256(reinterpret_cast<Floats>(cull(node, other, limits))));
}

__attribute__((target("avx512f,avx512vl,avx512dq,fma"))) std::uint32_t cullAvx512(
    const NormalConeTree::Node& node, const NormalConeTree::Bound& other, const CullLimits& limits) noexcept {
  return static_cast<std::uint32_t>(
      __builtin_ia32_movmskps256(reinterpret_cast<Floats>(cull(node, other, limits))));
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

NormalConeTree::Bound SinglePose::apply(const NormalConeTree::Bound& b) const noexcept {
  // Four at a time: the compiler makes one vector of each.
  const auto turn = [this](const std::array<float, 3>& x) {
    std::array<float, 4> out;
    for (std::size_t i = 0; i < 4; ++i)
      out[i] = columns_[0][i] * x[0] + columns_[1][i] * x[1] + columns_[2][i] * x[2];
    return out;
  };
  NormalConeTree::Bound out = b;
  const std::array<float, 4> centre = turn(b.centre), n = turn(b.n), u = turn(b.u), v = turn(b.v);
  for (std::size_t i = 0; i < 3; ++i) {
    out.centre[i] = centre[i] + columns_[3][i];
    out.n[i] = n[i];
    out.u[i] = u[i];
    out.v[i] = v[i];
  }
  return out;
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

CullKernel cullKernel(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return cullAvx512;
  if (level == SimdLevel::Avx2) return cullAvx2;
#endif
  static_cast<void>(level);
  return cullPortable;
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
