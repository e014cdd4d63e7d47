#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

#include "core/math/triangle_corners.h"

namespace nearfit {

/// Whether the two have a point in common; touching counts. Decided exactly for the coordinates as given. Any
/// three finite points will do: a triangle of no area is the segment or the point that it covers. Not for the
/// servo thread: hard cases allocate.
bool doTrianglesMeet(const TriangleCorners& a, const TriangleCorners& b);

/// Whether two triangles of one mesh have more in common than the corners that they share, or the side
/// between two of these; all three shared count as more. Decided exactly, as doTrianglesMeet.
/// @param shared  How many they share, from 0 to 3: the first of each, in one order.
bool doTrianglesMeetBeyond(const TriangleCorners& a, const TriangleCorners& b, std::size_t shared);

/// Which side of a triangle's plane a point lies on, decided exactly: 1 for the one that the triangle faces,
/// -1 for the one behind, 0 in the plane. 0 for any point where the triangle has no area.
int sideOf(const glm::dvec3& point, const TriangleCorners& triangle);

/// Whether the corners lie on a line, decided exactly.
bool hasNoArea(const TriangleCorners& triangle);

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
