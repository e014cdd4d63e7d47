#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace nearfit {

/// Max number of corners of a hole that triangulateHole() takes: the triangulations that it compares can grow as their
/// square.
constexpr std::size_t kMaxHoleCorners = 2000;

/// Triangles that fill a closed polygon in space, of little bend and area, by index into its corners; each runs along
/// the polygon's edges in the polygon's direction. By CGAL's hole filling: A. Liepa, Filling holes in meshes, 2003.
/// @param corners  Finite, no two in one place.
/// Empty if there are fewer than three or more than kMaxHoleCorners corners, or no triangulation was found. Allocates.
std::vector<std::array<std::uint32_t, 3>> triangulateHole(std::span<const glm::dvec3> corners);

}  // namespace nearfit
