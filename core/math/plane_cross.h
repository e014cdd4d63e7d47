#pragma once

#include <glm/vec2.hpp>

namespace nearfit {

/// Cross product of two vectors in a plane: the component along the plane's normal. Real-time safe.
inline double cross(const glm::dvec2& a, const glm::dvec2& b) noexcept {
  return a.x * b.y - a.y * b.x;
}

}  // namespace nearfit
