#include "core/proximity/surface/triangle_list.h"

#include <algorithm>
#include <cmath>

#include "core/proximity/query/motion_budget.h"
#include "core/proximity/surface/near_faces.h"

namespace nearfit {
namespace {

/// Separates a pair by the nearest points of the two triangles.
void separate(const UnsidedSurface& scene, const UnsidedSurface& part, const PlacedFaces& placed,
              TrianglePair& pair) noexcept {
  const ClosestPoints closest = closestOfTriangles(placed.sceneCorners(scene.tree().faces()[pair.scene]),
                                                   placed.partCorners(part.tree().faces()[pair.part]));
  const double distance = std::sqrt(closest.distanceSquared);
  if (!(distance > 0.0)) return;
  pair.direction = (closest.b - closest.a) / distance;
  pair.atLeast = pair.known = std::max(0.0, distance - placed.rounding());
}

}  // namespace

void TriangleList::build(const UnsidedSurface& scene, const UnsidedSurface& part,
                         const RigidTransform& sceneFromPart, double within, LmdScratch& scratch,
                         std::size_t maxPairs, std::uint64_t maxWork) {
  pose_ = sceneFromPart;
  centre_ = part.tree().centre();
  radius_ = 0.5 * part.tree().size();
  found_.resize(maxPairs);
  const NearbyTriangles nearby =
      findNearbyTriangles(scene, part, sceneFromPart, within, scratch, found_, maxWork);
  within_ = nearby.within;
  const PlacedFaces placed(scene.tree(), part.tree(), sceneFromPart);
  order_.resize(nearby.count);
  for (std::uint32_t i = 0; i < nearby.count; ++i) {
    if (found_[i].direction == glm::dvec3(0.0)) separate(scene, part, placed, found_[i]);
    order_[i] = {found_[i].atLeast, i};
  }
  std::sort(order_.begin(), order_.end());
  pairs_.resize(nearby.count);
  for (std::size_t i = 0; i < nearby.count; ++i)
    pairs_[i] = found_[order_[i].second];
}

double TriangleList::travelTo(const RigidTransform& sceneFromPart) const noexcept {
  const auto centred = [this](const RigidTransform& pose) {
    return RigidTransform{pose.rotation, pose.applyToPoint(centre_)};
  };
  return motionBetween(centred(pose_), centred(sceneFromPart), radius_).travel;
}

TriangleList::Around TriangleList::around(const RigidTransform& sceneFromPart,
                                          std::size_t mostPairs) const noexcept {
  Around out;
  out.travel = travelTo(sceneFromPart);
  const std::size_t count = std::min(mostPairs, pairs_.size());
  out.pairs = std::span(pairs_).first(count);
  const double listed = count < pairs_.size() ? std::min(within_, pairs_[count].atLeast) : within_;
  out.within = listed - out.travel;
  return out;
}

}  // namespace nearfit
