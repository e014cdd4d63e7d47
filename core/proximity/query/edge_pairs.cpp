#include "core/proximity/query/edge_pairs.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/tolerances.h"
#include "core/proximity/query/box_cull.h"
#include "core/proximity/query/leaf_tests.h"

namespace nearfit {
namespace {

constexpr std::size_t kLanes = EdgePairs::kLanes;
using Doubles4 = double __attribute__((vector_size(32)));
using Mask4 = std::int64_t __attribute__((vector_size(32)));
using Vectors = simd::Triple<Doubles4>;
static_assert(sizeof(Doubles4) == kLanes * sizeof(double));

NEARFIT_INLINE void store(const Doubles4& from, EdgePairs::Numbers& to) {
  __builtin_memcpy(&to, &from, sizeof from);
}
NEARFIT_INLINE void store(const Vectors& from, EdgePairs::Vectors& to) {
  store(from.x, to[0]);
  store(from.y, to[1]);
  store(from.z, to[2]);
}
/// Goes through memory, like simd::notNegative().
NEARFIT_INLINE std::uint32_t bitsOf(const Mask4& lanes) {
  std::int64_t numbers[kLanes];
  __builtin_memcpy(numbers, &lanes, sizeof numbers);
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < kLanes; ++i)
    bits |= (numbers[i] != 0 ? 1U : 0U) << i;
  return bits;
}
NEARFIT_INLINE simd::Lanes<Doubles4> root(const Doubles4& squares) {
  double numbers[kLanes];
  __builtin_memcpy(numbers, &squares, sizeof numbers);
  for (double& number : numbers)
    number = __builtin_sqrt(number);
  simd::Lanes<Doubles4> out;
  __builtin_memcpy(&out.value, numbers, sizeof numbers);
  return out;
}

NEARFIT_INLINE Vectors plus(const Vectors& a, const Vectors& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
NEARFIT_INLINE Vectors minus(const Vectors& a, const Vectors& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
NEARFIT_INLINE Vectors times(const Vectors& a, const Doubles4& s) {
  return {a.x * s, a.y * s, a.z * s};
}
NEARFIT_INLINE Vectors spread(double x, double y, double z) {
  return {Doubles4{} + x, Doubles4{} + y, Doubles4{} + z};
}
/// Rotates as glm does by a quaternion.
NEARFIT_INLINE Vectors turned(const RigidTransform& pose, const Vectors& v) {
  const glm::dquat& q = pose.rotation;
  const Vectors axis = spread(q.x, q.y, q.z);
  const Vectors once = simd::cross(axis, v), twice = simd::cross(axis, once);
  return plus(v, times(plus(times(once, Doubles4{} + q.w), twice), Doubles4{} + 2.0));
}

/// isInsideWall of relaxed_conditions.cpp, four at a time.
NEARFIT_INLINE simd::Lanes<Mask4> isInsideWall(const Vectors& x, const Vectors& e) {
  constexpr double kSquared = kAngularTolerance * kAngularTolerance;
  const Doubles4 beyond = simd::dot(x, e);
  return {(beyond <= 0.0) | (beyond * beyond <= kSquared * simd::dot(e, e))};
}

/// LeafTests::isPolarOfEdge with relaxation, four at a time.
NEARFIT_INLINE simd::Lanes<Mask4> isPolar(const EdgePairs::Edges& edges, const Vectors& d,
                                          const EdgePairLimits& limits) {
  const Vectors in0 = simd::lanesOf<Doubles4>(edges.inward[0]),
                in1 = simd::lanesOf<Doubles4>(edges.inward[1]);
  const Doubles4 a0 = simd::dot(d, in0), a1 = simd::dot(d, in1);
  const Mask4 isOut0 = a0 > 0.0, isOut1 = a1 > 0.0;
  const Mask4 isFar0 =
      a0 > limits.angularSlack * simd::lanesOf<Doubles4>(edges.depth[0]).value + limits.pointRounding;
  const Mask4 isFar1 =
      a1 > limits.angularSlack * simd::lanesOf<Doubles4>(edges.depth[1]).value + limits.pointRounding;
  const Mask4 isOnArc = (isOut0 & isInsideWall(minus(d, times(in0, a0 / simd::dot(in0, in0))), in1).value) |
                        (isOut1 & isInsideWall(minus(d, times(in1, a1 / simd::dot(in1, in1))), in0).value);
  return {~((isOut0 & isFar0) | (isOut1 & isFar1)) & (~(isOut0 | isOut1) | isOnArc)};
}

/// LeafTests::edgeEdge for edges that cross, four at a time and step by step.
NEARFIT_INLINE void test(const EdgePairs& pairs, const RigidTransform& sceneFromPart,
                         const RigidTransform& partFromScene, const EdgePairLimits& limits,
                         EdgePairHits& out) {
  const glm::dvec3& t0 = sceneFromPart.translation;
  const Vectors aStart = simd::lanesOf<Doubles4>(pairs.scene.start),
                aAlong = simd::lanesOf<Doubles4>(pairs.scene.along);
  const Vectors bStart =
      plus(turned(sceneFromPart, simd::lanesOf<Doubles4>(pairs.part.start)), spread(t0.x, t0.y, t0.z));
  const Vectors bAlong = turned(sceneFromPart, simd::lanesOf<Doubles4>(pairs.part.along));
  const Doubles4 aLength = simd::lanesOf<Doubles4>(pairs.scene.length).value,
                 bLength = simd::lanesOf<Doubles4>(pairs.part.length).value;

  const Vectors across = simd::cross(aAlong, bAlong);
  const Doubles4 sine = root(simd::dot(across, across)).value, square = sine * sine;
  const Vectors w = minus(bStart, aStart);
  const Doubles4 s = simd::dot(simd::cross(w, bAlong), across) / square;
  const Doubles4 t = simd::dot(simd::cross(w, aAlong), across) / square;
  Vectors direction{across.x / sine, across.y / sine, across.z / sine};
  Doubles4 distance = simd::dot(w, direction);
  const Mask4 isTurned = distance < 0.0;
  direction = {isTurned ? -direction.x : direction.x, isTurned ? -direction.y : direction.y,
               isTurned ? -direction.z : direction.z};
  distance = isTurned ? -distance : distance;
  const Doubles4 slack = limits.lengthTolerance + limits.angularSlack * distance;
  const Mask4 isWithin = (distance > 0.0) & (distance <= limits.mostDistance) & (distance <= limits.cutoff);
  const Mask4 isBeside = (s >= -slack) & (s <= aLength + slack) & (t >= -slack) & (t <= bLength + slack);
  const Vectors toScene = turned(partFromScene, {-direction.x, -direction.y, -direction.z});
  const Mask4 crosses = sine >= LeafTests::kNearlyParallel;
  out.undecided = bitsOf(~crosses);
  out.found = bitsOf(crosses & isWithin & isBeside & isPolar(pairs.scene, direction, limits).value &
                     isPolar(pairs.part, toScene, limits).value);
  store(plus(plus(aStart, times(aAlong, s)), times(direction, distance)), out.partPoint);
  store(direction, out.direction);
  store(distance, out.distance);
}

void testPortable(const EdgePairs& pairs, const RigidTransform& sceneFromPart,
                  const RigidTransform& partFromScene, const EdgePairLimits& limits,
                  EdgePairHits& out) noexcept {
  test(pairs, sceneFromPart, partFromScene, limits, out);
}

#if defined(__x86_64__)
NEARFIT_AVX2 void testAvx2(const EdgePairs& pairs, const RigidTransform& sceneFromPart,
                           const RigidTransform& partFromScene, const EdgePairLimits& limits,
                           EdgePairHits& out) noexcept {
  test(pairs, sceneFromPart, partFromScene, limits, out);
}
NEARFIT_AVX512 void testAvx512(const EdgePairs& pairs, const RigidTransform& sceneFromPart,
                               const RigidTransform& partFromScene, const EdgePairLimits& limits,
                               EdgePairHits& out) noexcept {
  test(pairs, sceneFromPart, partFromScene, limits, out);
}
#endif

void put(const glm::dvec3& from, EdgePairs::Vectors& to, std::size_t lane) noexcept {
  to[0][lane] = from.x;
  to[1][lane] = from.y;
  to[2][lane] = from.z;
}

void put(const NormalConeTree& tree, std::uint32_t leaf, EdgePairs::Edges& to, std::size_t lane) noexcept {
  const std::uint32_t edge = NormalConeTree::leafIndex(leaf);
  const LeafTests::Edge line = LeafTests::edgeOf(tree, edge);
  const std::array<glm::dvec3, 2> inward = LeafTests::inwardOf(tree, edge, line);
  put(line.start, to.start, lane);
  put(line.along, to.along, lane);
  to.length[lane] = line.length;
  for (std::size_t i = 0; i < inward.size(); ++i) {
    put(inward[i], to.inward[i], lane);
    to.depth[i][lane] = glm::length(inward[i]);
  }
}

}  // namespace

EdgePairKernel edgePairKernel(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return testAvx512;
  if (level == SimdLevel::Avx2) return testAvx2;
#endif
  static_cast<void>(level);
  return testPortable;
}

std::size_t edgePairsToFront(std::span<LeafPair> pairs) noexcept {
  const auto isEdge = [](std::uint32_t leaf) { return NormalConeTree::leafKind(leaf) == FeatureKind::Edge; };
  const auto rest = std::partition(pairs.begin(), pairs.end(), [&](const LeafPair& pair) {
    return isEdge(pair.scene) && isEdge(pair.part);
  });
  return static_cast<std::size_t>(rest - pairs.begin());
}

void packEdgePairs(const NormalConeTree& scene, const NormalConeTree& part,
                   std::span<const LeafPair, EdgePairs::kLanes> pairs, EdgePairs& block) noexcept {
  for (std::size_t lane = 0; lane < EdgePairs::kLanes; ++lane) {
    put(scene, pairs[lane].scene, block.scene, lane);
    put(part, pairs[lane].part, block.part, lane);
  }
}

}  // namespace nearfit
