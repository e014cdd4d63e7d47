#include "core/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "core/error.h"

namespace nearfit {
namespace {

void validate(const std::vector<glm::dvec3>& vertices, const std::vector<Triangle>& triangles) {
  if (triangles.size() > TriangleMesh::kMaxTriangles || vertices.size() > TriangleMesh::kMaxTriangles) {
    throw Error("mesh",
                "it has more than " + std::to_string(TriangleMesh::kMaxTriangles) + " triangles or vertices",
                "decimate it first");
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
                    "it names vertex " + std::to_string(v) + " of " + std::to_string(vertices.size()),
                    "repair the mesh");
      }
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      throw Error("triangle " + std::to_string(i), "it names a vertex twice", "clean the mesh first");
    }
  }
}

/// One side of one triangle, named by its undirected edge.
struct Side {
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

TriangleMesh::TriangleMesh(std::vector<glm::dvec3> vertices, std::vector<Triangle> triangles)
    : vertices_(std::move(vertices)), triangles_(std::move(triangles)) {
  validate(vertices_, triangles_);
  for (const Triangle& t : triangles_) {
    for (const std::uint32_t v : t)
      bounds_.add(vertices_[v]);
  }
  buildEdges();
  countTopology();
}

void TriangleMesh::buildEdges() {
  std::vector<Side> sides;
  sides.reserve(3 * triangles_.size());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint64_t a = triangles_[t][k], b = triangles_[t][(k + 1) % 3];
      sides.push_back({std::min(a, b) << 32 | std::max(a, b), 3 * t + k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.index < b.index;
  });

  triangleEdges_.resize(triangles_.size());
  edgeFaces_.reserve(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i == 0 || sides[i].edge != sides[i - 1].edge) {
      edges_.push_back({static_cast<std::uint32_t>(sides[i].edge >> 32),
                        static_cast<std::uint32_t>(sides[i].edge), static_cast<std::uint32_t>(i), 0});
    }
    ++edges_.back().faceCount;
    edgeFaces_.push_back(sides[i].index / 3);
    triangleEdges_[sides[i].index / 3][sides[i].index % 3] = static_cast<std::uint32_t>(edges_.size() - 1);
  }
  edges_.shrink_to_fit();

  vertexFirstEdge_.assign(vertices_.size() + 1, 0);
  for (const MeshEdge& e : edges_) {
    ++vertexFirstEdge_[e.v0 + 1];
    ++vertexFirstEdge_[e.v1 + 1];
  }
  std::partial_sum(vertexFirstEdge_.begin(), vertexFirstEdge_.end(), vertexFirstEdge_.begin());
  vertexEdges_.resize(2 * edges_.size());
  std::vector<std::uint32_t> next(vertexFirstEdge_.begin(), vertexFirstEdge_.end() - 1);
  for (std::uint32_t e = 0; e < edges_.size(); ++e) {
    vertexEdges_[next[edges_[e].v0]++] = e;
    vertexEdges_[next[edges_[e].v1]++] = e;
  }
}

bool TriangleMesh::isEdgeConsistent(std::uint32_t edge) const noexcept {
  const MeshEdge& e = edges_[edge];
  if (e.faceCount != 2) return false;
  const auto runsForward = [&](std::uint32_t face) {
    const Triangle& t = triangles_[face];
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (t[k] == e.v0 && t[(k + 1) % 3] == e.v1) return true;
    }
    return false;
  };
  return runsForward(edgeFaces_[e.firstFace]) != runsForward(edgeFaces_[e.firstFace + 1]);
}

void TriangleMesh::countTopology() {
  std::vector<std::uint32_t> parent(triangles_.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (std::uint32_t e = 0; e < edges_.size(); ++e) {
    const std::span<const std::uint32_t> faces = facesOfEdge(e);
    if (faces.size() == 1) ++topology_.openEdges;
    if (faces.size() > 2) ++topology_.nonManifoldEdges;
    if (faces.size() == 2 && !isEdgeConsistent(e)) ++topology_.inconsistentEdges;
    for (const std::uint32_t face : faces)
      parent[findRoot(parent, face)] = findRoot(parent, faces[0]);
  }
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    topology_.components += findRoot(parent, t) == t ? 1 : 0;
}

std::size_t TriangleMesh::byteSize() const noexcept {
  return vertices_.capacity() * sizeof(vertices_[0]) + triangles_.capacity() * sizeof(triangles_[0]) +
         edges_.capacity() * sizeof(edges_[0]) + edgeFaces_.capacity() * sizeof(edgeFaces_[0]) +
         triangleEdges_.capacity() * sizeof(triangleEdges_[0]) +
         vertexEdges_.capacity() * sizeof(vertexEdges_[0]) +
         vertexFirstEdge_.capacity() * sizeof(vertexFirstEdge_[0]);
}

}  // namespace nearfit
