#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/cull_kernel.h"
#include "core/proximity/query/lane_vectors.h"
#include "core/proximity/query/leaf_pair.h"

namespace nearfit {

/// A direction that separates two features at some pose. How far they are apart along it bounds their distance from
/// below at every pose, at the cost of three scalar products.
struct Separation {
  /// The direction, and the feature behind it, are of the part and not of the scene: the direction of a part's face
  /// turns with the part.
  bool isOfPart = false;
  glm::dvec3 direction{0.0};  ///< Unit, towards the other body, in the centred frame of its own tree.
  double height = 0.0;        ///< How far its own feature reaches along it [m].
  /// Ends of the other feature, a vertex or an edge, in the centred frame of the other tree.
  std::array<glm::dvec3, 2> ends{};
};

/// True if a pair's separations are fixed to the part.
bool isSeparatedByPart(const LeafPair& pair) noexcept;

/// Returns the separation of a pair along a direction.
/// @param sceneFromPart  Between the trees' centred frames.
/// @param direction      From scene to part, unit, in the scene's frame.
Separation separationAlong(const NormalConeTree& scene, const NormalConeTree& part, const LeafPair& pair,
                           const RigidTransform& sceneFromPart, const glm::dvec3& direction) noexcept;

/// A direction along which a pair is apart, and where.
struct PairDirections {
  /// The direction, unit, along which the features are farthest apart of those tried; zero if there is none.
  glm::dvec3 apart{0.0};
  /// The only direction that a contact of the two could have; zero if it could have many.
  glm::dvec3 ofContact{0.0};
  glm::dvec3 onPart{0.0};  ///< Point of the part near the scene's feature [m].
  double distance = 0.0;   ///< Of the features [m].
};
/// Finds a pair's directions, from scene to part, and point, in the scene's centred frame. The pair must span a
/// contact (spansContact()). Real-time safe.
PairDirections directionsOf(const NormalConeTree& scene, const NormalConeTree& part, const LeafPair& pair,
                            const RigidTransform& sceneFromPart) noexcept;

/// Eight separations, one per lane, all of the scene or all of the part.
struct alignas(64) SeparatedPairs {
  static constexpr std::size_t kLanes = kPairLanes;

  LaneVectors direction;
  LaneNumbers height;
  std::array<LaneVectors, 2> ends;

  void set(std::size_t lane, const Separation& separation) noexcept;
};

/// The pose that separations are looked at: it takes the other body's frame to that of the directions.
struct SeparationPose {
  glm::dmat3 turn{1.0};
  glm::dvec3 shift{0.0};
};
/// @param sceneFromPart  Between the trees' centred frames.
SeparationPose separationPose(const RigidTransform& sceneFromPart, bool isOfPart) noexcept;

/// Looks for pairs that are near at a pose or, if that ends a way, at either end of it.
struct SeparationScan {
  SeparationPose pose{};
  double near = 0.0;          ///< A pair no farther apart than this at the pose is near [m],
  double nearOfTested = 0.0;  ///< or than this, at most `near`, if it was tested before.
  bool isOfWay = false;
  SeparationPose start{};  ///< Pose at the start of the way.
  double nearOnWay = 0.0;  ///< A pair no farther apart than this at either end is near on the way [m].
};

/// Separations of some blocks of pairs [m]: to some roundings of the coordinates, no more than their distances. Pairs that
/// are not held are not near.
struct SeparationsFound {
  static constexpr std::size_t kMostBlocks = 16;
  /// By block, a bit for each lane whose pair is near, and for each that is near on the way.
  std::array<std::uint8_t, kMostBlocks> near{}, nearOnWay{};
  std::array<LaneNumbers, kMostBlocks> apart{};  ///< At the pose, of the blocks with such a pair.
  double lowest =
      0.0;  ///< How far the nearest of the other pairs is apart at the pose; infinity without one.
};

/// Bounds the pairs of the first `count` blocks, at most SeparationsFound::kMostBlocks.
/// @param held    For each block a bit per lane; pairs without theirs are passed over.
/// @param tested  The same for pairs that were tested before.
/// Real-time safe.
using SeparationKernel = void (*)(const SeparatedPairs* blocks, const std::uint8_t* held,
                                  const std::uint8_t* tested, std::size_t count, const SeparationScan& scan,
                                  SeparationsFound& found) noexcept;

/// Returns the kernel for an instruction set that the machine has.
SeparationKernel separationKernel(SimdLevel level) noexcept;

}  // namespace nearfit
