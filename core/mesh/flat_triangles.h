#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Height of a triangle over its longest edge, its smallest height [unit of the points]; 0 for a point.
double leastHeight(std::span<const glm::dvec3> vertices, const Triangle& triangle);

/// Replaces triangles that are lines, with a corner on the opposite edge. Exporters write them where a row of
/// vertices meets one long edge (a T-junction). They have no normal, but dropping them would tear the mesh
/// open. Each is swapped, together with the face behind its longest edge, for two fatter triangles that cover
/// that face. No vertex moves; the surface moves by at most `tolerance`. Lines stay if they have no such
/// face, or if a swap would make nothing fatter, fold the surface or duplicate an edge.
/// @param tolerance  Max height of a line [unit of the points]; 0: only triangles without area.
/// @param sources    What each triangle came from; both triangles of a swap get that of the face that they cover.
///                   May be null.
/// @return Number of swaps. O(n log n) if there are lines, else O(n).
std::uint64_t swapFlatTriangles(std::span<const glm::dvec3> vertices, std::vector<Triangle>& triangles,
                                double tolerance, std::vector<std::uint32_t>* sources = nullptr);

}  // namespace nearfit
