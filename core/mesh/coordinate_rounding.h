#pragma once

#include <span>

#include <glm/vec3.hpp>

namespace nearfit {

/// Estimates to what the coordinates of a file are rounded, from the numbers alone: single precision if all are
/// single-precision numbers, or the last decimal place if all have few digits, whichever is finer; else double
/// precision. Looks at a sample of the points.
/// @return Max rounding error of the largest coordinate, in the points' unit. Round numbers, such as those of a
/// box, look coarse: the caller bounds what it allows for. 0 if no point is finite.
double coordinateRounding(std::span<const glm::dvec3> points);

}  // namespace nearfit
