#include "core/servo/overlap_check.h"

#include <algorithm>
#include <limits>

#include "core/proximity/overlap/interference.h"
#include "core/proximity/surface/surface_distance.h"

namespace nearfit {

Clearance findClearance(const ServoScene& scene, const BroadPhase& bounds,
                        const RigidTransform& worldFromPart, double within, LmdScratch& scratch) {
  constexpr std::uint64_t kUnbounded = std::numeric_limits<std::uint64_t>::max();
  Clearance result;
  result.worldFromPart = worldFromPart;
  result.distance = within;
  const auto overlapping = std::make_shared<std::vector<std::uint32_t>>();
  const PartGeometry& part = *scene.moving.geometry;
  const MovingBounds moving = movingBounds(scene, worldFromPart);
  bounds.visitNear(moving.centre, moving.radius + within, [&](std::uint32_t index) {
    const ServoScene::Body& body = scene.bodies[index];
    const PartGeometry& other = *body.geometry;
    const RigidTransform bodyFromPart = (body.worldFromPart.inverse() * worldFromPart).normalized();
    // The tick reports invalid poses.
    if (!bodyFromPart.isFinite()) return;
    const Interference found = findInterference(other.tree(), part.tree(), bodyFromPart);
    if (found.kind != InterferenceKind::Disjoint) {
      overlapping->push_back(index);
      return;
    }
    const SurfaceDistance distance =
        leastSurfaceDistance(other.tree(), part.tree(), bodyFromPart, within, scratch, kUnbounded);
    const double bound = distance.lowerBound - scene.deviation(body);
    // Too near for rounding, of the file or of numbers, to tell from touching.
    if (!(bound > 0.0)) {
      overlapping->push_back(index);
      return;
    }
    result.distance = std::min(result.distance, bound);
  });
  std::sort(overlapping->begin(), overlapping->end());
  result.overlapping = overlapping;
  return result;
}

}  // namespace nearfit
