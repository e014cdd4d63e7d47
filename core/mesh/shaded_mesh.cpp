#include "core/mesh/shaded_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "core/mesh/flat_groups.h"

namespace nearfit {
namespace {

glm::dvec3 unitOrZero(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : glm::dvec3(0.0);
}

/// Unit normals of the faces. Slivers have none of their own: rounding of their corners turns them anywhere, and
/// each edge around one would be sharp. They take that of a face beside them.
class FaceNormals {
 public:
  FaceNormals(const TriangleMesh& mesh, double tolerance) : mesh_(mesh), least_(kReliableHeight * tolerance) {
    normals_.reserve(mesh.triangles().size());
    for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t)
      addOwn(t);
    borrow();
  }

  std::vector<glm::dvec3> take() { return std::move(normals_); }

 private:
  void addOwn(std::uint32_t face) {
    const Triangle& t = mesh_.triangles()[face];
    const glm::dvec3 &a = mesh_.vertices()[t[0]], &b = mesh_.vertices()[t[1]], &c = mesh_.vertices()[t[2]];
    const glm::dvec3 doubleArea = glm::cross(b - a, c - a);
    const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
    normals_.push_back(unitOrZero(doubleArea));
    if (!(glm::length(doubleArea) > least_ * std::sqrt(longest))) thin_.push_back(face);
  }

  /// Hands the normals of reliable faces on from sliver to sliver. Those that touch no reliable face, even through
  /// others, keep their own.
  void borrow() {
    if (thin_.empty()) return;
    std::vector<bool> isOpen(normals_.size(), false);
    for (const std::uint32_t face : thin_)
      isOpen[face] = true;
    std::vector<std::uint32_t> lenders;
    for (const std::uint32_t face : thin_) {
      if (const auto lender = reliableBeside(face, isOpen)) {
        normals_[face] = normals_[*lender];
        lenders.push_back(face);
      }
    }
    for (const std::uint32_t face : lenders)
      isOpen[face] = false;
    for (std::size_t next = 0; next < lenders.size(); ++next) {
      for (const std::uint32_t edge : mesh_.edgesOfTriangle(lenders[next])) {
        const auto other = across(edge, lenders[next]);
        if (!other || !isOpen[*other]) continue;
        isOpen[*other] = false;
        normals_[*other] = normals_[lenders[next]];
        lenders.push_back(*other);
      }
    }
  }

  /// Returns the face beside a sliver that has a normal of its own, across the longest such side: a sliver lies
  /// along its longest side, so that the face there is the one that it continues.
  std::optional<std::uint32_t> reliableBeside(std::uint32_t face, const std::vector<bool>& isOpen) const {
    std::optional<std::uint32_t> found;
    double longest = -1.0;
    for (const std::uint32_t edge : mesh_.edgesOfTriangle(face)) {
      const MeshEdge& e = mesh_.edges()[edge];
      const glm::dvec3 side = mesh_.vertices()[e.v1] - mesh_.vertices()[e.v0];
      const auto other = across(edge, face);
      if (!other || isOpen[*other] || !(glm::dot(side, side) > longest)) continue;
      found = other;
      longest = glm::dot(side, side);
    }
    return found;
  }

  /// Returns the face beyond an ordinary edge.
  std::optional<std::uint32_t> across(std::uint32_t edge, std::uint32_t face) const {
    if (!mesh_.isEdgeConsistent(edge)) return std::nullopt;
    const auto faces = mesh_.facesOfEdge(edge);
    return faces[0] == face ? faces[1] : faces[0];
  }

  const TriangleMesh& mesh_;
  double least_;  ///< Height of the lowest face with a normal of its own [m].
  std::vector<glm::dvec3> normals_;
  std::vector<std::uint32_t> thin_;
};

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

ShadedMesh shadedMesh(const TriangleMesh& mesh, double sharpAngle, double tolerance) {
  const std::vector<glm::dvec3> faceNormals = FaceNormals(mesh, tolerance).take();
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
