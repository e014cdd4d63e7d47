#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace nearfit {

/// For each point the index of the point that stands for it: the first in the list within `tolerance` of it
/// that stands for itself, or the point itself. So no point moves farther than the tolerance, and chains of
/// close points do not run together into one. Expected O(n): a hash grid.
/// @param points     All finite.
/// @param tolerance  [unit of the points]; >= 0; 0 joins equal points only.
std::vector<std::uint32_t> weldPoints(std::span<const glm::dvec3> points, double tolerance);

}  // namespace nearfit
