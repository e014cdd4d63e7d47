#include "core/proximity/query/blocked_minima.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "core/math/tolerances.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/query_workspace.h"
#include "core/proximity/query/segment_obstacle.h"

namespace nearfit {

void markBlocked(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
                 std::span<Lmd> lmds, double leastDistance, LmdScratch& scratch) noexcept {
  if (scene.isEmpty() || part.isEmpty() || !sceneFromPart.isFinite()) return;
  const double touch = kSegmentTouch * (scene.size() + part.size());
  const SegmentKernel kernel = scratch.data().segmentCull;
  const SegmentObstacle sceneObstacle(scene, kernel, touch), partObstacle(part, kernel, touch);
  const RigidTransform partFromScene = centredPose(scene, part, sceneFromPart).inverse();
  for (Lmd& lmd : lmds) {
    const glm::dvec3 start = scenePointInside(lmd) - scene.centre();
    // Away from its centroid, a region that is not quite flat lies slightly off the segment's ends.
    const double off = kFlatTolerance * (2.0 * lmd.extent.halfLength + glm::length(lmd.extent.inside));
    const SegmentStretch open{touch + off, lmd.distance - touch - off};
    // If the segment crosses the scene, the rest of it joins the scene to its end on the part, and is no
    // shorter than the least distance. The same holds for the part, seen from the other end. So the nearest
    // minimum of bodies that do not interpenetrate is never blocked, and those not much
    // longer need few tests.
    const SegmentStretch byScene{open.from, std::min(open.to, lmd.distance - leastDistance + touch + off)};
    const SegmentStretch byPart{std::max(open.from, leastDistance - touch - off), open.to};
    lmd.isBlocked = sceneObstacle.blocks(start, lmd.direction, byScene) ||
                    partObstacle.blocks(partFromScene.applyToPoint(start),
                                        partFromScene.applyToVector(lmd.direction), byPart);
  }
}

}  // namespace nearfit
