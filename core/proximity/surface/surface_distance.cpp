#include "core/proximity/surface/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/proximity/query/triangle_distance.h"
#include "core/proximity/surface/near_faces.h"

namespace nearfit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Upper bound on the distance between any two points of the two bodies [m].
double reachOf(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& pose) noexcept {
  const RigidTransform centred = centredPose(scene, part, pose);
  return scene.size() + part.size() + glm::length(centred.translation);
}

}  // namespace

SurfaceDistance leastSurfaceDistance(const NormalConeTree& scene, const NormalConeTree& part,
                                     const RigidTransform& sceneFromPart, double within, LmdScratch& scratch,
                                     std::uint64_t maxNodePairs) noexcept {
  SurfaceDistance result;
  result.distance = kInfinity;
  if (!sceneFromPart.isFinite() || !(within > 0.0)) return result;
  if (scene.isEmpty() || part.isEmpty()) {
    result.lowerBound = within;
    result.isComplete = true;
    return result;
  }
  NearFaces faces(scene, part, sceneFromPart, std::min(within, reachOf(scene, part, sceneFromPart)),
                  scratch.data());
  const PlacedFaces& placed = faces.placed();
  const double rounding = placed.rounding();
  double least = kInfinity, reach = within + rounding;
  const auto visit = [&](std::uint32_t s, std::uint32_t p) {
    ++result.trianglePairs;
    const TriangleCorners a = placed.sceneCorners(scene.faces()[s]), b = placed.partCorners(part.faces()[p]);
    if (areSurelyBeyond(a, b, reach)) return;
    const ClosestPoints found = closestOfTriangles(a, b);
    if (!(found.distanceSquared < least)) return;
    least = found.distanceSquared;
    reach = std::min(reach, std::sqrt(least) + rounding);
    result.scenePoint = scene.centre() + found.a;
    result.partPoint = scene.centre() + found.b;
    faces.tighten(std::sqrt(least));
  };
  result.isComplete = faces.run(visit, maxNodePairs);
  result.nodePairs = faces.work();
  const double nearest = std::sqrt(least);
  result.isFound = nearest <= within;
  if (result.isFound) result.distance = nearest;
  double bound = std::min(nearest, within);
  if (!result.isComplete) bound = std::min(bound, faces.leastNotVisited());
  result.lowerBound = std::max(0.0, bound - rounding);
  return result;
}

}  // namespace nearfit
