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

/// Directions that are nearly square to n say nothing of how far they reach along it.
constexpr float kLeastSlope = 1e-2F;

using Floats = float __attribute__((vector_size(32)));
using Ints = std::int32_t __attribute__((vector_size(32)));
static_assert(sizeof(Floats) == NormalConeTree::kWidth * sizeof(float));

/// Three numbers, or three times eight.
template <class T>
struct Triple {
  T x, y, z;
};
using Vectors = Triple<Floats>;

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
template <class T>
NEARFIT_INLINE Floats dot(const Vectors& a, const Triple<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
NEARFIT_INLINE Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Limits on the directions of a body's minima, in its axes.
template <class T>
struct Limits {
  T leastN, mostU, mostV;
};

/// One bound for all lanes, or one for each.
template <class T>
struct Box {
  Triple<T> centre, n, u, v, half;
  Limits<T> limits;
};

NEARFIT_INLINE Box<Floats> boxes(const NormalConeTree::Node& node) {
  const Vectors n = load(node.n), u = load(node.u);
  return {load(node.centre),
          n,
          u,
          cross(n, u),
          load(node.half),
          {load(node.leastN), load(node.mostU), load(node.mostV)}};
}

NEARFIT_INLINE Box<float> box(const NormalConeTree::Bound& b) {
  return {{b.centre[0], b.centre[1], b.centre[2]},
          {b.n[0], b.n[1], b.n[2]},
          {b.u[0], b.u[1], b.u[2]},
          {b.v[0], b.v[1], b.v[2]},
          {b.half[0], b.half[1], b.half[2]},
          {b.leastN, b.mostU, b.mostV}};
}

/// What the components of a minimum's d / |d| along three axes can be.
struct Ranges {
  Vectors low, high;
};

/// Along a's axes, of directions d within limits `a` with -d within limits `b`. The rows hold the product of
/// each of a's axes with b's n, u and v. -d = x n + y u + z v in b's axes, x within [leastN, 1], |y| and |z|
/// at most mostU and mostV: its product with an axis of a's is linear in each, so that the ends bound it.
template <class A, class B>
NEARFIT_INLINE Ranges ranges(const Limits<A>& a, const Limits<B>& b, const Vectors& n, const Vectors& u,
                             const Vectors& v, float turn) {
  const Floats nEnd = -n.x, uEnd = -u.x, vEnd = -v.x;
  const Floats nLeast = nEnd * b.leastN, uLeast = uEnd * b.leastN, vLeast = vEnd * b.leastN;
  const Floats nSide = magnitude(n.y) * b.mostU + magnitude(n.z) * b.mostV + turn;
  const Floats uSide = magnitude(u.y) * b.mostU + magnitude(u.z) * b.mostV + turn;
  const Floats vSide = magnitude(v.y) * b.mostU + magnitude(v.z) * b.mostV + turn;
  const Floats zero = all(0.0F), leastN = zero + a.leastN, mostU = zero + a.mostU, mostV = zero + a.mostV;
  return {{most(leastN, least(nEnd, nLeast) - nSide), most(-mostU, least(uEnd, uLeast) - uSide),
           most(-mostV, least(vEnd, vLeast) - vSide)},
          {most(nEnd, nLeast) + nSide, least(mostU, most(uEnd, uLeast) + uSide),
           least(mostV, most(vEnd, vLeast) + vSide)}};
}

/// Half extent of a box along a direction whose products with the box's axes are given.
template <class T>
NEARFIT_INLINE Floats extent(const Triple<T>& half, const Floats& byN, const Floats& byU, const Floats& byV) {
  return magnitude(byN) * half.x + magnitude(byU) * half.y + magnitude(byV) * half.z;
}

/// Whether d can reach along an axis what the boxes ask: t give or take e. |d| is within [gap, reach], and
/// its share along the axis within [low, high]: the product is greatest and least at ends of both.
NEARFIT_INLINE Ints meets(Floats t, Floats e, Floats low, Floats high, Floats gap, Floats reach) {
  return (low <= high) & (t - e <= most(high * reach, high * gap)) & (t + e >= least(low * reach, low * gap));
}

/// All bits set in the lanes that survive.
template <class T>
NEARFIT_INLINE Ints cull(const Box<Floats>& own, const Box<T>& its, const CullLimits& limits) {
  const Vectors d{its.centre.x - own.centre.x, its.centre.y - own.centre.y, its.centre.z - own.centre.z};
  // Products of axes, own by row, the other's by column.
  const Vectors cn{dot(own.n, its.n), dot(own.n, its.u), dot(own.n, its.v)};
  const Vectors cu{dot(own.u, its.n), dot(own.u, its.u), dot(own.u, its.v)};
  const Vectors cv{dot(own.v, its.n), dot(own.v, its.u), dot(own.v, its.v)};
  const Ranges a = ranges(own.limits, its.limits, cn, cu, cv, limits.turn);
  const Ranges b =
      ranges(its.limits, own.limits, {cn.x, cu.x, cv.x}, {cn.y, cu.y, cv.y}, {cn.z, cu.z, cv.z}, limits.turn);

  // Along each axis of either box a minimum's d, out of that box, lies within the sum of extents of the
  // centres' difference.
  const Floats tn = dot(d, own.n), en = own.half.x + extent(its.half, cn.x, cn.y, cn.z) + limits.padding;
  const Floats tu = dot(d, own.u), eu = own.half.y + extent(its.half, cu.x, cu.y, cu.z) + limits.padding;
  const Floats tv = dot(d, own.v), ev = own.half.z + extent(its.half, cv.x, cv.y, cv.z) + limits.padding;
  const Floats sn = -dot(d, its.n), fn = extent(own.half, cn.x, cu.x, cv.x) + (its.half.x + limits.padding);
  const Floats su = -dot(d, its.u), fu = extent(own.half, cn.y, cu.y, cv.y) + (its.half.y + limits.padding);
  const Floats sv = -dot(d, its.v), fv = extent(own.half, cn.z, cu.z, cv.z) + (its.half.z + limits.padding);

  // |d| is at least what it is along an axis, and at most that by the least share that it has along it.
  const Floats cutoff = all(limits.cutoff);
  const Floats gap = most(all(0.0F), most(tn - en, sn - fn));
  const Floats reach = least(least(cutoff, a.low.x > kLeastSlope ? (tn + en) / a.low.x : cutoff),
                             b.low.x > kLeastSlope ? (sn + fn) / b.low.x : cutoff);
  return (gap <= reach) & meets(tn, en, a.low.x, a.high.x, gap, reach) &
         meets(tu, eu, a.low.y, a.high.y, gap, reach) & meets(tv, ev, a.low.z, a.high.z, gap, reach) &
         meets(sn, fn, b.low.x, b.high.x, gap, reach) & meets(su, fu, b.low.y, b.high.y, gap, reach) &
         meets(sv, fv, b.low.z, b.high.z, gap, reach);
}

NEARFIT_INLINE Ints cullChildren(const NormalConeTree::Node& node, const NormalConeTree::Bound& other,
                                 const CullLimits& limits) {
  return cull(boxes(node), box(other), limits);
}

NEARFIT_INLINE Ints cullPairs(const BoundPairs& pairs, const SinglePose& pose, const CullLimits& limits) {
  const auto& m = pose.columns();
  Box<Floats> part = boxes(pairs.part);
  const auto turned = [&m](const Vectors& a) __attribute__((always_inline)) {
    return Vectors{m[0][0] * a.x + m[1][0] * a.y + m[2][0] * a.z,
                   m[0][1] * a.x + m[1][1] * a.y + m[2][1] * a.z,
                   m[0][2] * a.x + m[1][2] * a.y + m[2][2] * a.z};
  };
  part.n = turned(part.n);
  part.u = turned(part.u);
  part.v = turned(part.v);
  part.centre = turned(part.centre);
  part.centre.x += m[3][0];
  part.centre.y += m[3][1];
  part.centre.z += m[3][2];
  return cull(boxes(pairs.scene), part, limits);
}

NEARFIT_INLINE std::uint32_t bitsOf(Ints lanes) {
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < NormalConeTree::kWidth; ++i)
    bits |= (lanes[i] != 0 ? 1U : 0U) << i;
  return bits;
}

