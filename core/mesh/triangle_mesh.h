#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"
#include "core/shared_array.h"

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
/// Copies share the arrays.
class TriangleMesh {
 public:
  /// All that a mesh is, as the constructor from vertices and triangles derives it.
  struct Arrays {
    SharedArray<glm::dvec3> vertices;
    SharedArray<Triangle> triangles;
    SharedArray<MeshEdge> edges;
    SharedArray<std::uint32_t> edgeFaces;  ///< Of each edge in turn.
    SharedArray<std::array<std::uint32_t, 3>> triangleEdges;
    SharedArray<std::uint32_t> vertexEdges;      ///< Of each vertex in turn.
    SharedArray<std::uint32_t> vertexFirstEdge;  ///< In vertexEdges; one more than there are vertices.
    Aabb bounds;
    MeshTopology topology;
  };

  TriangleMesh() = default;

  /// Takes the arrays over and derives adjacency in O(n log n). Triangles must have three different corners
  /// (weld and clean first: see mesh_builder.h); vertices may be unused.
  /// Throws Error when a coordinate is not finite, an index is out of range, a triangle repeats a corner, or
  /// there are more than `kMaxTriangles`.
  TriangleMesh(std::vector<glm::dvec3> vertices, std::vector<Triangle> triangles);

  /// Takes arrays that another mesh was made of; nothing is checked.
  explicit TriangleMesh(Arrays arrays) : arrays_(std::move(arrays)) {}

  /// Indices of edges (3/2 of the triangles) and halfedges (3 each) stay within 32 bits.
  static constexpr std::size_t kMaxTriangles = 1'000'000'000;

  std::span<const glm::dvec3> vertices() const noexcept { return arrays_.vertices; }
  std::span<const Triangle> triangles() const noexcept { return arrays_.triangles; }
  std::span<const MeshEdge> edges() const noexcept { return arrays_.edges; }

  /// Faces around an edge; 1 for an open edge, 2 for an ordinary one.
  std::span<const std::uint32_t> facesOfEdge(std::uint32_t edge) const noexcept {
    const MeshEdge& e = arrays_.edges[edge];
    return arrays_.edgeFaces.view().subspan(e.firstFace, e.faceCount);
  }
  /// Edge k of a triangle joins its corners k and k+1.
  const std::array<std::uint32_t, 3>& edgesOfTriangle(std::uint32_t triangle) const noexcept {
    return arrays_.triangleEdges[triangle];
  }
  std::span<const std::uint32_t> edgesOfVertex(std::uint32_t vertex) const noexcept {
    const std::uint32_t first = arrays_.vertexFirstEdge[vertex];
    return arrays_.vertexEdges.view().subspan(first, arrays_.vertexFirstEdge[vertex + 1] - first);
  }
  /// Whether the two faces of an edge run along it in opposite directions, as on an oriented manifold.
  bool isEdgeConsistent(std::uint32_t edge) const noexcept;

  const Aabb& bounds() const noexcept { return arrays_.bounds; }
  const MeshTopology& topology() const noexcept { return arrays_.topology; }
  const Arrays& arrays() const noexcept { return arrays_; }
  /// Memory held by the arrays, or mapped [bytes].
  std::size_t byteSize() const noexcept;

 private:
  void buildEdges();
  void buildEdgesOfVertices();
  void countTopology();

  Arrays arrays_;
};

}  // namespace nearfit
