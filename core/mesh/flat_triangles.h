#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// The height of a triangle over its longest edge, its least [unit of the points]; 0 for a point.
double leastHeight(std::span<const glm::dvec3> vertices, const Triangle& triangle);

/// Triangles that are lines, with a corner on the opposite edge, are exported where a row of vertices meets
/// one long edge (a T-junction). They have no normal, yet leaving them out tears the mesh open. Each is
/// swapped, together with the face behind its longest edge, for two fatter triangles that cover that face. No
/// vertex moves, the surface moves by `tolerance` at most. Left alone: those without such a face, or where a
/// swap would make nothing fatter, fold the surface, or double an edge.
/// @param tolerance  Height up to which a triangle counts as a line; 0: only those of no area at all.
/// @return The number of swaps. O(n log n) where there are any, else O(n).
std::uint64_t swapFlatTriangles(std::span<const glm::dvec3> vertices, std::vector<Triangle>& triangles,
                                double tolerance);

}  // namespace nearfit
