#include "core/proximity/query/pair_separations.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/proximity/query/box_cull.h"
#include "core/proximity/query/feature_corners.h"

namespace nearfit {
namespace {

using PairDoubles = double __attribute__((vector_size(32)));
using PairVectors = simd::Triple<PairDoubles>;
static_assert(sizeof(PairDoubles) == SeparatedPairs::kLanes * sizeof(double));

NEARFIT_INLINE PairVectors loadVectors(const SeparatedPairs::Vectors& lanes) {
  PairVectors out;
  __builtin_memcpy(&out.x, &lanes[0], sizeof out.x);
  __builtin_memcpy(&out.y, &lanes[1], sizeof out.y);
  __builtin_memcpy(&out.z, &lanes[2], sizeof out.z);
  return out;
}
NEARFIT_INLINE PairVectors spreadVector(const glm::dvec3& v) {
  return {PairDoubles{} + v.x, PairDoubles{} + v.y, PairDoubles{} + v.z};
}

NEARFIT_INLINE void separate(const SeparatedPairs& pairs, const SeparationPose& pose,
                             SeparatedPairs::Numbers& out) {
  const PairVectors direction = loadVectors(pairs.direction);
  // The direction in the other body's frame, once for both ends.
  const PairVectors there{simd::dot(spreadVector(pose.turn[0]), direction),
                          simd::dot(spreadVector(pose.turn[1]), direction),
                          simd::dot(spreadVector(pose.turn[2]), direction)};
  PairDoubles height;
  __builtin_memcpy(&height, &pairs.height, sizeof height);
  const PairDoubles first = simd::dot(there, loadVectors(pairs.ends[0])),
                    second = simd::dot(there, loadVectors(pairs.ends[1]));
  const PairDoubles apart =
      (first < second ? first : second) + (simd::dot(spreadVector(pose.shift), direction) - height);
  __builtin_memcpy(&out, &apart, sizeof out);
}

void separatePortable(const SeparatedPairs& pairs, const SeparationPose& pose,
                      SeparatedPairs::Numbers& out) noexcept {
  separate(pairs, pose, out);
}

#if defined(__x86_64__)
NEARFIT_AVX2 void separateAvx2(const SeparatedPairs& pairs, const SeparationPose& pose,
                               SeparatedPairs::Numbers& out) noexcept {
  separate(pairs, pose, out);
}
NEARFIT_AVX512 void separateAvx512(const SeparatedPairs& pairs, const SeparationPose& pose,
                                   SeparatedPairs::Numbers& out) noexcept {
  separate(pairs, pose, out);
}
#endif

glm::dvec3 unitOrZero(const glm::dvec3& v) noexcept {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : glm::dvec3(0.0);
}

}  // namespace

bool isSeparatedByPart(const LeafPair& pair) noexcept {
  return NormalConeTree::leafKind(pair.part) == FeatureKind::Face;
}

Separation separationAlong(const NormalConeTree& scene, const NormalConeTree& part, const LeafPair& pair,
                           const RigidTransform& sceneFromPart, const glm::dvec3& direction) noexcept {
  const FeatureCorners ofScene = cornersOf(scene, pair.scene), ofPart = cornersOf(part, pair.part);
  Separation out;
  out.isOfPart = isSeparatedByPart(pair);
  out.direction = out.isOfPart ? glm::conjugate(sceneFromPart.rotation) * -direction : direction;
  const FeatureCorners &own = out.isOfPart ? ofPart : ofScene, &other = out.isOfPart ? ofScene : ofPart;
  out.height = extentAlong(out.direction, own).high;
  out.ends = {other.at[0], other.at[1]};
  return out;
}

PairDirections directionsOf(const NormalConeTree& scene, const NormalConeTree& part, const LeafPair& pair,
                            const RigidTransform& sceneFromPart) noexcept {
  const FeatureCorners a = cornersOf(scene, pair.scene);
  const FeatureCorners b =
      placed(cornersOf(part, pair.part), glm::mat3_cast(sceneFromPart.rotation), sceneFromPart.translation);
  const auto apartAlong = [&](const glm::dvec3& n) { return extentAlong(n, b).low - extentAlong(n, a).high; };
  PairDirections out;
  const glm::dvec3 between = betweenNearest(a, b);
  const double distance = out.distance = glm::length(between);
  if (distance > 0.0) out.apart = between / distance;
  // Faces look at the other body. The common perpendicular of edges has no side of its own.
  out.ofContact = unitOrZero(directionAcross(a, b));
  if (b.count == 3 || (b.count == 2 && glm::dot(out.ofContact, between) < 0.0))
    out.ofContact = -out.ofContact;
  if (out.ofContact != glm::dvec3(0.0) && apartAlong(out.ofContact) > distance) out.apart = out.ofContact;
  out.onPart = b.at[0];
  if (b.count == 2) {
    const glm::dvec3 along = b.at[1] - b.at[0];
    // Where the edge is nearest to the middle of the other feature.
    const double squared = glm::dot(along, along);
    const glm::dvec3 middle = (a.at[0] + a.at[1] + a.at[2]) / 3.0;
    if (squared > 0.0)
      out.onPart += std::clamp(glm::dot(middle - b.at[0], along) / squared, 0.0, 1.0) * along;
  } else if (b.count == 3) {
    out.onPart = a.at[0];
  }
  return out;
}

void SeparatedPairs::set(std::size_t lane, const Separation& separation) noexcept {
  const auto put = [lane](const glm::dvec3& from, Vectors& to) {
    to[0][lane] = from.x;
    to[1][lane] = from.y;
    to[2][lane] = from.z;
  };
  put(separation.direction, direction);
  height[lane] = separation.height;
  put(separation.ends[0], ends[0]);
  put(separation.ends[1], ends[1]);
}

SeparationPose separationPose(const RigidTransform& sceneFromPart, bool isOfPart) noexcept {
  const RigidTransform pose = isOfPart ? sceneFromPart.inverse() : sceneFromPart;
  return {glm::mat3_cast(pose.rotation), pose.translation};
}

SeparationKernel separationKernel(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return separateAvx512;
  if (level == SimdLevel::Avx2) return separateAvx2;
#endif
  static_cast<void>(level);
  return separatePortable;
}

}  // namespace nearfit
