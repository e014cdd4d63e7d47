#include "core/placing/pivot.h"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

namespace nearfit {

glm::dvec3 centreOfMass(std::span<const PlacedPart> parts) noexcept {
  glm::dvec3 sum(0.0), plain(0.0);
  double total = 0.0;
  for (const PlacedPart& placed : parts) {
    const glm::dvec3 centre = placed.worldFromPart.applyToPoint(placed.part->geometry->mass.centre);
    const double mass = massOf(*placed.part);
    sum += mass * centre;
    plain += centre;
    total += mass;
  }
  // Keep a single part's centre exact.
  if (parts.size() == 1 || !(total > 0.0)) return plain / static_cast<double>(parts.size());
  return sum / total;
}

glm::dvec3 boxCentre(std::span<const PlacedPart> parts) noexcept {
  const RigidTransform& worldFromFirst = parts.front().worldFromPart;
  Aabb all;
  for (const PlacedPart& placed : parts) {
    const RigidTransform firstFromPart = worldFromFirst.inverse() * placed.worldFromPart;
    const Aabb& box = placed.part->geometry->mesh.bounds();
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 point((corner & 1) != 0 ? box.upper.x : box.lower.x,
                             (corner & 2) != 0 ? box.upper.y : box.lower.y,
                             (corner & 4) != 0 ? box.upper.z : box.lower.z);
      all.add(parts.size() == 1 ? point : firstFromPart.applyToPoint(point));
    }
  }
  return worldFromFirst.applyToPoint(all.centre());
}

std::optional<glm::dvec3> sharedPivot(std::span<const PlacedPart> parts) noexcept {
  // Rounding of a few multiplied poses.
  constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
  std::optional<glm::dvec3> shared;
  for (const PlacedPart& placed : parts) {
    if (!placed.part->pivot) return std::nullopt;
    const glm::dvec3 pivot = placed.worldFromPart.applyToPoint(*placed.part->pivot);
    if (!shared) shared = pivot;
    if (glm::distance(pivot, *shared) > kPivotSlack + kRounding * glm::length(pivot)) return std::nullopt;
  }
  return shared;
}

bool meetsBox(const ViewRay& ray, const PlacedPart& part) noexcept {
  const RigidTransform partFromWorld = part.worldFromPart.inverse();
  const glm::dvec3 origin = partFromWorld.applyToPoint(ray.origin);
  const glm::dvec3 direction = partFromWorld.applyToVector(ray.direction);
  const Aabb& box = part.part->geometry->mesh.bounds();
  double from = -std::numeric_limits<double>::infinity(), to = -from;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) {
      if (origin[axis] < box.lower[axis] || origin[axis] > box.upper[axis]) return false;
      continue;
    }
    const double a = (box.lower[axis] - origin[axis]) / direction[axis];
    const double b = (box.upper[axis] - origin[axis]) / direction[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to;
}

}  // namespace nearfit
