#include "core/proximity/query/pair_separations.h"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/proximity/query/double_lanes.h"
#include "core/proximity/query/feature_corners.h"

namespace nearfit {
namespace {

using simd::Doubles8;
using simd::DoubleVectors8;
using simd::Mask8;

constexpr double kBeyondAll = std::numeric_limits<double>::infinity();

/// A block in vectors.
struct Block {
  DoubleVectors8 direction, first, second;
  Doubles8 height;
  Mask8 isHeld;
};
/// How far the pairs of a block are apart; infinity for pairs that are not held.
NEARFIT_INLINE simd::Lanes<Doubles8> apartIn(const Block& block, const SeparationPose& pose) {
  // The direction in the other body's frame, once for both ends.
  const DoubleVectors8 there{simd::dot(simd::spread(pose.turn[0]), block.direction),
                             simd::dot(simd::spread(pose.turn[1]), block.direction),
                             simd::dot(simd::spread(pose.turn[2]), block.direction)};
  const Doubles8 first = simd::dot(there, block.first), second = simd::dot(there, block.second);
  const Doubles8 apart =
      simd::least(first, second) + (simd::dot(simd::spread(pose.shift), block.direction) - block.height);
  return {block.isHeld ? apart : Doubles8{} + kBeyondAll};
}
/// The least of all lanes. Goes through memory, like simd::notNegative().
NEARFIT_INLINE double leastOf(const Doubles8& lanes) {
  double numbers[SeparatedPairs::kLanes];
  __builtin_memcpy(numbers, &lanes, sizeof numbers);
  double least = numbers[0];
  for (std::size_t i = 1; i < SeparatedPairs::kLanes; ++i)
    least = numbers[i] < least ? numbers[i] : least;
  return least;
}

NEARFIT_INLINE void scanBlocks(const SeparatedPairs* blocks, const std::uint8_t* held,
                               const std::uint8_t* tested, std::size_t count, const SeparationScan& scan,
                               SeparationsFound& found) {
  const Doubles8 beyondAll = Doubles8{} + kBeyondAll;
  Doubles8 lowest = beyondAll;
  for (std::size_t at = 0; at < count; ++at) {
    found.near[at] = found.nearOnWay[at] = 0;
    if (held[at] == 0) continue;
    const SeparatedPairs& pairs = blocks[at];
    const Block block{simd::lanesOf<Doubles8>(pairs.direction), simd::lanesOf<Doubles8>(pairs.ends[0]),
                      simd::lanesOf<Doubles8>(pairs.ends[1]), simd::lanesOf<Doubles8>(pairs.height).value,
                      simd::lanesOfBits(held[at])};
    const Doubles8 apart = apartIn(block, scan.pose).value;
    const Mask8 isNear =
        apart <= (simd::lanesOfBits(tested[at]) ? Doubles8{} + scan.nearOfTested : Doubles8{} + scan.near);
    const std::uint8_t near = found.near[at] = simd::bitsOf(isNear & block.isHeld);
    if (scan.isOfWay) {
      const Doubles8 nearest = simd::least(apart, apartIn(block, scan.start).value);
      found.nearOnWay[at] = simd::bitsOf((nearest <= Doubles8{} + scan.nearOnWay) & block.isHeld);
    }
    if ((near | found.nearOnWay[at]) != 0) __builtin_memcpy(&found.apart[at], &apart, sizeof apart);
    lowest = simd::least(lowest, isNear ? beyondAll : apart);
  }
  found.lowest = leastOf(lowest);
}

void scanPortable(const SeparatedPairs* blocks, const std::uint8_t* held, const std::uint8_t* tested,
                  std::size_t count, const SeparationScan& scan, SeparationsFound& found) noexcept {
  scanBlocks(blocks, held, tested, count, scan, found);
}

#if defined(__x86_64__)
NEARFIT_AVX2 void scanAvx2(const SeparatedPairs* blocks, const std::uint8_t* held, const std::uint8_t* tested,
                           std::size_t count, const SeparationScan& scan, SeparationsFound& found) noexcept {
  scanBlocks(blocks, held, tested, count, scan, found);
}
NEARFIT_AVX512 void scanAvx512(const SeparatedPairs* blocks, const std::uint8_t* held,
                               const std::uint8_t* tested, std::size_t count, const SeparationScan& scan,
                               SeparationsFound& found) noexcept {
  scanBlocks(blocks, held, tested, count, scan, found);
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
  setVector(direction, lane, separation.direction);
  height[lane] = separation.height;
  setVector(ends[0], lane, separation.ends[0]);
  setVector(ends[1], lane, separation.ends[1]);
}

SeparationPose separationPose(const RigidTransform& sceneFromPart, bool isOfPart) noexcept {
  const RigidTransform pose = isOfPart ? sceneFromPart.inverse() : sceneFromPart;
  return {glm::mat3_cast(pose.rotation), pose.translation};
}

SeparationKernel separationKernel(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return scanAvx512;
  if (level == SimdLevel::Avx2) return scanAvx2;
#endif
  static_cast<void>(level);
  return scanPortable;
}

}  // namespace nearfit
