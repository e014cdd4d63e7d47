#pragma once

#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// Two unit directions square to a unit direction and to each other; with it, in this order, right-handed if it
/// is the third. They depend on it alone. Real-time safe.
inline std::array<glm::dvec3, 2> axesAcross(const glm::dvec3& direction) noexcept {
  const glm::dvec3 aside = std::abs(direction.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 first = glm::normalize(glm::cross(direction, aside));
  return {first, glm::cross(direction, first)};
}

}  // namespace nearfit
