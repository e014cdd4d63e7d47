#pragma once

#include <array>
#include <cstdint>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/cull_kernel.h"

// The test of two bounds, written once for eight or sixteen numbers at a time and compiled for each
// instruction set. Everything here is forced inline: the linker could keep, for all callers, a copy of a
// function that was compiled for AVX.
#define NEARFIT_INLINE inline __attribute__((always_inline))

#if defined(__x86_64__)
#define NEARFIT_AVX2 __attribute__((target("avx2,fma")))
#define NEARFIT_AVX512 __attribute__((target("avx512f,avx512vl,avx512dq,fma")))
#endif

namespace nearfit::simd {

/// Min component of d / |d| along n from which |d| can be bounded.
constexpr float kMinSlope = 1e-2F;

using Floats8 = float __attribute__((vector_size(32)));
using Floats16 = float __attribute__((vector_size(64)));
static_assert(sizeof(Floats8) == NormalConeTree::kWidth * sizeof(float));

/// Vector returned into code for another instruction set; Clang does not allow a bare one there.
template <class F>
struct Lanes {
  F value;
};

/// Three coordinates of eight or sixteen vectors.
template <class F>
struct Triple {
  F x, y, z;
};

NEARFIT_INLINE Floats8 load(const std::array<float, NormalConeTree::kWidth>& lanes) {
  Floats8 out;
  __builtin_memcpy(&out, &lanes, sizeof out);
  return out;
}
NEARFIT_INLINE Triple<Floats8> load(const std::array<std::array<float, NormalConeTree::kWidth>, 3>& lanes) {
  return {load(lanes[0]), load(lanes[1]), load(lanes[2])};
}
/// The numbers, or three coordinates of vectors, of as many lanes.
template <class V, class T>
NEARFIT_INLINE Lanes<V> lanesOf(const std::array<T, sizeof(V) / sizeof(T)>& numbers) {
  Lanes<V> out;
  __builtin_memcpy(&out.value, &numbers, sizeof out.value);
  return out;
}
template <class V, class T>
NEARFIT_INLINE Triple<V> lanesOf(const std::array<std::array<T, sizeof(V) / sizeof(T)>, 3>& vectors) {
  return {lanesOf<V>(vectors[0]).value, lanesOf<V>(vectors[1]).value, lanesOf<V>(vectors[2]).value};
}
/// Bit per lane, set if the lane is at least 0. Goes through memory: where a variable indexes a vector, GCC
/// 12 loses the variable under -fsanitize=undefined.
NEARFIT_INLINE std::uint32_t notNegative(const Floats8& lanes) {
  float numbers[NormalConeTree::kWidth];
  __builtin_memcpy(numbers, &lanes, sizeof numbers);
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < NormalConeTree::kWidth; ++i)
    bits |= (numbers[i] >= 0.0F ? 1U : 0U) << i;
  return bits;
}

