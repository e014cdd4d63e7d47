#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace nearfit {

/// Of a point from an open line [pixels]; infinity where the line has no point.
double distanceToLine(std::span<const glm::dvec2> line, const glm::dvec2& point) noexcept;

/// Whether a point lies in a polygon that closes itself; by the even-odd rule.
bool isInside(std::span<const glm::dvec2> polygon, const glm::dvec2& point) noexcept;

/// The corners of the convex hull, in order; the points themselves where there are fewer than three.
/// O(n log n).
std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points);

}  // namespace nearfit
