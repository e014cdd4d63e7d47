#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"

namespace nearfit {

/// The three corners of a triangle, in one frame [m].
using TriangleCorners = std::array<glm::dvec3, 3>;

inline Aabb boxOf(const TriangleCorners& corners) noexcept {
  Aabb box;
  for (const glm::dvec3& p : corners)
    box.add(p);
  return box;
}

}  // namespace nearfit
