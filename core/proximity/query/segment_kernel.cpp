#include "core/proximity/query/segment_kernel.h"

#include "core/proximity/query/box_cull.h"

namespace nearfit {
namespace {

using simd::Floats8, simd::magnitude;
using Ints8 = std::int32_t __attribute__((vector_size(32)));

/// All bits set in lanes whose box the segment may meet. The separating axes are the box's own, and their
/// cross products with the segment.
NEARFIT_INLINE simd::Lanes<Ints8> meets(const NormalConeTree::Node& node, const SegmentBound& s) {
  using Vectors = simd::Triple<Floats8>;
  const Vectors centre = simd::load(node.centre), half = simd::load(node.half);
  const Vectors n = simd::load(node.n), u = simd::load(node.u), v = simd::cross(n, u);
  const Vectors d{s.middle[0] - centre.x, s.middle[1] - centre.y, s.middle[2] - centre.z};
  const Floats8 hn = s.half[0] * n.x + s.half[1] * n.y + s.half[2] * n.z;
  const Floats8 hu = s.half[0] * u.x + s.half[1] * u.y + s.half[2] * u.z;
  const Floats8 hv = s.half[0] * v.x + s.half[1] * v.y + s.half[2] * v.z;
  const Floats8 dn = simd::dot(d, n), du = simd::dot(d, u), dv = simd::dot(d, v);
  const Floats8 an = magnitude(hn), au = magnitude(hu), av = magnitude(hv);
  const Floats8 en = half.x + s.padding, eu = half.y + s.padding, ev = half.z + s.padding;
  const Ints8 alive = (magnitude(dn) <= en + an) & (magnitude(du) <= eu + au) & (magnitude(dv) <= ev + av);
  // For any axis, the products carry the rounding of the distance times the whole length.
  const Floats8 slack = s.padding * (an + au + av);
  return {alive & (magnitude(du * hv - dv * hu) <= eu * av + ev * au + slack) &
          (magnitude(dv * hn - dn * hv) <= ev * an + en * av + slack) &
          (magnitude(dn * hu - du * hn) <= en * au + eu * an + slack)};
}

/// Goes through memory, like simd::notNegative().
NEARFIT_INLINE std::uint32_t bitsOf(const Ints8& lanes) {
  std::int32_t numbers[NormalConeTree::kWidth];
  __builtin_memcpy(numbers, &lanes, sizeof numbers);
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < NormalConeTree::kWidth; ++i)
    bits |= (numbers[i] != 0 ? 1U : 0U) << i;
  return bits;
}

std::uint32_t segmentPortable(const NormalConeTree::Node& node, const SegmentBound& segment) noexcept {
  return bitsOf(meets(node, segment).value);
}

#if defined(__x86_64__)
#define NEARFIT_BITS(hits) \
  static_cast<std::uint32_t>(__builtin_ia32_movmskps256(reinterpret_cast<Floats8>((hits).value)))

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
