#pragma once

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

namespace nearfit {

/// Corners in one frame. Any three finite points: a triangle of no area is the segment or the point that it
/// covers.
using TriangleCorners = std::array<glm::dvec3, 3>;

/// Whether the two have a point in common; touching counts. Decided exactly for the coordinates as given.
/// Not for the servo thread: hard cases allocate.
bool doTrianglesMeet(const TriangleCorners& a, const TriangleCorners& b);

enum class Crossing : std::int8_t {
  None,
  Out,      ///< From the side that the triangle turns its back to, to the one that it faces.
  In,       ///< The other way.
  Unclear,  ///< Through an edge or a corner: ask again with another segment.
};

/// How a segment passes through a triangle, decided exactly. Ends that lie in the triangle's plane do not
/// count as passing: neither end may lie in the triangle. Not for the servo thread.
Crossing crossingOf(const glm::dvec3& from, const glm::dvec3& to, const TriangleCorners& triangle);

}  // namespace nearfit
