#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"

namespace nearfit {

/// Corner vertices, anticlockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// An undirected edge and where its incident faces stand in `TriangleMesh::facesOfEdge`.
struct MeshEdge {
  std::uint32_t v0, v1;  ///< v0 < v1.
  std::uint32_t firstFace, faceCount;
};

/// How a mesh departs from a closed, consistently oriented manifold.
struct MeshTopology {
  std::uint32_t openEdges = 0;          ///< Edges with one face.
  std::uint32_t nonManifoldEdges = 0;   ///< Edges with three faces or more.
  std::uint32_t inconsistentEdges = 0;  ///< Edges whose two faces run along it in the same direction.
  std::uint32_t components = 0;         ///< Sets of faces connected through edges.

  bool isClosed() const noexcept { return openEdges == 0 && nonManifoldEdges == 0; }
  bool isOriented() const noexcept { return inconsistentEdges == 0; }
};

/// Immutable triangle mesh in flat arrays, with adjacency. Coordinates in metres, in the mesh's own frame.
class TriangleMesh {
 public:
  TriangleMesh() = default;

  /// Takes the arrays over and derives adjacency in O(n log n). Triangles must have three different corners
  /// (weld and clean first: see mesh_builder.h); vertices may be unused.
  /// Throws Error when a coordinate is not finite, an index is out of range, a triangle repeats a corner, or
  /// there are more than `kMaxTriangles`.
  TriangleMesh(std::vector<glm::dvec3> vertices, std::vector<Triangle> triangles);

  /// Indices of edges (3/2 of the triangles) and halfedges (3 each) stay within 32 bits.
  static constexpr std::size_t kMaxTriangles = 1'000'000'000;

  std::span<const glm::dvec3> vertices() const noexcept { return vertices_; }
  std::span<const Triangle> triangles() const noexcept { return triangles_; }
  std::span<const MeshEdge> edges() const noexcept { return edges_; }

  /// Faces around an edge; 1 for an open edge, 2 for an ordinary one.
  std::span<const std::uint32_t> facesOfEdge(std::uint32_t edge) const noexcept {
    return std::span(edgeFaces_).subspan(edges_[edge].firstFace, edges_[edge].faceCount);
  }
  /// Edge k of a triangle joins its corners k and k+1.
  const std::array<std::uint32_t, 3>& edgesOfTriangle(std::uint32_t triangle) const noexcept {
    return triangleEdges_[triangle];
  }
  std::span<const std::uint32_t> edgesOfVertex(std::uint32_t vertex) const noexcept {
    return std::span(vertexEdges_)
        .subspan(vertexFirstEdge_[vertex], vertexFirstEdge_[vertex + 1] - vertexFirstEdge_[vertex]);
  }
  /// Whether the two faces of an edge run along it in opposite directions, as on an oriented manifold.
  bool isEdgeConsistent(std::uint32_t edge) const noexcept;

  const Aabb& bounds() const noexcept { return bounds_; }
  const MeshTopology& topology() const noexcept { return topology_; }
  /// Memory held by the arrays [bytes].
  std::size_t byteSize() const noexcept;

 private:
  void buildEdges();
  void countTopology();

  std::vector<glm::dvec3> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<MeshEdge> edges_;
  std::vector<std::uint32_t> edgeFaces_;
  std::vector<std::array<std::uint32_t, 3>> triangleEdges_;
  std::vector<std::uint32_t> vertexEdges_, vertexFirstEdge_{0};
  Aabb bounds_;
  MeshTopology topology_;
};

}  // namespace nearfit
