#include "core/proximity/surface/unsided_surface.h"

#include <algorithm>
#include <array>

#include <glm/geometric.hpp>

#include "core/math/min_norm_point.h"
#include "core/math/tolerances.h"

namespace nearfit {
namespace {

/// Finds the features of a mesh that can be touched, and their owners.
class Owners {
 public:
  explicit Owners(const NormalConeTree& tree)
      : mesh_(tree.mesh()), isInTree_(mesh_.triangles().size(), false) {
    for (const NormalConeTree::FaceLeaf& leaf : tree.faces())
      isInTree_[leaf.face] = true;
  }

  std::vector<std::uint8_t> find() {
    std::vector<std::uint8_t> owned(mesh_.triangles().size(), 0);
    for (std::uint32_t e = 0; e < mesh_.edges().size(); ++e) {
      const auto faces = mesh_.facesOfEdge(e);
      const auto owner = std::ranges::find_if(faces, [this](std::uint32_t f) { return isInTree_[f]; });
      if (owner == faces.end() || isFlat(e)) continue;
      const auto& edges = mesh_.edgesOfTriangle(*owner);
      owned[*owner] |= bit(3 + (std::ranges::find(edges, e) - edges.begin()));
    }
    for (std::uint32_t v = 0; v < mesh_.vertices().size(); ++v)
      addVertex(v, owned);
    return owned;
  }

 private:
  static std::uint8_t bit(std::ptrdiff_t i) { return static_cast<std::uint8_t>(1U << i); }

  glm::dvec3 direction(std::uint32_t from, std::uint32_t to) const {
    const glm::dvec3 d = mesh_.vertices()[to] - mesh_.vertices()[from];
    const double length = glm::length(d);
    return length > 0.0 ? d / length : glm::dvec3(0.0);
  }

  /// True if the edge has two faces that lie in one plane, on either side of it.
  bool isFlat(std::uint32_t edge) const {
    const auto faces = mesh_.facesOfEdge(edge);
    if (faces.size() != 2) return false;
    const MeshEdge& e = mesh_.edges()[edge];
    std::array<glm::dvec3, 2> normals;
    for (std::size_t i = 0; i < 2; ++i) {
      const Triangle& t = mesh_.triangles()[faces[i]];
      const std::uint32_t third = t[0] + t[1] + t[2] - e.v0 - e.v1;
      normals[i] = glm::cross(direction(e.v0, e.v1), direction(e.v0, third));
      const double length = glm::length(normals[i]);
      if (!(length > 0.0)) return false;
      normals[i] /= length;
    }
    return glm::length(normals[0] + normals[1]) < kFlatTolerance;
  }

  /// Gives a vertex that sticks out to a triangle. A vertex sticks out if the directions of its edges fit in
  /// less than a half-space. Elsewhere, a point nearest to the vertex is as near to one of its faces or
  /// edges.
  void addVertex(std::uint32_t v, std::vector<std::uint8_t>& owned) {
    directions_.clear();
    std::uint32_t owner = static_cast<std::uint32_t>(owned.size());
    for (const std::uint32_t e : mesh_.edgesOfVertex(v)) {
      bool isSurface = false;
      for (const std::uint32_t f : mesh_.facesOfEdge(e)) {
        if (!isInTree_[f]) continue;
        isSurface = true;
        owner = std::min(owner, f);
      }
      const MeshEdge& edge = mesh_.edges()[e];
      if (isSurface) directions_.push_back(direction(v, edge.v0 == v ? edge.v1 : edge.v0));
    }
    if (owner == owned.size() || glm::length(minNormPoint(directions_)) < kFlatTolerance) return;
    const Triangle& t = mesh_.triangles()[owner];
    owned[owner] |= bit(std::ranges::find(t, v) - t.begin());
  }

  const TriangleMesh& mesh_;
  std::vector<bool> isInTree_;
  std::vector<glm::dvec3> directions_;
};

}  // namespace

UnsidedSurface::UnsidedSurface(const NormalConeTree& tree) : tree_(tree), owned_(Owners(tree).find()) {}

}  // namespace nearfit
