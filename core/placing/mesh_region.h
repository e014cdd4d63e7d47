#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"
#include "core/placing/circle_fit.h"

namespace nearfit {

/// Edges that turn by less are the facets of something round; others are edges of the shape [rad]: 30 degrees
/// and a little, as the view draws them.
constexpr double kSharpTurn = 0.5238;

/// Unit normal of a triangle; zero where it has no area.
glm::dvec3 triangleNormal(const TriangleMesh& mesh, std::uint32_t triangle) noexcept;

/// Whether an edge is one of the shape: it is open, several faces meet in it, or it turns by more than
/// kSharpTurn.
bool isSharp(const TriangleMesh& mesh, std::uint32_t edge) noexcept;

/// Connected triangles in one plane.
struct PlaneRegion {
  std::vector<std::uint32_t> triangles;
  glm::dvec3 point{0.0}, normal{0.0};  ///< The middle of its area [m]; unit, outward.
};

/// The flat face around a triangle: triangles that are connected through edges and lie in its plane, to what
/// single precision leaves of that. O(n log n) of the face. Empty where the triangle has no area.
PlaneRegion planeRegion(const TriangleMesh& mesh, std::uint32_t triangle);

/// Connected triangles whose corners lie on one cylinder.
struct CylinderRegion {
  std::vector<std::uint32_t> triangles;
  Circle cylinder;  ///< Its centre in the middle of the region's length.
};

/// The cylinder, bore or fillet that a triangle is a facet of, where there is one: at least four facets wide,
/// none much wider than the others. O(n log n) of the region.
std::optional<CylinderRegion> cylinderRegion(const TriangleMesh& mesh, std::uint32_t triangle);

}  // namespace nearfit
