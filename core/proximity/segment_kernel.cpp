#include "core/proximity/segment_kernel.h"

// Written once, on eight numbers at a time, and compiled for each instruction set. Everything in it is forced
// inline: a function of its own compiled for AVX could be the copy that the linker keeps for all.
#define NEARFIT_INLINE inline __attribute__((always_inline))

namespace nearfit {
namespace {

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
NEARFIT_INLINE Floats magnitude(Floats a) {
  const Ints bits = reinterpret_cast<Ints>(a) & 0x7FFFFFFF;
  return reinterpret_cast<Floats>(bits);
}
NEARFIT_INLINE Floats dot(const Vectors& a, const Vectors& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// All bits set in the lanes whose box the segment may meet: separating axes are the box's own, and those
/// square to one of them and the segment.
NEARFIT_INLINE Ints meets(const NormalConeTree::Node& node, const SegmentBound& s) {
  const Vectors centre = load(node.centre), n = load(node.n), u = load(node.u);
  const Vectors v{n.y * u.z - n.z * u.y, n.z * u.x - n.x * u.z, n.x * u.y - n.y * u.x};
  const Vectors d{s.middle[0] - centre.x, s.middle[1] - centre.y, s.middle[2] - centre.z};
  const Floats hn = s.half[0] * n.x + s.half[1] * n.y + s.half[2] * n.z;
  const Floats hu = s.half[0] * u.x + s.half[1] * u.y + s.half[2] * u.z;
  const Floats hv = s.half[0] * v.x + s.half[1] * v.y + s.half[2] * v.z;
  const Floats dn = dot(d, n), du = dot(d, u), dv = dot(d, v);
  const Floats an = magnitude(hn), au = magnitude(hu), av = magnitude(hv);
  const Vectors half = load(node.half);
  const Floats en = half.x + s.padding, eu = half.y + s.padding, ev = half.z + s.padding;
  const Ints alive = (magnitude(dn) <= en + an) & (magnitude(du) <= eu + au) & (magnitude(dv) <= ev + av);
  // Products carry the rounding of the distance over the whole length, whatever the axis.
  const Floats slack = s.padding * (an + au + av);
  return alive & (magnitude(du * hv - dv * hu) <= eu * av + ev * au + slack) &
         (magnitude(dv * hn - dn * hv) <= ev * an + en * av + slack) &
         (magnitude(dn * hu - du * hn) <= en * au + eu * an + slack);
}

NEARFIT_INLINE std::uint32_t bitsOf(Ints lanes) {
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < NormalConeTree::kWidth; ++i)
    bits |= (lanes[i] != 0 ? 1U : 0U) << i;
  return bits;
}

std::uint32_t segmentPortable(const NormalConeTree::Node& node, const SegmentBound& segment) noexcept {
  return bitsOf(meets(node, segment));
}

#if defined(__x86_64__)
#define NEARFIT_AVX2 __attribute__((target("avx2,fma")))
#define NEARFIT_AVX512 __attribute__((target("avx512f,avx512vl,avx512dq,fma")))
#define NEARFIT_BITS(lanes) \
  static_cast<std::uint32_t>(__builtin_ia32_movmskps256(reinterpret_cast<Floats>(lanes)))

NEARFIT_AVX2 std::uint32_t segmentAvx2(const NormalConeTree::Node& node,
                                       const SegmentBound& segment) noexcept {
  return NEARFIT_BITS(meets(node, segment));
}
NEARFIT_AVX512 std::uint32_t segmentAvx512(const NormalConeTree::Node& node,
                                           const SegmentBound& segment) noexcept {
  return NEARFIT_BITS(meets(node, segment));
}
#endif

}  // namespace

SegmentKernel segmentKernel(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return segmentAvx512;
  if (level == SimdLevel::Avx2) return segmentAvx2;
#endif
  static_cast<void>(level);
  return segmentPortable;
}

}  // namespace nearfit
