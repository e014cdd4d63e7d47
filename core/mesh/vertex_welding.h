#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace nearfit {

/// Returns for each point the index of its representative: the first representative in the list within
/// `tolerance`, or the point itself. So no point moves farther than the tolerance, and chains of close points
/// do not collapse. Expected O(n), with a hash grid.
/// @param points     All finite.
/// @param tolerance  [unit of the points]; >= 0. 0 joins only equal points.
std::vector<std::uint32_t> weldPoints(std::span<const glm::dvec3> points, double tolerance);

}  // namespace nearfit
