#pragma once

#include <span>

#include <glm/vec3.hpp>

namespace nearfit {

/// Point of the convex hull of `points` that is nearest to the origin; zero if the hull contains the origin
/// to rounding, or if there are no points. A few iterations, each linear in the points; no allocation.
/// Source: Gilbert, Johnson and Keerthi 1988; the sub-simplex is found by enumeration.
glm::dvec3 minNormPoint(std::span<const glm::dvec3> points);

}  // namespace nearfit
