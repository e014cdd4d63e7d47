#include "core/proximity/cull_kernel_variants.h"

#if defined(__x86_64__)
#include <immintrin.h>

// Each function is compiled for its own instruction set and called only where the machine has it. Nothing
// from other headers is used inside them: an inline function compiled here for AVX could be the copy that the
// linker keeps.
namespace nearfit::detail {

__attribute__((target("avx2,fma"))) std::uint32_t cullAvx2(const NormalConeTree::Node& node,
                                                           const NormalConeTree::Bound& other,
                                                           const CullLimits& limits) noexcept {
  const float* x = &node.x[0];  // Nine arrays of eight, one after the other.
  const __m256 dx = _mm256_sub_ps(_mm256_set1_ps(other.x), _mm256_load_ps(x));
  const __m256 dy = _mm256_sub_ps(_mm256_set1_ps(other.y), _mm256_load_ps(x + 8));
  const __m256 dz = _mm256_sub_ps(_mm256_set1_ps(other.z), _mm256_load_ps(x + 16));
  const __m256 length =
      _mm256_sqrt_ps(_mm256_fmadd_ps(dx, dx, _mm256_fmadd_ps(dy, dy, _mm256_mul_ps(dz, dz))));
  const __m256 radii =
      _mm256_fmadd_ps(_mm256_set1_ps(kLengthPadding), length,
                      _mm256_add_ps(_mm256_load_ps(x + 24), _mm256_set1_ps(other.radius + limits.padding)));
  const __m256 isNear =
      _mm256_cmp_ps(length, _mm256_add_ps(radii, _mm256_set1_ps(limits.cutoff)), _CMP_LE_OQ);
  const std::uint32_t lanes = (1U << node.childCount) - 1U;
  const std::uint32_t nearLanes = static_cast<std::uint32_t>(_mm256_movemask_ps(isNear)) & lanes;
  if (nearLanes == 0) return 0;

  const __m256 ax = _mm256_load_ps(x + 32), ay = _mm256_load_ps(x + 40), az = _mm256_load_ps(x + 48);
  const __m256 cosA = _mm256_load_ps(x + 56), sinA = _mm256_load_ps(x + 64);
  const __m256 bx = _mm256_set1_ps(-other.axisX), by = _mm256_set1_ps(-other.axisY),
               bz = _mm256_set1_ps(-other.axisZ);
  const __m256 cosB = _mm256_set1_ps(other.cosAngle), sinB = _mm256_set1_ps(other.sinAngle);
  const __m256 zero = _mm256_setzero_ps(), pad = _mm256_set1_ps(kCosinePadding);

  const __m256 facing = _mm256_fmadd_ps(ax, bx, _mm256_fmadd_ps(ay, by, _mm256_mul_ps(az, bz)));
  const __m256 cosSum = _mm256_fmsub_ps(cosA, cosB, _mm256_mul_ps(sinA, sinB));
  const __m256 sinSum = _mm256_fmadd_ps(sinA, cosB, _mm256_mul_ps(cosA, sinB));
  const __m256 canFace = _mm256_or_ps(_mm256_cmp_ps(sinSum, zero, _CMP_LE_OQ),
                                      _mm256_cmp_ps(_mm256_add_ps(facing, pad), cosSum, _CMP_GE_OQ));

  const __m256 one = _mm256_set1_ps(1.0F);
  const __m256 inverse = _mm256_div_ps(one, _mm256_max_ps(length, _mm256_set1_ps(kLeastLength)));
  const __m256 sinDelta = _mm256_min_ps(_mm256_mul_ps(radii, inverse), one);
  const __m256 cosDelta = _mm256_sqrt_ps(_mm256_max_ps(_mm256_fnmadd_ps(sinDelta, sinDelta, one), zero));
  const __m256 along =
      _mm256_mul_ps(inverse, _mm256_fmadd_ps(ax, dx, _mm256_fmadd_ps(ay, dy, _mm256_mul_ps(az, dz))));
  const __m256 against =
      _mm256_mul_ps(inverse, _mm256_fmadd_ps(bx, dx, _mm256_fmadd_ps(by, dy, _mm256_mul_ps(bz, dz))));
  const __m256 cosAd = _mm256_fmsub_ps(cosA, cosDelta, _mm256_mul_ps(sinA, sinDelta));
  const __m256 sinAd = _mm256_fmadd_ps(sinA, cosDelta, _mm256_mul_ps(cosA, sinDelta));
  const __m256 cosBd = _mm256_fmsub_ps(cosB, cosDelta, _mm256_mul_ps(sinB, sinDelta));
  const __m256 sinBd = _mm256_fmadd_ps(sinB, cosDelta, _mm256_mul_ps(cosB, sinDelta));
  const __m256 aAllows = _mm256_or_ps(_mm256_cmp_ps(sinAd, zero, _CMP_LE_OQ),
                                      _mm256_cmp_ps(_mm256_add_ps(along, pad), cosAd, _CMP_GE_OQ));
  const __m256 bAllows = _mm256_or_ps(_mm256_cmp_ps(sinBd, zero, _CMP_LE_OQ),
                                      _mm256_cmp_ps(_mm256_add_ps(against, pad), cosBd, _CMP_GE_OQ));
  const __m256 overlaps = _mm256_cmp_ps(length, radii, _CMP_LE_OQ);
  const __m256 alive = _mm256_and_ps(canFace, _mm256_or_ps(overlaps, _mm256_and_ps(aAllows, bAllows)));
  return static_cast<std::uint32_t>(_mm256_movemask_ps(alive)) & nearLanes;
}

__attribute__((target("avx512f,avx512vl,fma"))) std::uint32_t cullAvx512(const NormalConeTree::Node& node,
                                                                         const NormalConeTree::Bound& other,
                                                                         const CullLimits& limits) noexcept {
  const float* x = &node.x[0];
  const __m256 dx = _mm256_sub_ps(_mm256_set1_ps(other.x), _mm256_load_ps(x));
  const __m256 dy = _mm256_sub_ps(_mm256_set1_ps(other.y), _mm256_load_ps(x + 8));
  const __m256 dz = _mm256_sub_ps(_mm256_set1_ps(other.z), _mm256_load_ps(x + 16));
  const __m256 length =
      _mm256_sqrt_ps(_mm256_fmadd_ps(dx, dx, _mm256_fmadd_ps(dy, dy, _mm256_mul_ps(dz, dz))));
  const __m256 radii =
      _mm256_fmadd_ps(_mm256_set1_ps(kLengthPadding), length,
                      _mm256_add_ps(_mm256_load_ps(x + 24), _mm256_set1_ps(other.radius + limits.padding)));
  const __mmask8 lanes = static_cast<__mmask8>((1U << node.childCount) - 1U);
  __mmask8 alive =
      _mm256_mask_cmp_ps_mask(lanes, length, _mm256_add_ps(radii, _mm256_set1_ps(limits.cutoff)), _CMP_LE_OQ);
  if (alive == 0) return 0;

  const __m256 ax = _mm256_load_ps(x + 32), ay = _mm256_load_ps(x + 40), az = _mm256_load_ps(x + 48);
  const __m256 cosA = _mm256_load_ps(x + 56), sinA = _mm256_load_ps(x + 64);
  const __m256 bx = _mm256_set1_ps(-other.axisX), by = _mm256_set1_ps(-other.axisY),
               bz = _mm256_set1_ps(-other.axisZ);
  const __m256 cosB = _mm256_set1_ps(other.cosAngle), sinB = _mm256_set1_ps(other.sinAngle);
  const __m256 zero = _mm256_setzero_ps(), pad = _mm256_set1_ps(kCosinePadding);

  // Culled lanes: the sum of angles below pi, and the cosine short of theirs.
  const __m256 facing = _mm256_fmadd_ps(ax, bx, _mm256_fmadd_ps(ay, by, _mm256_mul_ps(az, bz)));
  const __m256 cosSum = _mm256_fmsub_ps(cosA, cosB, _mm256_mul_ps(sinA, sinB));
  const __m256 sinSum = _mm256_fmadd_ps(sinA, cosB, _mm256_mul_ps(cosA, sinB));
  const __mmask8 averted = _mm256_mask_cmp_ps_mask(_mm256_mask_cmp_ps_mask(alive, sinSum, zero, _CMP_GT_OQ),
                                                   _mm256_add_ps(facing, pad), cosSum, _CMP_LT_OQ);
  alive = static_cast<__mmask8>(alive & ~averted);
  if (alive == 0) return 0;

  const __m256 one = _mm256_set1_ps(1.0F);
  const __m256 inverse = _mm256_div_ps(one, _mm256_max_ps(length, _mm256_set1_ps(kLeastLength)));
  const __m256 sinDelta = _mm256_min_ps(_mm256_mul_ps(radii, inverse), one);
  const __m256 cosDelta = _mm256_sqrt_ps(_mm256_max_ps(_mm256_fnmadd_ps(sinDelta, sinDelta, one), zero));
  const __m256 along =
      _mm256_mul_ps(inverse, _mm256_fmadd_ps(ax, dx, _mm256_fmadd_ps(ay, dy, _mm256_mul_ps(az, dz))));
  const __m256 against =
      _mm256_mul_ps(inverse, _mm256_fmadd_ps(bx, dx, _mm256_fmadd_ps(by, dy, _mm256_mul_ps(bz, dz))));
  const __m256 cosAd = _mm256_fmsub_ps(cosA, cosDelta, _mm256_mul_ps(sinA, sinDelta));
  const __m256 sinAd = _mm256_fmadd_ps(sinA, cosDelta, _mm256_mul_ps(cosA, sinDelta));
  const __m256 cosBd = _mm256_fmsub_ps(cosB, cosDelta, _mm256_mul_ps(sinB, sinDelta));
  const __m256 sinBd = _mm256_fmadd_ps(sinB, cosDelta, _mm256_mul_ps(cosB, sinDelta));
  const __mmask8 apart = _mm256_mask_cmp_ps_mask(alive, length, radii, _CMP_GT_OQ);
  const __mmask8 aForbids = _mm256_mask_cmp_ps_mask(_mm256_mask_cmp_ps_mask(apart, sinAd, zero, _CMP_GT_OQ),
                                                    _mm256_add_ps(along, pad), cosAd, _CMP_LT_OQ);
  const __mmask8 bForbids = _mm256_mask_cmp_ps_mask(_mm256_mask_cmp_ps_mask(apart, sinBd, zero, _CMP_GT_OQ),
                                                    _mm256_add_ps(against, pad), cosBd, _CMP_LT_OQ);
  return static_cast<std::uint32_t>(alive & ~(aForbids | bForbids));
}

}  // namespace nearfit::detail

#endif