template <class F>
NEARFIT_INLINE F least(const F& a, const F& b) {
  return a < b ? a : b;
}
template <class F>
NEARFIT_INLINE F most(const F& a, const F& b) {
  return a > b ? a : b;
}
template <class F>
NEARFIT_INLINE F magnitude(const F& a) {
  using Ints = decltype(a < a);
  const Ints bits = reinterpret_cast<Ints>(a) & 0x7FFFFFFF;
  return reinterpret_cast<F>(bits);
}
template <class F>
NEARFIT_INLINE F dot(const Triple<F>& a, const Triple<F>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F>
NEARFIT_INLINE Triple<F> cross(const Triple<F>& a, const Triple<F>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Limits on the directions of a body's minima, along the axes of its box.
template <class F>
struct Limits {
  F leastN, mostU, mostV;
};

template <class F>
struct Box {
  Triple<F> centre, n, u, half;  ///< v is n x u.
  Limits<F> limits;
};

/// Bounds of all lanes of a node.
NEARFIT_INLINE Box<Floats8> boxes(const NormalConeTree::Node& node) {
  return {load(node.centre),
          load(node.n),
          load(node.u),
          load(node.half),
          {load(node.leastN), load(node.mostU), load(node.mostV)}};
}

/// One pose per lane: three columns of the rotation, then the translation.
template <class F>
struct Poses {
  Triple<F> x, y, z, translation;
  NEARFIT_INLINE Triple<F> turned(const Triple<F>& a) const {
    return {x.x * a.x + y.x * a.y + z.x * a.z, x.y * a.x + y.y * a.y + z.y * a.z,
            x.z * a.x + y.z * a.y + z.z * a.z};
  }
};

/// Transforms boxes to the frame that the poses map to.
template <class F>
NEARFIT_INLINE void move(Box<F>& box, const Poses<F>& poses) {
  box.n = poses.turned(box.n);
  box.u = poses.turned(box.u);
  const Triple<F> c = poses.turned(box.centre);
  box.centre = {c.x + poses.translation.x, c.y + poses.translation.y, c.z + poses.translation.z};
}

/// Ranges of the components of a minimum's d / |d| along three axes.
template <class F>
struct Ranges {
  Triple<F> low, high;
};

/// Ranges along a's axes for directions d within limits `a` with -d within limits `b`. The rows n, u and v
/// hold the dot products of each of a's axes with b's n, u and v. In b's axes -d = x n + y u + z v, with x
/// within [leastN, 1], |y| <= mostU and |z| <= mostV. The dot product with one of a's axes is linear in each,
/// so the ends of the intervals bound it. Widened by `turn` [rad].
template <class F>
NEARFIT_INLINE Ranges<F> ranges(const Limits<F>& a, const Limits<F>& b, const Triple<F>& n,
                                const Triple<F>& u, const Triple<F>& v, float turn) {
  const F nEnd = -n.x, uEnd = -u.x, vEnd = -v.x;
  const F nLeast = nEnd * b.leastN, uLeast = uEnd * b.leastN, vLeast = vEnd * b.leastN;
  const F nSide = magnitude(n.y) * b.mostU + magnitude(n.z) * b.mostV + turn;
  const F uSide = magnitude(u.y) * b.mostU + magnitude(u.z) * b.mostV + turn;
  const F vSide = magnitude(v.y) * b.mostU + magnitude(v.z) * b.mostV + turn;
  return {{most(a.leastN, least(nEnd, nLeast) - nSide), most(-a.mostU, least(uEnd, uLeast) - uSide),
           most(-a.mostV, least(vEnd, vLeast) - vSide)},
          {most(nEnd, nLeast) + nSide, least(a.mostU, most(uEnd, uLeast) + uSide),
           least(a.mostV, most(vEnd, vLeast) + vSide)}};
}

/// Half extent of a box along a direction, given the direction's dot products with the box's axes.
template <class F>
NEARFIT_INLINE F extent(const Triple<F>& half, const F& byN, const F& byU, const F& byV) {
  return magnitude(byN) * half.x + magnitude(byU) * half.y + magnitude(byV) * half.z;
}

/// At least 0 if d can span what the boxes require along an axis: t, give or take e. |d| lies within [gap,
/// reach], its relative component along the axis within [low, high], so their product has its extremes at
/// ends of both.
template <class F>
NEARFIT_INLINE F meets(const F& t, const F& e, const F& low, const F& high, const F& gap, const F& reach) {
  const F above = most(high * reach, high * gap) - (t - e), below = (t + e) - least(low * reach, low * gap);
  return least(high - low, least(above, below));
}

/// Paddings along the axes of either box.
template <class F>
struct Paddings {
  Triple<F> own, its;
};

template <class F>
/// Paddings for a single pose.
NEARFIT_INLINE Paddings<F> still(const CullLimits& limits) {
  const F padding = F{} + limits.padding;
  return {{padding, padding, padding}, {padding, padding, padding}};
}

/// One CullSweep per lane.
template <class F>
struct Sweeps {
  Triple<F> shift, spin, about;
  F spinLength;
};

NEARFIT_INLINE Triple<Floats8> spread(const std::array<float, 3>& v) {
  return {Floats8{} + v[0], Floats8{} + v[1], Floats8{} + v[2]};
}
NEARFIT_INLINE Sweeps<Floats8> spread(const CullSweep& s) {
  return {spread(s.shift), spread(s.spin), spread(s.about), Floats8{} + s.spinLength};
}

/// Max displacement of a box's points along axes as a sweep moves the box: that of its centre, plus what the
/// spin adds for points off the centre, plus the padding.
template <class F>
NEARFIT_INLINE Triple<F> along(const Box<F>& moving, const Box<F>& axes, const Triple<F>& axesV,
                               const Sweeps<F>& sweep, const CullLimits& limits) {
  const Triple<F> arm{moving.centre.x - sweep.about.x, moving.centre.y - sweep.about.y,
                      moving.centre.z - sweep.about.z};
  const Triple<F> turn = cross(sweep.spin, arm);
  const Triple<F> way{sweep.shift.x + turn.x, sweep.shift.y + turn.y, sweep.shift.z + turn.z};
  const F radius = moving.half.x + moving.half.y + moving.half.z;
  const F aside = sweep.spinLength * radius + limits.padding;
  return {magnitude(dot(way, axes.n)) + aside, magnitude(dot(way, axes.u)) + aside,
          magnitude(dot(way, axesV)) + aside};
}

/// Paddings for all poses of a sweep. Seen from either box the other one moves: the part's along the sweep,
/// the scene's against it.
template <class F>
NEARFIT_INLINE Paddings<F> swept(const Box<F>& own, const Box<F>& its, const Sweeps<F>& sweep,
                                 const CullLimits& limits) {
  return {along(its, own, cross(own.n, own.u), sweep, limits),
          along(own, its, cross(its.n, its.u), sweep, limits)};
}

/// At least 0 in lanes where the two boxes can hold a minimum together; negative where the projections on the
/// axes of either box rule it out.
template <class F>
NEARFIT_INLINE Lanes<F> cull(const Box<F>& own, const Box<F>& its, const CullLimits& limits,
                             const Paddings<F>& padding) {
  const Triple<F> ownV = cross(own.n, own.u), itsV = cross(its.n, its.u);
  const Triple<F> d{its.centre.x - own.centre.x, its.centre.y - own.centre.y, its.centre.z - own.centre.z};
  // Dot products of axes, own by row, the other's by column.
  const Triple<F> cn{dot(own.n, its.n), dot(own.n, its.u), dot(own.n, itsV)};
  const Triple<F> cu{dot(own.u, its.n), dot(own.u, its.u), dot(own.u, itsV)};
  const Triple<F> cv{dot(ownV, its.n), dot(ownV, its.u), dot(ownV, itsV)};
  const Ranges<F> a = ranges(own.limits, its.limits, cn, cu, cv, limits.turn);
  const Ranges<F> b = ranges(its.limits, own.limits, Triple<F>{cn.x, cu.x, cv.x}, Triple<F>{cn.y, cu.y, cv.y},
                             Triple<F>{cn.z, cu.z, cv.z}, limits.turn);

  // Along each axis of either box, a minimum's d, directed out of that box, is within the sum of extents of
  // the centres' difference.
  const F tn = dot(d, own.n), en = own.half.x + extent(its.half, cn.x, cn.y, cn.z) + padding.own.x;
  const F tu = dot(d, own.u), eu = own.half.y + extent(its.half, cu.x, cu.y, cu.z) + padding.own.y;
  const F tv = dot(d, ownV), ev = own.half.z + extent(its.half, cv.x, cv.y, cv.z) + padding.own.z;
  const F sn = -dot(d, its.n), fn = extent(own.half, cn.x, cu.x, cv.x) + (its.half.x + padding.its.x);
  const F su = -dot(d, its.u), fu = extent(own.half, cn.y, cu.y, cv.y) + (its.half.y + padding.its.y);
  const F sv = -dot(d, itsV), fv = extent(own.half, cn.z, cu.z, cv.z) + (its.half.z + padding.its.z);

  // |d| is at least its component along any axis, and at most that over the min component of d / |d|.
  const F cutoff = F{} + limits.cutoff;
  const F gap = most(F{}, most(tn - en, sn - fn));
  const F reach = least(least(cutoff, a.low.x > kMinSlope ? (tn + en) / a.low.x : cutoff),
                        b.low.x > kMinSlope ? (sn + fn) / b.low.x : cutoff);
  F margin = least(reach - gap, meets(tn, en, a.low.x, a.high.x, gap, reach));
  margin = least(margin, meets(tu, eu, a.low.y, a.high.y, gap, reach));
  margin = least(margin, meets(tv, ev, a.low.z, a.high.z, gap, reach));
  margin = least(margin, meets(sn, fn, b.low.x, b.high.x, gap, reach));
  margin = least(margin, meets(su, fu, b.low.y, b.high.y, gap, reach));
  return {least(margin, meets(sv, fv, b.low.z, b.high.z, gap, reach))};
}

/// Squared excess of |t| over a half extent.
template <class F>
NEARFIT_INLINE F squaredBeyond(const F& t, const F& extent) {
  const F beyond = most(F{}, magnitude(t) - extent);
  return beyond * beyond;
}

/// At least 0 in lanes where the two boxes come within the cutoff by their own axes, in any directions.
template <class F>
NEARFIT_INLINE Lanes<F> cullByPlace(const Box<F>& own, const Box<F>& its, const CullLimits& limits) {
  const Triple<F> ownV = cross(own.n, own.u), itsV = cross(its.n, its.u);
  const Triple<F> d{its.centre.x - own.centre.x, its.centre.y - own.centre.y, its.centre.z - own.centre.z};
  const Triple<F> cn{dot(own.n, its.n), dot(own.n, its.u), dot(own.n, itsV)};
  const Triple<F> cu{dot(own.u, its.n), dot(own.u, its.u), dot(own.u, itsV)};
  const Triple<F> cv{dot(ownV, its.n), dot(ownV, its.u), dot(ownV, itsV)};
  const F padding = F{} + limits.padding, cutoff = F{} + limits.cutoff;
  const F fromOwn = squaredBeyond(dot(d, own.n), own.half.x + extent(its.half, cn.x, cn.y, cn.z) + padding) +
                    squaredBeyond(dot(d, own.u), own.half.y + extent(its.half, cu.x, cu.y, cu.z) + padding) +
                    squaredBeyond(dot(d, ownV), own.half.z + extent(its.half, cv.x, cv.y, cv.z) + padding);
  const F fromIts =
      squaredBeyond(dot(d, its.n), extent(own.half, cn.x, cu.x, cv.x) + (its.half.x + padding)) +
      squaredBeyond(dot(d, its.u), extent(own.half, cn.y, cu.y, cv.y) + (its.half.y + padding)) +
      squaredBeyond(dot(d, itsV), extent(own.half, cn.z, cu.z, cv.z) + (its.half.z + padding));
  return {cutoff * cutoff - most(fromOwn, fromIts)};
}

}  // namespace nearfit::simd
