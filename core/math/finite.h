#pragma once

#include <cmath>

#include <glm/vec3.hpp>

namespace nearfit {

/// Whether no component is infinite or not a number.
inline bool isFinite(const glm::dvec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace nearfit
