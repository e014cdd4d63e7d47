#pragma once

#include <array>
#include <cstddef>

#include <glm/vec3.hpp>

namespace nearfit {

/// Convex polygon with at most six corners, as in the intersection of two triangles.
struct ConvexPolygon {
  std::array<glm::dvec3, 6> corners{};
  std::size_t count = 0;
};

/// Clips the interval [from, to] of the line start + s * along to the triangle, seen along its normal.
/// @param slack  Moves the triangle's sides outward [m], so that a line along the common side of two coplanar
///               triangles is over both, not over neither.
/// False if nothing is left. Real-time safe.
bool clipLine(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& normal, const glm::dvec3& start,
              const glm::dvec3& along, double slack, double& from, double& to) noexcept;

/// Clips `polygon` (at first the three corners of a triangle) to another triangle, seen along that one's
/// normal. Source: Sutherland & Hodgman 1974. Real-time safe.
void clipPolygon(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& normal,
                 ConvexPolygon& polygon) noexcept;

/// Returns the area seen along the unit `normal` [m^2], and sets the centroid [m]. Degenerate polygons have
/// area 0 and a corner as centroid; an empty one leaves the centroid unchanged. Real-time safe.
double polygonArea(const ConvexPolygon& polygon, const glm::dvec3& normal, glm::dvec3& centroid) noexcept;

}  // namespace nearfit
