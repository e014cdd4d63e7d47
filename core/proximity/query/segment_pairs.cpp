#include "core/proximity/query/segment_pairs.h"

#include "core/proximity/query/double_lanes.h"
#include "core/proximity/query/feature_corners.h"
#include "core/proximity/query/triangle_distance.h"

namespace nearfit {
namespace {

using simd::Doubles8;
using simd::DoubleVectors8;
using simd::Mask8;

constexpr std::size_t kLanes = SegmentPairs::kLanes;

/// Edges from their starts, in one frame, and their squared lengths.
struct Edges {
  DoubleVectors8 start, along;
  Doubles8 squared;
};
/// Where on the edges a point is nearest: 0 at the start, 1 at the end, 0 on a vertex.
NEARFIT_INLINE simd::Lanes<Doubles8> shareOf(const Edges& edges, const DoubleVectors8& point) {
  const Doubles8 zero{};
  const Doubles8 share = simd::dot(simd::minus(point, edges.start), edges.along) / edges.squared;
  return {edges.squared > zero ? simd::asShare(share).value : zero};
}
NEARFIT_INLINE DoubleVectors8 at(const Edges& edges, const Doubles8& share) {
  return simd::plus(edges.start, simd::times(edges.along, share));
}
struct Ends {
  DoubleVectors8 first, second;
};
/// How far the nearer of two ends is along a direction, and how far the farther.
NEARFIT_INLINE simd::Lanes<Doubles8> lowOf(const DoubleVectors8& d, const Ends& ends) {
  return {simd::least(simd::dot(d, ends.first), simd::dot(d, ends.second))};
}
NEARFIT_INLINE simd::Lanes<Doubles8> highOf(const DoubleVectors8& d, const Ends& ends) {
  return {simd::most(simd::dot(d, ends.first), simd::dot(d, ends.second))};
}
/// The vectors over their lengths; zero without a length.
NEARFIT_INLINE DoubleVectors8 unitOrZero(const DoubleVectors8& v, const Doubles8& length) {
  const Doubles8 zero{};
  return simd::chosen(length > zero, simd::over(v, length), {zero, zero, zero});
}

/// directionsOf(), step by step: closestOfSegments(), then directionAcross().
NEARFIT_INLINE void separate(const SegmentPairs& pairs, const SeparationPose& pose, SegmentSeparations& out) {
  const Doubles8 zero{};
  const Ends a{simd::lanesOf<Doubles8>(pairs.scene[0]), simd::lanesOf<Doubles8>(pairs.scene[1])};
  const DoubleVectors8 shift = simd::spread(pose.shift);
  const Ends b{simd::plus(simd::turned(pose.turn, simd::lanesOf<Doubles8>(pairs.part[0])), shift),
               simd::plus(simd::turned(pose.turn, simd::lanesOf<Doubles8>(pairs.part[1])), shift)};
  Edges ofScene{a.first, simd::minus(a.second, a.first), zero},
      ofPart{b.first, simd::minus(b.second, b.first), zero};
  ofScene.squared = simd::dot(ofScene.along, ofScene.along);
  ofPart.squared = simd::dot(ofPart.along, ofPart.along);
  const DoubleVectors8 normal = simd::cross(ofScene.along, ofPart.along);
  const Doubles8 nn = simd::dot(normal, normal), product = ofScene.squared * ofPart.squared;
  out.undecided =
      simd::bitsOf((product > zero) & ~(nn > kParallelSegments * ofScene.squared * ofPart.squared));

  const Doubles8 crossing = simd::dot(simd::cross(simd::minus(b.first, a.first), ofPart.along), normal) / nn;
  const DoubleVectors8 q =
      at(ofPart, shareOf(ofPart, at(ofScene, nn > zero ? simd::asShare(crossing).value : zero)).value);
  const DoubleVectors8 p = at(ofScene, shareOf(ofScene, q).value);
  const DoubleVectors8 between = simd::minus(q, p);
  const Doubles8 distance = simd::lengthOf(between).value;

  DoubleVectors8 across = unitOrZero(normal, simd::root(nn).value);
  across = simd::chosen(simd::dot(across, between) < zero, {-across.x, -across.y, -across.z}, across);
  const Mask8 isFarther = lowOf(across, b).value - highOf(across, a).value > distance;
  const DoubleVectors8 apart = simd::chosen(isFarther, across, unitOrZero(between, distance));
  const DoubleVectors8 middle =
      simd::over(simd::plus(simd::plus(a.first, a.second), a.second), Doubles8{} + 3.0);
  simd::store(apart, out.apart);
  simd::store(across, out.ofContact);
  simd::store(at(ofPart, shareOf(ofPart, middle).value), out.onPart);
  simd::store(distance, out.distance);
  simd::store(highOf(apart, a).value, out.height);
}

void separatePortable(const SegmentPairs& pairs, const SeparationPose& sceneFromPart,
                      SegmentSeparations& out) noexcept {
  separate(pairs, sceneFromPart, out);
}

#if defined(__x86_64__)
NEARFIT_AVX2 void separateAvx2(const SegmentPairs& pairs, const SeparationPose& sceneFromPart,
                               SegmentSeparations& out) noexcept {
  separate(pairs, sceneFromPart, out);
}
NEARFIT_AVX512 void separateAvx512(const SegmentPairs& pairs, const SeparationPose& sceneFromPart,
                                   SegmentSeparations& out) noexcept {
  separate(pairs, sceneFromPart, out);
}
#endif

}  // namespace

bool isOfSegments(const LeafPair& pair) noexcept {
  return NormalConeTree::leafKind(pair.scene) != FeatureKind::Face &&
         NormalConeTree::leafKind(pair.part) != FeatureKind::Face;
}

void packSegmentPairs(const NormalConeTree& scene, const NormalConeTree& part,
                      std::span<const LeafPair, SegmentPairs::kLanes> pairs, SegmentPairs& block) noexcept {
  const auto put = [](const NormalConeTree& tree, std::uint32_t leaf, std::size_t lane,
                      std::array<LaneVectors, 2>& ends) {
    const FeatureCorners corners = cornersOf(tree, leaf);
    for (std::size_t end = 0; end < ends.size(); ++end)
      setVector(ends[end], lane, corners.at[end]);
  };
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    put(scene, pairs[lane].scene, lane, block.scene);
    put(part, pairs[lane].part, lane, block.part);
  }
}

PairDirections SegmentSeparations::directions(std::size_t lane) const noexcept {
  return {vectorIn(apart, lane), vectorIn(ofContact, lane), vectorIn(onPart, lane), distance[lane]};
}

SegmentSeparationKernel segmentSeparationKernel(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return separateAvx512;
  if (level == SimdLevel::Avx2) return separateAvx2;
#endif
  static_cast<void>(level);
  return separatePortable;
}

}  // namespace nearfit
