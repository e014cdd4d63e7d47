#pragma once

#include <array>
#include <cstddef>

#include <glm/vec3.hpp>

namespace nearfit {

/// A convex polygon with at most six corners: what two triangles can have in common.
struct ConvexPolygon {
  std::array<glm::dvec3, 6> corners{};
  std::size_t count = 0;
};

/// Cuts [from, to] of the line start + s * along to where it passes over the triangle, seen along its normal.
/// @param slack  The triangle's sides are moved outward by this [m], so that a line along the side that two
///               coplanar triangles share is over both rather than over none.
/// False when nothing is left. Real-time safe.
bool clipLine(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& normal, const glm::dvec3& start,
              const glm::dvec3& along, double slack, double& from, double& to) noexcept;

/// Keeps what of a triangle (as `polygon`) lies over the other triangle, seen along that one's normal.
/// Source: Sutherland & Hodgman 1974. Real-time safe.
void clipPolygon(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& normal,
                 ConvexPolygon& polygon) noexcept;

/// Area seen along the unit `normal`, and centroid; the area is 0 and the centroid a corner when degenerate.
double polygonArea(const ConvexPolygon& polygon, const glm::dvec3& normal, glm::dvec3& centroid) noexcept;

}  // namespace nearfit
