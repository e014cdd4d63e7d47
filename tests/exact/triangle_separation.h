#pragma once

#include <array>

#include <glm/vec3.hpp>

namespace nearfit::test {

/// No less than nothing and no more than the distance of two triangles [m]: the widest gap that a slab
/// between them has, over the directions along which two features can be nearest (two corners, corner and
/// edge, corner and face, edge and edge). It is the distance but for rounding. However a direction comes
/// about, the gap that is found square to it is there: no rounding of the direction makes the answer too
/// large. Rounding of the gap itself is the caller's, some 1e-15 of the coordinates' differences.
///
/// @param most  More is not asked for: the search ends at the first gap as wide.
double separation(const std::array<glm::dvec3, 3>& a, const std::array<glm::dvec3, 3>& b, double most);

}  // namespace nearfit::test
