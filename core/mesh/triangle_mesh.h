#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/base/shared_array.h"
#include "core/math/aabb.h"

namespace nearfit {

/// Corner vertices, anticlockwise when seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// An undirected edge.
struct MeshEdge {
  std::uint32_t v0, v1;  ///< v0 < v1.
  /// Range in Arrays::edgeFaces; see TriangleMesh::facesOfEdge.
  std::uint32_t firstFace, faceCount;
};

/// How a mesh deviates from a closed, consistently oriented manifold.
struct MeshTopology {
  std::uint32_t openEdges = 0;          ///< Edges with one face.
  std::uint32_t nonManifoldEdges = 0;   ///< Edges with three or more faces.
  std::uint32_t inconsistentEdges = 0;  ///< Edges along which both faces run in the same direction.
  std::uint32_t components = 0;         ///< Sets of faces connected through edges.

  /// True if each edge has exactly two faces.
  bool isClosed() const noexcept { return openEdges == 0 && nonManifoldEdges == 0; }
  bool isOriented() const noexcept { return inconsistentEdges == 0; }
};

/// Immutable triangle mesh with adjacency, in flat arrays. Coordinates are in metres, in the mesh's own
/// frame. Copies share the arrays. Accessors are real-time safe; indices are not checked.
class TriangleMesh {
 public:
  /// The complete data of a mesh, as the constructor from vertices and triangles derives it.
  struct Arrays {
    SharedArray<glm::dvec3> vertices;
    SharedArray<Triangle> triangles;
    SharedArray<MeshEdge> edges;
    SharedArray<std::uint32_t> edgeFaces;  ///< Faces of edge 0, of edge 1, ...
    SharedArray<std::array<std::uint32_t, 3>> triangleEdges;
    SharedArray<std::uint32_t> vertexEdges;      ///< Edges of vertex 0, of vertex 1, ...
    SharedArray<std::uint32_t> vertexFirstEdge;  ///< Offsets into vertexEdges; one more than vertices.
    Aabb bounds;
    MeshTopology topology;
  };

  TriangleMesh() = default;

  /// Takes over the arrays and derives adjacency in O(n log n). Vertices may be unused. Weld and clean first
  /// (mesh_builder.h): throws Error if a coordinate is not finite, an index is out of range, a triangle
  /// repeats a corner, or there are more than kMaxTriangles triangles or vertices.
  TriangleMesh(std::vector<glm::dvec3> vertices, std::vector<Triangle> triangles);

  /// Adopts the arrays of another mesh, without checks.
  explicit TriangleMesh(Arrays arrays) : arrays_(std::move(arrays)) {}

  /// Keeps edge indices (3/2 per triangle) and halfedge indices (3 per triangle) within 32 bits.
  static constexpr std::size_t kMaxTriangles = 1'000'000'000;

  std::span<const glm::dvec3> vertices() const noexcept { return arrays_.vertices; }
  std::span<const Triangle> triangles() const noexcept { return arrays_.triangles; }
  std::span<const MeshEdge> edges() const noexcept { return arrays_.edges; }

  /// Faces at an edge: 1 for an open edge, 2 for an ordinary one.
  std::span<const std::uint32_t> facesOfEdge(std::uint32_t edge) const noexcept {
    const MeshEdge& e = arrays_.edges[edge];
    return arrays_.edgeFaces.view().subspan(e.firstFace, e.faceCount);
  }
  /// Edges of a triangle; edge k joins corners k and (k + 1) % 3.
  const std::array<std::uint32_t, 3>& edgesOfTriangle(std::uint32_t triangle) const noexcept {
    return arrays_.triangleEdges[triangle];
  }
  /// Edges at a vertex, in ascending order; none if no triangle uses it.
  std::span<const std::uint32_t> edgesOfVertex(std::uint32_t vertex) const noexcept {
    const std::uint32_t first = arrays_.vertexFirstEdge[vertex];
    return arrays_.vertexEdges.view().subspan(first, arrays_.vertexFirstEdge[vertex + 1] - first);
  }
  /// True if the edge has two faces that run along it in opposite directions.
  bool isEdgeConsistent(std::uint32_t edge) const noexcept;

  /// Bounding box of the vertices that triangles use [m].
  const Aabb& bounds() const noexcept { return arrays_.bounds; }
  /// Defects and number of components, computed on construction.
  const MeshTopology& topology() const noexcept { return arrays_.topology; }
  const Arrays& arrays() const noexcept { return arrays_; }
  /// True if this is a copy of the other mesh, or that of this: equal meshes with arrays of their own do not count.
  bool sharesArraysOf(const TriangleMesh& other) const noexcept {
    return vertices().data() == other.vertices().data() && triangles().data() == other.triangles().data();
  }
  /// Memory of the arrays [bytes].
  std::size_t byteSize() const noexcept;

 private:
  void buildEdges();
  void buildEdgesOfVertices();
  void countTopology();

  Arrays arrays_;
};

}  // namespace nearfit
