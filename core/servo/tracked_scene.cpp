#include "core/servo/tracked_scene.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "core/haptics/virtual_coupling.h"

namespace nearfit {
namespace {

/// Rounding of the sphere at a pose, as a fraction of the lengths involved.
constexpr double kSpherePadding = 1e-12;

}  // namespace

SearchReach searchReach(const HapticSettings& settings) noexcept {
  const bool isProxy = settings.mode == HapticMode::Proxy;
  return {settings.springs.cutoff, isProxy ? kContactReach * settings.proxy.margin : 0.0};
}

MovingBounds movingBounds(const ServoScene& scene, const RigidTransform& worldFromPart) noexcept {
  const Aabb& box = scene.moving.geometry->mesh.bounds();
  const glm::dvec3 centre = worldFromPart.applyToPoint(box.centre());
  const double radius = 0.5 * box.diagonal();
  return {centre, radius + kSpherePadding * (radius + glm::length(centre) + glm::length(box.centre()))};
}

double travelBetween(const ServoScene& scene, const RigidTransform& from, const RigidTransform& to) noexcept {
  const glm::dvec3 shift = to.applyToPoint(scene.centreInPart) - from.applyToPoint(scene.centreInPart);
  return glm::length(shift) + scene.metric.radius * glm::length(turnBetween(from.rotation, to.rotation));
}

TrackedScene untracked(std::shared_ptr<const ServoScene> scene) {
  TrackedScene out;
  std::vector<Aabb> boxes;
  boxes.reserve(scene->bodies.size());
  for (const ServoScene::Body& body : scene->bodies)
    boxes.push_back(body.geometry ? boundsOf(body.geometry->mesh.bounds(), body.worldFromPart) : Aabb{});
  out.bounds = std::make_shared<const BroadPhase>(boxes);
  out.scene = std::move(scene);
  return out;
}

double TrackedScene::spent(const RigidTransform& pose, double forCutoff) const noexcept {
  if (!(forCutoff <= cutoff)) return std::numeric_limits<double>::infinity();
  const Aabb& box = scene->moving.geometry->mesh.bounds();
  // About the middle of the part, so that turning on the spot spends the least.
  const auto centred = [&](const RigidTransform& p) {
    return RigidTransform{p.rotation, p.applyToPoint(box.centre())};
  };
  return spentShare(motionBetween(centred(worldFromPart), centred(pose), 0.5 * box.diagonal()), clear);
}

double TrackedScene::clearanceSpent(const RigidTransform& pose) const noexcept {
  if (clearance.serial == 0) return std::numeric_limits<double>::infinity();
  // No solid comes within the cutoff on the way, so none is entered or left either.
  const bool isAllFar = near.empty() && clearance.overlapping->empty() && spent(pose, cutoff) <= 1.0 &&
                        spent(clearance.worldFromPart, cutoff) <= 1.0;
  if (isAllFar) return 0.0;
  const double travel = travelBetween(*scene, clearance.worldFromPart, pose);
  if (travel == 0.0) return 0.0;
  return travel <= std::numeric_limits<double>::max() && clearance.distance > 0.0
             ? travel / clearance.distance
             : std::numeric_limits<double>::infinity();
}

const TrackedScene::Near* TrackedScene::findNear(std::uint32_t body) const noexcept {
  const auto found = std::lower_bound(near.begin(), near.end(), body,
                                      [](const Near& entry, std::uint32_t b) { return entry.body < b; });
  return found != near.end() && found->body == body ? &*found : nullptr;
}

}  // namespace nearfit