std::uint32_t cullPortable(const NormalConeTree::Node& node, const NormalConeTree::Bound& other,
                           const CullLimits& limits) noexcept {
  return bitsOf(cullChildren(node, other, limits));
}
std::uint32_t cullPairsPortable(const BoundPairs& pairs, const SinglePose& pose,
                                const CullLimits& limits) noexcept {
  return bitsOf(cullPairs(pairs, pose, limits));
}

#if defined(__x86_64__)
#define NEARFIT_AVX2 __attribute__((target("avx2,fma")))
#define NEARFIT_AVX512 __attribute__((target("avx512f,avx512vl,avx512dq,fma")))
#define NEARFIT_BITS(lanes) \
  static_cast<std::uint32_t>(__builtin_ia32_movmskps256(reinterpret_cast<Floats>(lanes)))

NEARFIT_AVX2 std::uint32_t cullAvx2(const NormalConeTree::Node& node, const NormalConeTree::Bound& other,
                                    const CullLimits& limits) noexcept {
  return NEARFIT_BITS(cullChildren(node, other, limits));
}
NEARFIT_AVX2 std::uint32_t cullPairsAvx2(const BoundPairs& pairs, const SinglePose& pose,
                                         const CullLimits& limits) noexcept {
  return NEARFIT_BITS(cullPairs(pairs, pose, limits));
}
NEARFIT_AVX512 std::uint32_t cullAvx512(const NormalConeTree::Node& node, const NormalConeTree::Bound& other,
                                        const CullLimits& limits) noexcept {
  return NEARFIT_BITS(cullChildren(node, other, limits));
}
NEARFIT_AVX512 std::uint32_t cullPairsAvx512(const BoundPairs& pairs, const SinglePose& pose,
                                             const CullLimits& limits) noexcept {
  return NEARFIT_BITS(cullPairs(pairs, pose, limits));
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

PairCullKernel pairCullKernel(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return cullPairsAvx512;
  if (level == SimdLevel::Avx2) return cullPairsAvx2;
#endif
  static_cast<void>(level);
  return cullPairsPortable;
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
