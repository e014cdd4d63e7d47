#pragma once

#include <glm/vec3.hpp>

namespace nearfit {

/// Force [N] and torque [N m] on the moving part, about its centre of mass unless stated otherwise.
struct Wrench {
  glm::dvec3 force{0.0};
  glm::dvec3 torque{0.0};
};

/// Velocity of the centre of mass [m/s] and angular velocity [rad/s].
struct Twist {
  glm::dvec3 linear{0.0};
  glm::dvec3 angular{0.0};
};

}  // namespace nearfit
