#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "tests/support/mesh_generators.h"

/// Meshes with known defects, and ways to make some.
namespace nearfit::test {

inline std::vector<glm::dvec3> verticesOf(const TriangleMesh& mesh) {
  return {mesh.vertices().begin(), mesh.vertices().end()};
}
inline std::vector<Triangle> trianglesOf(const TriangleMesh& mesh) {
  return {mesh.triangles().begin(), mesh.triangles().end()};
}

/// The mesh with other triangles.
inline TriangleMesh withTriangles(const TriangleMesh& mesh, std::vector<Triangle> triangles) {
  return {verticesOf(mesh), std::move(triangles)};
}

inline TriangleMesh withoutTriangle(const TriangleMesh& mesh, std::size_t triangle) {
  std::vector<Triangle> triangles = trianglesOf(mesh);
  triangles.erase(triangles.begin() + static_cast<std::ptrdiff_t>(triangle));
  return withTriangles(mesh, std::move(triangles));
}

inline TriangleMesh withTriangle(const TriangleMesh& mesh, const Triangle& triangle) {
  std::vector<Triangle> triangles = trianglesOf(mesh);
  triangles.push_back(triangle);
  return withTriangles(mesh, std::move(triangles));
}

inline TriangleMesh moved(const TriangleMesh& mesh, const glm::dvec3& by) {
  return transformed(mesh, 1.0, {{1, 0, 0, 0}, by});
}

/// Each triangle with corners of its own.
inline TriangleMesh tornApart(const TriangleMesh& mesh) {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles()) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const std::uint32_t v : t)
      vertices.push_back(mesh.vertices()[v]);
    triangles.push_back({first, first + 1, first + 2});
  }
  return {std::move(vertices), std::move(triangles)};
}

/// A box of size (3, 4, 5) about the origin; the face at its upper end in z has vertices of its own, `gap` above it.
inline TriangleMesh boxWithALooseLid(double gap) {
  const TriangleMesh box = boxMesh({3, 4, 5});
  std::vector<glm::dvec3> vertices = verticesOf(box);
  std::vector<Triangle> triangles = trianglesOf(box);
  std::map<std::uint32_t, std::uint32_t> lid;
  for (Triangle& t : triangles) {
    const bool isLid = box.vertices()[t[0]].z > 0 && box.vertices()[t[1]].z > 0 && box.vertices()[t[2]].z > 0;
    if (!isLid) continue;
    for (std::uint32_t& v : t) {
      const auto [own, isNew] = lid.try_emplace(v, static_cast<std::uint32_t>(vertices.size()));
      if (isNew) vertices.push_back(box.vertices()[v] + glm::dvec3(0, 0, gap));
      v = own->second;
    }
  }
  return {std::move(vertices), std::move(triangles)};
}

/// Two triangles above an edge from (0, 0, 0) to (2, 0, 0), which meet in a vertex at (1, rise, 0), and one below it,
/// which does not have that vertex.
inline TriangleMesh tJoint(double rise) {
  return {{{0, 0, 0}, {2, 0, 0}, {1, rise, 0}, {1, 1, 0}, {1, -1, 0}}, {{0, 2, 3}, {2, 1, 3}, {1, 0, 4}}};
}

/// Numbers of faces at the edges of a mesh, by pairs of corners, counted anew.
inline std::map<std::pair<std::uint32_t, std::uint32_t>, int> facesByEdge(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> faces;
  for (const Triangle& t : mesh.triangles()) {
    for (std::size_t k = 0; k < 3; ++k)
      ++faces[std::minmax(t[k], t[(k + 1) % 3])];
  }
  return faces;
}

}  // namespace nearfit::test
