#include "core/proximity/query/face_pairs.h"

#include <limits>

#include "core/proximity/query/double_lanes.h"

namespace nearfit {
namespace {

using simd::Doubles8;
using simd::DoubleVectors8;
using simd::Mask8;

/// A vertex seen from a face.
struct Seen {
  std::array<DoubleVectors8, 3> corners, sides;  ///< A side leads from its corner to the next.
  DoubleVectors8 vertex, across;  ///< `across` is perpendicular to the face, twice as long as its area.
};
NEARFIT_INLINE Seen seenFrom(const FacePairs& pairs, const RigidTransform& faceFromVertex) {
  Seen seen;
  for (std::size_t k = 0; k < 3; ++k)
    seen.corners[k] = simd::lanesOf<Doubles8>(pairs.corners[k]);
  for (std::size_t k = 0; k < 3; ++k)
    seen.sides[k] = simd::minus(seen.corners[(k + 1) % 3], seen.corners[k]);
  seen.across = simd::cross(seen.sides[0], simd::minus(seen.corners[2], seen.corners[0]));
  seen.vertex = simd::plus(simd::turned(faceFromVertex, simd::lanesOf<Doubles8>(pairs.vertex)),
                           simd::spread(faceFromVertex.translation));
  return seen;
}
/// How far the face reaches along a direction.
NEARFIT_INLINE simd::Lanes<Doubles8> reachOf(const Seen& seen, const DoubleVectors8& d) {
  return {simd::most(simd::most(simd::dot(d, seen.corners[0]), simd::dot(d, seen.corners[1])),
                     simd::dot(d, seen.corners[2]))};
}

/// LeafTests::vertexFace up to the vertex's edges, step by step.
NEARFIT_INLINE void test(const FacePairs& pairs, const RigidTransform& faceFromVertex,
                         const EdgePairLimits& limits, FacePairHits& out) {
  const Seen seen = seenFrom(pairs, faceFromVertex);
  const Doubles8 zero{};
  const DoubleVectors8 n =
      simd::times(seen.across, (Doubles8{} + 1.0) / simd::root(simd::dot(seen.across, seen.across)).value);
  const Doubles8 distance = simd::dot(n, simd::minus(seen.vertex, seen.corners[0]));
  const Doubles8 uu = simd::dot(seen.sides[0], seen.sides[0]), vv = simd::dot(seen.sides[1], seen.sides[1]),
                 ww = simd::dot(seen.sides[2], seen.sides[2]);
  const Doubles8 longest = simd::most(simd::most(uu, vv), ww);
  const Doubles8 height =
      simd::lengthOf(simd::cross(seen.sides[0], seen.sides[2])).value / simd::root(longest).value;
  const Doubles8 tilt = limits.pointRounding / height;
  const Doubles8 slack = limits.lengthTolerance + limits.angularSlack * distance + tilt * distance;
  Mask8 isOver = (distance > zero) & (distance <= limits.mostDistance) & (distance <= limits.cutoff);
  // isNearTriangle() of relaxed_conditions.cpp goes along.
  Mask8 isInside = zero == zero, isNear = zero != zero;
  for (std::size_t k = 0; k < 3; ++k) {
    const DoubleVectors8& side = seen.sides[k];
    const DoubleVectors8 inward = simd::cross(n, side), w = simd::minus(seen.vertex, seen.corners[k]);
    isOver &= ~(simd::dot(inward, w) < -slack * simd::lengthOf(inward).value);
    const DoubleVectors8 foot = simd::minus(w, simd::times(n, simd::dot(w, n)));
    const Mask8 isBeyond = ~(simd::dot(inward, foot) >= zero);
    const Doubles8 along = simd::asShare(simd::dot(foot, side) / simd::dot(side, side)).value;
    const DoubleVectors8 beside = simd::minus(foot, simd::times(side, along));
    isInside &= ~isBeyond;
    isNear |= isBeyond & (simd::dot(beside, beside) <= slack * slack);
  }
  out.over = simd::bitsOf(isOver & (isInside | isNear));
  simd::store(seen.vertex, out.vertex);
  simd::store(n, out.normal);
  simd::store(distance, out.distance);
  simd::store(tilt, out.tilt);
}

NEARFIT_INLINE void separate(const FacePairs& pairs, const RigidTransform& faceFromVertex,
                             FaceSeparations& out) {
  const Seen seen = seenFrom(pairs, faceFromVertex);
  const Doubles8 zero{};
  const Doubles8 squaredArea = simd::dot(seen.across, seen.across);
  // From the nearest point of the face.
  DoubleVectors8 between = simd::minus(seen.vertex, seen.corners[0]);
  const Doubles8 rise = simd::dot(between, seen.across);
  Doubles8 least = zero + std::numeric_limits<double>::infinity();
  Mask8 isInside = squaredArea > zero;
  for (std::size_t k = 0; k < 3; ++k) {
    const DoubleVectors8& side = seen.sides[k];
    const DoubleVectors8 w = simd::minus(seen.vertex, seen.corners[k]);
    const Mask8 isBeyond = ~(simd::dot(simd::cross(seen.across, side), w) >= zero);
    const Doubles8 squaredSide = simd::dot(side, side);
    const Doubles8 along = squaredSide > zero ? simd::asShare(simd::dot(w, side) / squaredSide).value : zero;
    const DoubleVectors8 beside = simd::minus(w, simd::times(side, along));
    const Doubles8 squared = simd::dot(beside, beside);
    const Mask8 isNearer = isBeyond & (squared < least);
    between = simd::chosen(isNearer, beside, between);
    least = isNearer ? squared : least;
    isInside &= ~isBeyond;
  }
  between = simd::chosen(isInside, simd::times(seen.across, rise / squaredArea), between);
  const Doubles8 distance = simd::lengthOf(between).value, area = simd::root(squaredArea).value;
  const DoubleVectors8 none{zero, zero, zero};
  const DoubleVectors8 normal = simd::chosen(area > zero, simd::over(seen.across, area), none);
  const Mask8 isFarther = simd::dot(normal, seen.vertex) - reachOf(seen, normal).value > distance;
  const DoubleVectors8 apart =
      simd::chosen(isFarther, normal, simd::chosen(distance > zero, simd::over(between, distance), none));
  simd::store(apart, out.apart);
  simd::store(normal, out.normal);
  simd::store(seen.vertex, out.vertex);
  simd::store(distance, out.distance);
  simd::store(reachOf(seen, apart).value, out.height);
}

void testPortable(const FacePairs& pairs, const RigidTransform& faceFromVertex, const EdgePairLimits& limits,
                  FacePairHits& out) noexcept {
  test(pairs, faceFromVertex, limits, out);
}
void separatePortable(const FacePairs& pairs, const RigidTransform& faceFromVertex,
                      FaceSeparations& out) noexcept {
  separate(pairs, faceFromVertex, out);
}

#if defined(__x86_64__)
NEARFIT_AVX2 void testAvx2(const FacePairs& pairs, const RigidTransform& faceFromVertex,
                           const EdgePairLimits& limits, FacePairHits& out) noexcept {
  test(pairs, faceFromVertex, limits, out);
}
NEARFIT_AVX2 void separateAvx2(const FacePairs& pairs, const RigidTransform& faceFromVertex,
                               FaceSeparations& out) noexcept {
  separate(pairs, faceFromVertex, out);
}
NEARFIT_AVX512 void testAvx512(const FacePairs& pairs, const RigidTransform& faceFromVertex,
                               const EdgePairLimits& limits, FacePairHits& out) noexcept {
  test(pairs, faceFromVertex, limits, out);
}
NEARFIT_AVX512 void separateAvx512(const FacePairs& pairs, const RigidTransform& faceFromVertex,
                                   FaceSeparations& out) noexcept {
  separate(pairs, faceFromVertex, out);
}
#endif

}  // namespace

void packFacePairs(const NormalConeTree& scene, const NormalConeTree& part,
                   std::span<const LeafPair, FacePairs::kLanes> pairs, bool facesArePart,
                   FacePairs& block) noexcept {
  const NormalConeTree &faces = facesArePart ? part : scene, &vertices = facesArePart ? scene : part;
  for (std::size_t lane = 0; lane < FacePairs::kLanes; ++lane) {
    const std::uint32_t face = NormalConeTree::leafIndex(facesArePart ? pairs[lane].part : pairs[lane].scene),
                        vertex =
                            NormalConeTree::leafIndex(facesArePart ? pairs[lane].scene : pairs[lane].part);
    for (std::size_t k = 0; k < 3; ++k)
      setVector(block.corners[k], lane, faces.positions()[faces.faces()[face].corners[k]]);
    setVector(block.vertex, lane, vertices.positions()[vertices.vertices()[vertex].vertex]);
  }
}

FacePairKernels facePairKernels(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return {testAvx512, separateAvx512};
  if (level == SimdLevel::Avx2) return {testAvx2, separateAvx2};
#endif
  static_cast<void>(level);
  return {testPortable, separatePortable};
}

}  // namespace nearfit
