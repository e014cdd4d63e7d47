#pragma once

#include <cmath>

#include <glm/vec3.hpp>

namespace nearfit {

/// True if no component is infinite or NaN.
inline bool isFinite(const glm::dvec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace nearfit
