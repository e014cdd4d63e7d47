#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace nearfit {

/// Rotation vector (axis times angle) of a unit quaternion [rad]; its length is at most pi.
inline glm::dvec3 rotationVector(glm::dquat q) noexcept {
  if (q.w < 0.0) q = -q;
  const glm::dvec3 sine(q.x, q.y, q.z);
  const double length = glm::length(sine);
  // Below this sin(x) = x to the last bit, and the quotient would be 0/0 at zero.
  if (length < 1e-9) return 2.0 * sine;
  return sine * (2.0 * std::atan2(length, q.w) / length);
}

/// Unit quaternion of a rotation vector (axis times angle) [rad].
inline glm::dquat rotationOf(const glm::dvec3& vector) noexcept {
  const double angle = glm::length(vector);
  if (angle < 1e-9) return glm::normalize(glm::dquat(1.0, 0.5 * vector.x, 0.5 * vector.y, 0.5 * vector.z));
  return glm::angleAxis(angle, vector / angle);
}

}  // namespace nearfit
