#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_set>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"
#include "core/placing/circle_fit.h"
#include "core/placing/cone_fit.h"

namespace nearfit {

/// Min angle between faces at a sharp edge [rad]: slightly more than 30 degrees, as in the view. Below it,
/// faces are facets of something round.
constexpr double kSharpTurn = 0.5238;

/// Unit normal of a triangle; zero if it has no area.
glm::dvec3 triangleNormal(const TriangleMesh& mesh, std::uint32_t triangle) noexcept;

/// Centre of the area of triangles; the first one's corner if none has an area [m].
/// @param triangles  At least one.
glm::dvec3 centroidOf(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) noexcept;

/// True if an edge belongs to the shape: it is open, non-manifold or inconsistently oriented, or its face
/// normals differ by more than kSharpTurn.
bool isSharp(const TriangleMesh& mesh, std::uint32_t edge) noexcept;

/// Triangles connected to `first` through edges with two faces, as long as `accepts(triangle)`. `first` is
/// always included. O(n) in the region.
/// @param most  Max number of triangles.
template <class Accept>
std::vector<std::uint32_t> grownRegion(const TriangleMesh& mesh, std::uint32_t first, Accept&& accepts,
                                       std::size_t most = TriangleMesh::kMaxTriangles) {
  std::vector<std::uint32_t> region{first};
  std::unordered_set<std::uint32_t> seen{first};
  for (std::size_t next = 0; next < region.size() && region.size() < most; ++next) {
    for (const std::uint32_t edge : mesh.edgesOfTriangle(region[next])) {
      const auto faces = mesh.facesOfEdge(edge);
      if (faces.size() != 2) continue;
      const std::uint32_t other = faces[0] == region[next] ? faces[1] : faces[0];
      if (seen.insert(other).second && accepts(other)) region.push_back(other);
    }
  }
  return region;
}

/// Connected triangles in one plane.
struct PlaneRegion {
  std::vector<std::uint32_t> triangles;
  glm::dvec3 point{0.0}, normal{0.0};  ///< Centroid [m]; unit outward normal.
};

/// The flat face around a triangle: triangles connected through edges that lie in its plane, within single
/// precision. Empty if the triangle has no area. O(n log n) in the face.
PlaneRegion planeRegion(const TriangleMesh& mesh, std::uint32_t triangle);

/// Connected triangles whose corners lie on one cylinder, or on a flat facet between two lines along it: where a slot
/// or hole cuts a facet, it has corners nearer to the axis.
struct CylinderRegion {
  std::vector<std::uint32_t> triangles;
  Circle cylinder;      ///< Its centre is at the middle of the region's length.
  bool isRing = false;  ///< It goes all round the axis.
};

/// The cylinder, bore or fillet that a triangle is a facet of; std::nullopt if there is none. Facets meet at less than
/// kSharpTurn, and the region is a ring or at least four facets wide, none much wider than the others (isRing(),
/// isFineArc()). O(n log n) in the region.
std::optional<CylinderRegion> cylinderRegion(const TriangleMesh& mesh, std::uint32_t triangle);

/// Connected triangles whose corners lie on one cone or cylinder.
struct ConeRegion {
  std::vector<std::uint32_t> triangles;
  Cone cone;               ///< Its centre is at the middle of the region's length. Slope 0: a cylinder.
  std::size_t facets = 0;  ///< Lines along it that corners lie on.
};

/// The cone, or coarse cylinder, that a triangle is a facet of; std::nullopt if there is none. Its facets may be of
/// any width: a ring of at least eight, or an arc as of a cylinder. Half angles up to 60 degrees. Corners are within
/// 0.2 % of the radius of it, facets within 0.3 degrees of the inclination that it gives them; the axis of a ring in
/// single precision is good to some 1e-6 of its length. O(n log n) in the region.
/// @param isPrism  Takes a ring of at least six equal flats instead, as of a nut; never a cone.
std::optional<ConeRegion> coneRegion(const TriangleMesh& mesh, std::uint32_t triangle, bool isPrism = false);

}  // namespace nearfit
