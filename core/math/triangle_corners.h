#pragma once

#include <array>

#include <glm/vec3.hpp>

namespace nearfit {

/// The three corners of a triangle, in one frame [m].
using TriangleCorners = std::array<glm::dvec3, 3>;

}  // namespace nearfit
