#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// All directions within `halfAngle` of `axis`.
struct NormalCone {
  glm::dvec3 axis{0.0, 0.0, 1.0};       ///< Unit.
  double halfAngle = std::numbers::pi;  ///< [rad], 0 to pi; pi contains every direction.
};

/// Angle between two unit vectors [rad], accurate also near 0 and pi.
inline double angleBetween(const glm::dvec3& a, const glm::dvec3& b) noexcept {
  return 2.0 * std::atan2(glm::length(a - b), glm::length(a + b));
}

/// Cone that contains all `cones`; its axis is along the sum of theirs. Contains every direction if the axes
/// cancel or `cones` is empty. O(n); real-time safe.
inline NormalCone boundingCone(std::span<const NormalCone> cones) noexcept {
  glm::dvec3 sum(0.0);
  for (const NormalCone& c : cones)
    sum += c.axis;
  const double length = glm::length(sum);
  // The direction of a smaller sum is noise.
  constexpr double kNoDirection = 1e-6;
  if (!(length > kNoDirection * static_cast<double>(cones.size()))) return {};
  NormalCone bound{sum / length, 0.0};
  for (const NormalCone& c : cones) {
    bound.halfAngle = std::max(bound.halfAngle, angleBetween(bound.axis, c.axis) + c.halfAngle);
  }
  bound.halfAngle = std::min(bound.halfAngle, std::numbers::pi);
  return bound;
}

}  // namespace nearfit
