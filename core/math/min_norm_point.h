#pragma once

#include <span>

#include <glm/vec3.hpp>

namespace nearfit {

/// The point of the convex hull of `points` that is nearest to the origin; the zero vector when the hull
/// holds it to rounding. Linear in the points for each of a few iterations. Source: Gilbert, Johnson and
/// Keerthi 1988, with the sub-simplex found by enumeration.
glm::dvec3 minNormPoint(std::span<const glm::dvec3> points);

}  // namespace nearfit
