#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace nearfit {

/// The smallest rotation from one unit direction to another; a half turn is about any perpendicular axis. Real-time
/// safe.
inline glm::dquat leastTurn(const glm::dvec3& from, const glm::dvec3& to) noexcept {
  // Closer to a half turn, 1 + cos is mostly rounding.
  constexpr double kNearlyBack = -0.9999;
  const double cosine = glm::dot(from, to);
  if (cosine > kNearlyBack) {
    const glm::dvec3 axis = glm::cross(from, to);
    return glm::normalize(glm::dquat(1.0 + cosine, axis.x, axis.y, axis.z));
  }
  const glm::dvec3 other = std::abs(from.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 square = glm::normalize(glm::cross(from, other));
  // A half turn, then the small remainder.
  return glm::normalize(leastTurn(-from, to) * glm::dquat(0.0, square.x, square.y, square.z));
}

}  // namespace nearfit
