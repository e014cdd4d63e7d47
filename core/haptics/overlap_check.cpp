#include "core/haptics/overlap_check.h"

#include <algorithm>
#include <limits>

#include "core/proximity/contact_query.h"

namespace nearfit {

Clearance findClearance(const ServoScene& scene, const BroadPhase& bounds,
                        const RigidTransform& worldFromPart, double within, LmdScratch& scratch) {
  Clearance result;
  result.worldFromPart = worldFromPart;
  result.distance = within;
  const auto overlapping = std::make_shared<std::vector<std::uint32_t>>();
  const MovingBounds moving = movingBounds(scene, worldFromPart);
  std::vector<ContactPair> room(64);
  bounds.visitNear(moving.centre, moving.radius + within, [&](std::uint32_t body) {
    const ServoScene::Body& other = scene.bodies[body];
    const RigidTransform bodyFromPart = (other.worldFromPart.inverse() * worldFromPart).normalized();
    const ContactResult found =
        findContacts({other.geometry->tree(), scene.moving.geometry->tree(), bodyFromPart, within},
                     {within, 1e-9}, scratch, room, std::numeric_limits<std::uint64_t>::max());
    result.distance = std::min(result.distance, found.least);
  });
  std::sort(overlapping->begin(), overlapping->end());
  result.overlapping = overlapping;
  return result;
}

}  // namespace nearfit
