#pragma once

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// Rotation by angles.x about the fixed x axis, then angles.y about y, then angles.z about z [rad].
inline glm::dquat rotationFromEulerAngles(const glm::dvec3& angles) noexcept {
  return glm::angleAxis(angles.z, glm::dvec3(0, 0, 1)) * glm::angleAxis(angles.y, glm::dvec3(0, 1, 0)) *
         glm::angleAxis(angles.x, glm::dvec3(1, 0, 0));
}

/// Inverse of rotationFromEulerAngles() for a unit quaternion [rad]: x and z in (-pi, pi], y in
/// [-pi/2, pi/2]. At y = +-pi/2 the angles x and z turn about the same axis; z is then 0 and x holds
/// the whole rotation.
inline glm::dvec3 eulerAnglesOf(const glm::dquat& rotation) noexcept {
  const glm::dmat3 m = glm::mat3_cast(rotation);  // m[column][row]
  const double sinY = std::clamp(-m[0][2], -1.0, 1.0);
  const double cosY = std::hypot(m[0][0], m[0][1]);
  const double y = std::atan2(sinY, cosY);
  // Below this, x and z are rounding noise, and the rotation lost by setting z to 0 is as small.
  constexpr double kLocked = 1e-9;
  if (cosY < kLocked) return {std::atan2(-m[2][1], m[1][1]), y, 0.0};
  return {std::atan2(m[1][2], m[2][2]), y, std::atan2(m[0][1], m[0][0])};
}

}  // namespace nearfit
