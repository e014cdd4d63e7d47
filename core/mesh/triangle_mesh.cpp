#include "core/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "core/base/error.h"

namespace nearfit {
namespace {

void validate(const std::vector<glm::dvec3>& vertices, const std::vector<Triangle>& triangles) {
  if (triangles.size() > TriangleMesh::kMaxTriangles || vertices.size() > TriangleMesh::kMaxTriangles) {
    throw Error("mesh",
                "it has more than " + std::to_string(TriangleMesh::kMaxTriangles) + " triangles or vertices",
                "reduce the mesh first");
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const glm::dvec3& p = vertices[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      throw Error("vertex " + std::to_string(i), "a coordinate is not a finite number", "repair the mesh");
    }
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    for (const std::uint32_t v : t) {
      if (v >= vertices.size()) {
        throw Error("triangle " + std::to_string(i),
                    "it refers to vertex " + std::to_string(v) + " of " + std::to_string(vertices.size()),
                    "repair the mesh");
      }
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      throw Error("triangle " + std::to_string(i), "it uses a vertex twice", "clean the mesh first");
    }
  }
}

/// One side of a triangle, with its undirected edge.
struct DirectedSide {
  std::uint64_t edge;   ///< Smaller vertex in the high half, larger in the low half.
  std::uint32_t index;  ///< 3 * triangle + corner.
};

std::uint32_t findRoot(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) {
    parent[i] = parent[parent[i]];
    i = parent[i];
  }
  return i;
}

}  // namespace

TriangleMesh::TriangleMesh(std::vector<glm::dvec3> vertices, std::vector<Triangle> triangles) {
  validate(vertices, triangles);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t)
      arrays_.bounds.add(vertices[v]);
  }
  arrays_.vertices = std::move(vertices);
  arrays_.triangles = std::move(triangles);
  buildEdges();
  buildEdgesOfVertices();
  countTopology();
}

void TriangleMesh::buildEdges() {
  const std::span<const Triangle> triangles = arrays_.triangles;
  std::vector<DirectedSide> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint64_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b) << 32 | std::max(a, b), 3 * t + k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const DirectedSide& a, const DirectedSide& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.index < b.index;
  });

  std::vector<MeshEdge> edges;
  std::vector<std::uint32_t> edgeFaces;
  std::vector<std::array<std::uint32_t, 3>> triangleEdges(triangles.size());
  edgeFaces.reserve(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i == 0 || sides[i].edge != sides[i - 1].edge) {
      edges.push_back({static_cast<std::uint32_t>(sides[i].edge >> 32),
                       static_cast<std::uint32_t>(sides[i].edge), static_cast<std::uint32_t>(i), 0});
    }
    ++edges.back().faceCount;
    edgeFaces.push_back(sides[i].index / 3);
    triangleEdges[sides[i].index / 3][sides[i].index % 3] = static_cast<std::uint32_t>(edges.size() - 1);
  }
  edges.shrink_to_fit();
  arrays_.edges = std::move(edges);
  arrays_.edgeFaces = std::move(edgeFaces);
  arrays_.triangleEdges = std::move(triangleEdges);
}

void TriangleMesh::buildEdgesOfVertices() {
  const std::span<const MeshEdge> edges = arrays_.edges;
  std::vector<std::uint32_t> firstEdge(arrays_.vertices.size() + 1, 0);
  for (const MeshEdge& e : edges) {
    ++firstEdge[e.v0 + 1];
    ++firstEdge[e.v1 + 1];
  }
  std::partial_sum(firstEdge.begin(), firstEdge.end(), firstEdge.begin());
  std::vector<std::uint32_t> vertexEdges(2 * edges.size());
  std::vector<std::uint32_t> next(firstEdge.begin(), firstEdge.end() - 1);
  for (std::uint32_t e = 0; e < edges.size(); ++e) {
    vertexEdges[next[edges[e].v0]++] = e;
    vertexEdges[next[edges[e].v1]++] = e;
  }
  arrays_.vertexEdges = std::move(vertexEdges);
  arrays_.vertexFirstEdge = std::move(firstEdge);
}

bool TriangleMesh::isEdgeConsistent(std::uint32_t edge) const noexcept {
  const MeshEdge& e = arrays_.edges[edge];
  if (e.faceCount != 2) return false;
  const auto runsForward = [&](std::uint32_t face) {
    const Triangle& t = arrays_.triangles[face];
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (t[k] == e.v0 && t[(k + 1) % 3] == e.v1) return true;
    }
    return false;
  };
  return runsForward(arrays_.edgeFaces[e.firstFace]) != runsForward(arrays_.edgeFaces[e.firstFace + 1]);
}

void TriangleMesh::countTopology() {
  std::vector<std::uint32_t> parent(arrays_.triangles.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (std::uint32_t e = 0; e < arrays_.edges.size(); ++e) {
    const std::span<const std::uint32_t> faces = facesOfEdge(e);
    if (faces.size() == 1) ++arrays_.topology.openEdges;
    if (faces.size() > 2) ++arrays_.topology.nonManifoldEdges;
    if (faces.size() == 2 && !isEdgeConsistent(e)) ++arrays_.topology.inconsistentEdges;
    for (const std::uint32_t face : faces)
      parent[findRoot(parent, face)] = findRoot(parent, faces[0]);
  }
  for (std::uint32_t t = 0; t < arrays_.triangles.size(); ++t)
    arrays_.topology.components += findRoot(parent, t) == t ? 1 : 0;
}

std::size_t TriangleMesh::byteSize() const noexcept {
  return arrays_.vertices.byteSize() + arrays_.triangles.byteSize() + arrays_.edges.byteSize() +
         arrays_.edgeFaces.byteSize() + arrays_.triangleEdges.byteSize() + arrays_.vertexEdges.byteSize() +
         arrays_.vertexFirstEdge.byteSize();
}

}  // namespace nearfit
