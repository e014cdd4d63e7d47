#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/cull_kernel.h"
#include "core/proximity/query/lane_vectors.h"
#include "core/proximity/query/leaf_pair.h"
#include "core/proximity/query/pair_separations.h"

namespace nearfit {

/// Eight pairs of features, one per lane, each feature an edge or a vertex: the two ends of an edge, or a vertex twice,
/// in the centred frame of its own tree [m].
struct alignas(64) SegmentPairs {
  static constexpr std::size_t kLanes = kPairLanes;

  std::array<LaneVectors, 2> scene, part;
};

/// True if neither feature of a pair is a face.
bool isOfSegments(const LeafPair& pair) noexcept;

/// Packs pairs that isOfSegments() holds for. Real-time safe.
void packSegmentPairs(const NormalConeTree& scene, const NormalConeTree& part,
                      std::span<const LeafPair, SegmentPairs::kLanes> pairs, SegmentPairs& block) noexcept;

/// PairDirections of eight pairs, and how far the scene's feature reaches along `apart`.
struct SegmentSeparations {
  /// Lanes whose edges are so nearly parallel that directionsOf() decides; one bit per lane.
  std::uint8_t undecided = 0;
  LaneVectors apart, ofContact, onPart;
  LaneNumbers distance, height;

  PairDirections directions(std::size_t lane) const noexcept;
};

/// Separates eight pairs at a pose. Results equal those of directionsOf() and separationAlong() for each pair to the
/// last bit. Real-time safe.
/// @param sceneFromPart  Between the trees' centred frames (separationPose() of the scene).
using SegmentSeparationKernel = void (*)(const SegmentPairs& pairs, const SeparationPose& sceneFromPart,
                                         SegmentSeparations& out) noexcept;

/// Returns the kernel for an instruction set that the machine has.
SegmentSeparationKernel segmentSeparationKernel(SimdLevel level) noexcept;

}  // namespace nearfit
