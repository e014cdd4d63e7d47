#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/proximity/query/lmd_query.h"

namespace nearfit {

class NormalConeTree;

/// Distance between two surfaces, regardless of their sides.
struct SurfaceDistance {
  double distance = 0.0;  ///< Between the points [m]; infinity if none were found within reach.
  /// Lower bound on the distance between the surfaces [m]: `distance` less its rounding if the search was
  /// complete, `within` if nothing is nearer, 0 in the worst case.
  double lowerBound = 0.0;
  glm::dvec3 scenePoint{0.0}, partPoint{0.0};  ///< Nearest points, in the frame of the scene's mesh [m].
  bool isFound = false;
  bool isComplete = false;  ///< False if the bound on the work stopped the search.
  std::uint64_t nodePairs = 0, trianglePairs = 0;
};

/// Finds the min distance between two surfaces as sets of points, regardless of their sides: for meshes that
/// are open or inconsistently oriented, whose minima may miss it. 0 where surfaces pass through each other.
/// Does not tell if one body is inside the other: see findInterference.
///
/// @param scene, part    Hierarchies of the two meshes. Triangles lower than 1e-14 of their longest side are
///                       not in them, and do not count.
/// @param sceneFromPart  Pose of `part` in the frame of `scene`; unit quaternion. One that is not finite
///                       gives a lower bound of 0.
/// @param within         Max distance of interest [m]; > 0, may be infinite.
/// @param scratch        Preallocated work space, one per thread.
/// @param maxNodePairs   Bound on the work. At the bound the result holds the nearest points so far, and a
///                       lower bound from the pairs not visited.
/// Real-time safe: no allocation, lock or throw.
SurfaceDistance leastSurfaceDistance(const NormalConeTree& scene, const NormalConeTree& part,
                                     const RigidTransform& sceneFromPart, double within, LmdScratch& scratch,
                                     std::uint64_t maxNodePairs) noexcept;

}  // namespace nearfit
