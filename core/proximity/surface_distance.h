#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/proximity/lmd_query.h"

namespace nearfit {

class NormalConeTree;

/// How near two surfaces are, seen from any side.
struct SurfaceDistance {
  double distance = 0.0;  ///< Between the points [m]; infinity when none were found within reach.
  /// No two points of the surfaces are nearer than this [m]; the distance less its rounding when the search
  /// was complete, `within` when there is nothing nearer, 0 in the worst case.
  double lowerBound = 0.0;
  glm::dvec3 scenePoint{0.0}, partPoint{0.0};  ///< In the frame of the scene's mesh [m].
  bool isFound = false;
  bool isComplete = false;  ///< Else there was more work than allowed.
  std::uint64_t nodePairs = 0, trianglePairs = 0;
};

/// The least distance between two surfaces as sets of points, whatever their sides: for meshes that are open
/// or of no consistent orientation, whose minima need not hold it, and 0 where surfaces pass through each
/// other. It says nothing of one body inside the other: see findInterference.
///
/// @param scene, part    Hierarchies of the two meshes. Triangles lower than 1e-14 of their longest side are
///                       not in them, and do not count.
/// @param sceneFromPart  Pose of `part` in the frame of `scene`; unit quaternion. One that is not finite
/// gives
///                       a lower bound of 0.
/// @param within         Distance that matters [m]; > 0, may be infinite.
/// @param scratch        Preallocated work space, one per thread.
/// @param maxNodePairs   Bound on the work. At it the nearest so far is there, and a lower bound by what was
///                       not looked at.
/// Real-time safe: no allocation, lock or throw.
SurfaceDistance leastSurfaceDistance(const NormalConeTree& scene, const NormalConeTree& part,
                                     const RigidTransform& sceneFromPart, double within, LmdScratch& scratch,
                                     std::uint64_t maxNodePairs) noexcept;

}  // namespace nearfit
