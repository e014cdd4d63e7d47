#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// Axis-aligned bounding box [m]; empty (lower > upper) until a point is added.
struct Aabb {
  glm::dvec3 lower{std::numeric_limits<double>::infinity()};
  glm::dvec3 upper{-std::numeric_limits<double>::infinity()};

  /// Grows the box to contain `p` [m].
  void add(const glm::dvec3& p) noexcept {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  /// Corners [m]: bit k of an index chooses the upper side along axis k.
  std::array<glm::dvec3, 8> corners() const noexcept {
    std::array<glm::dvec3, 8> all{};
    for (std::size_t i = 0; i < all.size(); ++i)
      all[i] = {(i & 1U ? upper : lower).x, (i & 2U ? upper : lower).y, (i & 4U ? upper : lower).z};
    return all;
  }
  bool isEmpty() const noexcept { return !(lower.x <= upper.x); }
  /// Centre [m]; NaN when empty.
  glm::dvec3 centre() const noexcept { return lower + 0.5 * (upper - lower); }
  /// Length of the diagonal [m]; 0 when empty.
  double diagonal() const noexcept { return isEmpty() ? 0.0 : glm::length(upper - lower); }
  /// Largest magnitude of a coordinate [m]; 0 when empty.
  double largestCoordinate() const noexcept {
    if (isEmpty()) return 0.0;
    const glm::dvec3 most = glm::max(glm::abs(lower), glm::abs(upper));
    return glm::max(most.x, glm::max(most.y, most.z));
  }
};

/// True if the boxes, boundaries included, share a point.
inline bool doOverlap(const Aabb& a, const Aabb& b) noexcept {
  return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y &&
         b.lower.y <= a.upper.y && a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

}  // namespace nearfit
