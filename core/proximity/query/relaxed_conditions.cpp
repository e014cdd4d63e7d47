#include "core/proximity/query/relaxed_conditions.h"

#include <algorithm>
#include <cstddef>

#include <glm/geometric.hpp>

#include "core/math/tolerances.h"

namespace nearfit {
namespace {

/// True if x, no longer than 1, is on the inner side of the wall perpendicular to e, to rounding.
bool isInsideWall(const glm::dvec3& x, const glm::dvec3& e) noexcept {
  const double beyond = glm::dot(x, e);
  return beyond <= 0.0 || beyond * beyond <= kAngularTolerance * kAngularTolerance * glm::dot(e, e);
}

/// Projects a direction onto the wall perpendicular to e.
glm::dvec3 onWall(const glm::dvec3& direction, const glm::dvec3& e) noexcept {
  return direction - e * (glm::dot(direction, e) / glm::dot(e, e));
}

}  // namespace

bool isNearPolarCone(const glm::dvec3& apex, std::span<const std::uint32_t> neighbours,
                     std::span<const glm::dvec3> positions, const glm::dvec3& direction,
                     double sine) noexcept {
  const auto edge = [&](std::size_t i) { return positions[neighbours[i]] - apex; };
  const auto holds = [&](const glm::dvec3& x) {
    return std::ranges::all_of(neighbours,
                               [&](std::uint32_t n) { return isInsideWall(x, positions[n] - apex); });
  };
  // The nearest direction of the cone lies in a wall, or where two walls meet.
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const glm::dvec3 e = edge(i);
    if (glm::dot(direction, e) > 0.0 && holds(onWall(direction, e))) return true;
  }
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    for (std::size_t k = i + 1; k < neighbours.size(); ++k) {
      const glm::dvec3 ray = glm::cross(edge(i), edge(k));
      const double length = glm::length(ray);
      if (!(length > 0.0)) continue;
      const glm::dvec3 unit = ray / (glm::dot(ray, direction) < 0.0 ? -length : length);
      const glm::dvec3 off = glm::cross(direction, unit);
      if (glm::dot(off, off) <= sine * sine && holds(unit)) return true;
    }
  }
  return false;
}

bool isOnSideOfPolarArc(const std::array<glm::dvec3, 2>& inward, const glm::dvec3& direction) noexcept {
  const auto isEnd = [&](std::size_t i) {
    return glm::dot(direction, inward[i]) > 0.0 && isInsideWall(onWall(direction, inward[i]), inward[1 - i]);
  };
  return isEnd(0) || isEnd(1);
}

bool isNearTriangle(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& normal,
                    const glm::dvec3& point, double distance) noexcept {
  bool isInside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &a = corners[k], side = corners[(k + 1) % 3] - a;
    const glm::dvec3 w = point - a, foot = w - glm::dot(w, normal) * normal;
    if (glm::dot(glm::cross(normal, side), foot) >= 0.0) continue;
    isInside = false;
    const double along = std::clamp(glm::dot(foot, side) / glm::dot(side, side), 0.0, 1.0);
    const glm::dvec3 beside = foot - along * side;
    if (glm::dot(beside, beside) <= distance * distance) return true;
  }
  return isInside;
}

}  // namespace nearfit
