#include "core/mesh/shaded_mesh.h"

#include <cmath>
#include <limits>
#include <numeric>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

glm::dvec3 unitOrZero(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : glm::dvec3(0.0);
}

std::vector<glm::dvec3> unitNormalsOf(const TriangleMesh& mesh) {
  std::vector<glm::dvec3> normals;
  normals.reserve(mesh.triangles().size());
  for (const Triangle& t : mesh.triangles()) {
    const glm::dvec3 &a = mesh.vertices()[t[0]], &b = mesh.vertices()[t[1]], &c = mesh.vertices()[t[2]];
    normals.push_back(unitOrZero(glm::cross(b - a, c - a)));
  }
  return normals;
}

/// Corners of triangles, 3 * triangle + corner, in sets that share a vertex and its normal.
class CornerSets {
 public:
  explicit CornerSets(const TriangleMesh& mesh) : mesh_(mesh), parent_(3 * mesh.triangles().size()) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  /// Joins the corners of two triangles at a vertex of both.
  void joinAt(std::uint32_t vertex, std::uint32_t first, std::uint32_t second) {
    const std::uint32_t a = rootOf(cornerAt(vertex, first)), b = rootOf(cornerAt(vertex, second));
    // Halving paths keeps trees shallow enough without ranks; the lower root stays.
    parent_[a < b ? b : a] = a < b ? a : b;
  }
  std::uint32_t rootOf(std::uint32_t corner) {
    while (parent_[corner] != corner) {
      parent_[corner] = parent_[parent_[corner]];
      corner = parent_[corner];
    }
    return corner;
  }

 private:
  std::uint32_t cornerAt(std::uint32_t vertex, std::uint32_t triangle) const {
    const Triangle& t = mesh_.triangles()[triangle];
    return 3 * triangle + (t[0] == vertex ? 0U : t[1] == vertex ? 1U : 2U);
  }

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> parent_;
};

}  // namespace

ShadedMesh shadedMesh(const TriangleMesh& mesh, double sharpAngle) {
  const std::vector<glm::dvec3> faceNormals = unitNormalsOf(mesh);
  const double least = std::cos(sharpAngle);
  ShadedMesh shaded;
  CornerSets corners(mesh);
  for (std::uint32_t e = 0; e < mesh.edges().size(); ++e) {
    const std::span<const std::uint32_t> faces = mesh.facesOfEdge(e);
    if (faces.size() != 2 || !(glm::dot(faceNormals[faces[0]], faceNormals[faces[1]]) > least)) {
      shaded.sharpEdges.push_back(e);
      continue;
    }
    corners.joinAt(mesh.edges()[e].v0, faces[0], faces[1]);
    corners.joinAt(mesh.edges()[e].v1, faces[0], faces[1]);
  }
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> vertexOf(3 * mesh.triangles().size(), kNone);  // By root.
  std::vector<glm::dvec3> sums;
  shaded.triangles.resize(mesh.triangles().size());
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      std::uint32_t& vertex = vertexOf[corners.rootOf(3 * t + k)];
      if (vertex == kNone) {
        vertex = static_cast<std::uint32_t>(sums.size());
        shaded.vertices.push_back(mesh.triangles()[t][k]);
        sums.emplace_back(0.0);
      }
      sums[vertex] += faceNormals[t];
      shaded.triangles[t][k] = vertex;
    }
  }
  shaded.normals.reserve(sums.size());
  for (const glm::dvec3& sum : sums)
    shaded.normals.emplace_back(unitOrZero(sum));
  return shaded;
}

}  // namespace nearfit
