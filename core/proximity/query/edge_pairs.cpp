#include "core/proximity/query/edge_pairs.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/tolerances.h"
#include "core/proximity/query/double_lanes.h"
#include "core/proximity/query/leaf_tests.h"

namespace nearfit {
namespace {

using simd::Doubles8;
using simd::DoubleVectors8;
using simd::Mask8;
using Edges = EdgePairs::Edges;

constexpr std::size_t kLanes = EdgePairs::kLanes;

/// LeafTests::edgeOf and inwardOf, eight at a time.
NEARFIT_INLINE void pack(const std::array<LaneVectors, 2>& ends, const std::array<LaneVectors, 2>& opposite,
                         Edges& out) {
  const DoubleVectors8 start = simd::lanesOf<Doubles8>(ends[0]),
                       whole = simd::minus(simd::lanesOf<Doubles8>(ends[1]), start);
  const Doubles8 length = simd::lengthOf(whole).value;
  const DoubleVectors8 along = simd::over(whole, length);
  simd::store(start, out.start);
  simd::store(along, out.along);
  simd::store(length, out.length);
  for (std::size_t i = 0; i < opposite.size(); ++i) {
    const DoubleVectors8 w = simd::minus(simd::lanesOf<Doubles8>(opposite[i]), start);
    const DoubleVectors8 inward = simd::minus(w, simd::times(along, simd::dot(w, along)));
    simd::store(inward, out.inward[i]);
    simd::store(simd::lengthOf(inward).value, out.depth[i]);
  }
}
NEARFIT_INLINE void packBoth(const EdgePairCorners& corners, EdgePairs& out) {
  pack(corners.ends.scene, corners.sceneOpposite, out.scene);
  pack(corners.ends.part, corners.partOpposite, out.part);
}

/// isInsideWall of relaxed_conditions.cpp, eight at a time.
NEARFIT_INLINE simd::Lanes<Mask8> isInsideWall(const DoubleVectors8& x, const DoubleVectors8& e) {
  constexpr double kSquared = kAngularTolerance * kAngularTolerance;
  const Doubles8 beyond = simd::dot(x, e);
  return {(beyond <= 0.0) | (beyond * beyond <= kSquared * simd::dot(e, e))};
}

/// LeafTests::isPolarOfEdge with relaxation, eight at a time.
NEARFIT_INLINE simd::Lanes<Mask8> isPolar(const EdgePairs::Edges& edges, const DoubleVectors8& d,
                                          const EdgePairLimits& limits) {
  const DoubleVectors8 in0 = simd::lanesOf<Doubles8>(edges.inward[0]),
                       in1 = simd::lanesOf<Doubles8>(edges.inward[1]);
  const Doubles8 a0 = simd::dot(d, in0), a1 = simd::dot(d, in1);
  const Mask8 isOut0 = a0 > 0.0, isOut1 = a1 > 0.0;
  const Mask8 isFar0 =
      a0 > limits.angularSlack * simd::lanesOf<Doubles8>(edges.depth[0]).value + limits.pointRounding;
  const Mask8 isFar1 =
      a1 > limits.angularSlack * simd::lanesOf<Doubles8>(edges.depth[1]).value + limits.pointRounding;
  const Mask8 isOnArc =
      (isOut0 & isInsideWall(simd::minus(d, simd::times(in0, a0 / simd::dot(in0, in0))), in1).value) |
      (isOut1 & isInsideWall(simd::minus(d, simd::times(in1, a1 / simd::dot(in1, in1))), in0).value);
  return {~((isOut0 & isFar0) | (isOut1 & isFar1)) & (~(isOut0 | isOut1) | isOnArc)};
}

/// LeafTests::edgeEdge for edges that cross, eight at a time and step by step.
NEARFIT_INLINE void test(const EdgePairs& pairs, const RigidTransform& sceneFromPart,
                         const RigidTransform& partFromScene, const EdgePairLimits& limits,
                         EdgePairHits& out) {
  const glm::dvec3& t0 = sceneFromPart.translation;
  const DoubleVectors8 aStart = simd::lanesOf<Doubles8>(pairs.scene.start),
                       aAlong = simd::lanesOf<Doubles8>(pairs.scene.along);
  const DoubleVectors8 bStart =
      simd::plus(simd::turned(sceneFromPart, simd::lanesOf<Doubles8>(pairs.part.start)), simd::spread(t0));
  const DoubleVectors8 bAlong = simd::turned(sceneFromPart, simd::lanesOf<Doubles8>(pairs.part.along));
  const Doubles8 aLength = simd::lanesOf<Doubles8>(pairs.scene.length).value,
                 bLength = simd::lanesOf<Doubles8>(pairs.part.length).value;

  const DoubleVectors8 across = simd::cross(aAlong, bAlong);
  const Doubles8 sine = simd::root(simd::dot(across, across)).value, square = sine * sine;
  const DoubleVectors8 w = simd::minus(bStart, aStart);
  const Doubles8 s = simd::dot(simd::cross(w, bAlong), across) / square;
  const Doubles8 t = simd::dot(simd::cross(w, aAlong), across) / square;
  DoubleVectors8 direction{across.x / sine, across.y / sine, across.z / sine};
  Doubles8 distance = simd::dot(w, direction);
  const Mask8 isTurned = distance < 0.0;
  direction = {isTurned ? -direction.x : direction.x, isTurned ? -direction.y : direction.y,
               isTurned ? -direction.z : direction.z};
  distance = isTurned ? -distance : distance;
  const Doubles8 slack = limits.lengthTolerance + limits.angularSlack * distance;
  const Mask8 isWithin = (distance > 0.0) & (distance <= limits.mostDistance) & (distance <= limits.cutoff);
  const Mask8 isBeside = (s >= -slack) & (s <= aLength + slack) & (t >= -slack) & (t <= bLength + slack);
  const DoubleVectors8 toScene = simd::turned(partFromScene, {-direction.x, -direction.y, -direction.z});
  const Mask8 crosses = sine >= LeafTests::kNearlyParallel;
  out.undecided = simd::bitsOf(~crosses);
  out.found = simd::bitsOf(crosses & isWithin & isBeside & isPolar(pairs.scene, direction, limits).value &
                           isPolar(pairs.part, toScene, limits).value);
  simd::store(simd::plus(simd::plus(aStart, simd::times(aAlong, s)), simd::times(direction, distance)),
              out.partPoint);
  simd::store(direction, out.direction);
  simd::store(distance, out.distance);
}

void packPortable(const EdgePairCorners& corners, EdgePairs& out) noexcept {
  packBoth(corners, out);
}
void testPortable(const EdgePairs& pairs, const RigidTransform& sceneFromPart,
                  const RigidTransform& partFromScene, const EdgePairLimits& limits,
                  EdgePairHits& out) noexcept {
  test(pairs, sceneFromPart, partFromScene, limits, out);
}

#if defined(__x86_64__)
NEARFIT_AVX2 void packAvx2(const EdgePairCorners& corners, EdgePairs& out) noexcept {
  packBoth(corners, out);
}
NEARFIT_AVX2 void testAvx2(const EdgePairs& pairs, const RigidTransform& sceneFromPart,
                           const RigidTransform& partFromScene, const EdgePairLimits& limits,
                           EdgePairHits& out) noexcept {
  test(pairs, sceneFromPart, partFromScene, limits, out);
}
NEARFIT_AVX512 void packAvx512(const EdgePairCorners& corners, EdgePairs& out) noexcept {
  packBoth(corners, out);
}
NEARFIT_AVX512 void testAvx512(const EdgePairs& pairs, const RigidTransform& sceneFromPart,
                               const RigidTransform& partFromScene, const EdgePairLimits& limits,
                               EdgePairHits& out) noexcept {
  test(pairs, sceneFromPart, partFromScene, limits, out);
}
#endif

void put(const NormalConeTree& tree, std::uint32_t leaf, std::size_t lane, std::array<LaneVectors, 2>& ends,
         std::array<LaneVectors, 2>& opposite) noexcept {
  const NormalConeTree::EdgeLeaf& edge = tree.edges()[NormalConeTree::leafIndex(leaf)];
  const std::span<const glm::dvec3> at = tree.positions();
  setVector(ends[0], lane, at[edge.v0]);
  setVector(ends[1], lane, at[edge.v1]);
  for (std::size_t i = 0; i < opposite.size(); ++i)
    setVector(opposite[i], lane, at[edge.opposite[i]]);
}

}  // namespace

EdgePairKernels edgePairKernels(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return {packAvx512, testAvx512};
  if (level == SimdLevel::Avx2) return {packAvx2, testAvx2};
#endif
  static_cast<void>(level);
  return {packPortable, testPortable};
}

bool isOfEdges(const LeafPair& pair) noexcept {
  return NormalConeTree::leafKind(pair.scene) == FeatureKind::Edge &&
         NormalConeTree::leafKind(pair.part) == FeatureKind::Edge;
}

std::size_t edgePairsToFront(std::span<LeafPair> pairs) noexcept {
  const auto rest = std::partition(pairs.begin(), pairs.end(), isOfEdges);
  return static_cast<std::size_t>(rest - pairs.begin());
}

void packEdgePairs(const NormalConeTree& scene, const NormalConeTree& part,
                   std::span<const LeafPair, EdgePairs::kLanes> pairs, const EdgePairKernels& kernels,
                   EdgePairs& block) noexcept {
  EdgePairCorners corners;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    put(scene, pairs[lane].scene, lane, corners.ends.scene, corners.sceneOpposite);
    put(part, pairs[lane].part, lane, corners.ends.part, corners.partOpposite);
  }
  kernels.pack(corners, block);
}

}  // namespace nearfit
