#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

#include "core/math/triangle_corners.h"

namespace nearfit {

/// True if the triangles have a point in common; touching counts. Exact for the coordinates as given. Any
/// finite corners are allowed: a degenerate triangle is the segment or point that it covers. Not for the
/// servo thread: hard cases allocate.
bool doTrianglesMeet(const TriangleCorners& a, const TriangleCorners& b);

/// True if two triangles of one mesh have more in common than their shared corners and, if they
/// share two, the side between them. True if they share all three. Exact, as doTrianglesMeet(). Not
/// for the servo thread.
/// @param shared  Number of shared corners, 0 to 3. They come first in `a` and `b`, in the same order.
bool doTrianglesMeetBeyond(const TriangleCorners& a, const TriangleCorners& b, std::size_t shared);

/// Side of the triangle's plane on which the point lies, exactly: 1 in front (where the normal points), -1
/// behind, 0 in the plane. 0 if the triangle has no area.
int sideOf(const glm::dvec3& point, const TriangleCorners& triangle);

/// True if the corners lie on one line, exactly.
bool hasNoArea(const TriangleCorners& triangle);

/// Result of crossingOf().
enum class Crossing : std::int8_t {
  None,
  Out,      ///< From the back of the triangle to its front.
  In,       ///< From the front to the back.
  Unclear,  ///< Through an edge or corner: try another segment.
};

/// How the segment from `from` to `to` crosses a triangle, exactly. None if an end lies in the triangle's
/// plane, so neither end may lie in the triangle. Not for the servo thread.
Crossing crossingOf(const glm::dvec3& from, const glm::dvec3& to, const TriangleCorners& triangle);

}  // namespace nearfit
