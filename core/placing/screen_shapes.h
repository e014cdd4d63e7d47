#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace nearfit {

/// Distance of a point from an open polyline [pixels]; infinity if the line is empty.
double distanceToLine(std::span<const glm::dvec2> line, const glm::dvec2& point) noexcept;

/// True if a point is inside a closed polygon, by the even-odd rule.
bool isInside(std::span<const glm::dvec2> polygon, const glm::dvec2& point) noexcept;

/// Corners of the convex hull, in order; fewer than three points are returned as they are. O(n log n).
std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points);

}  // namespace nearfit
