#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace nearfit {

/// Those of `directions` that bound the convex cone which they span, as indices in cyclic order: the corners
/// of the hull of where they pierce a plane across `axis`. Two where all lie in one plane, one where they are
/// one direction.
///
/// @param axis  Unit; every direction has a part along it, > 0.
/// Source: Andrew's monotone chain. O(n log n).
std::vector<std::size_t> extremeDirections(std::span<const glm::dvec3> directions, const glm::dvec3& axis);

}  // namespace nearfit
