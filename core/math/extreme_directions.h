#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace nearfit {

/// Indices of the directions that bound the convex cone spanned by `directions`, in cyclic order. They are
/// the corners of the convex hull of the points where the directions pierce a plane perpendicular to `axis`.
/// Two indices if all directions lie in one plane, one if they coincide, none if there are none.
///
/// @param directions  Each has a positive component along `axis`; any length.
/// @param axis        Unit.
/// Allocates. O(n log n). Source: Andrew's monotone chain.
std::vector<std::size_t> extremeDirections(std::span<const glm::dvec3> directions, const glm::dvec3& axis);

}  // namespace nearfit
