#include "core/proximity/cache/tree_cache_checks.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/common.hpp>

#include "core/parallel/parallel_for.h"

namespace nearfit {
namespace {

using Tree = NormalConeTree;

/// Larger than any coordinate of an imported mesh (see mesh_builder.cpp) [m].
constexpr double kFarthest = 1e10;

/// Elements per task of a thread.
constexpr std::size_t kChunk = std::size_t{1} << 16;

/// True if isFine(chunk) holds for all chunks of the array.
template <typename T, typename IsFine>
bool areAllFine(std::span<const T> values, IsFine isFine) {
  std::atomic<bool> fine{true};
  parallelFor((values.size() + kChunk - 1) / kChunk, [&](std::size_t i) {
    if (!isFine(values.subspan(i * kChunk, std::min(kChunk, values.size() - i * kChunk)))) fine = false;
  });
  return fine;
}

/// As areAllFine, for single elements; tests all without an early exit, so that the loop vectorises.
template <typename T, typename IsFine>
bool isEachFine(std::span<const T> values, IsFine isFine) {
  return areAllFine(values, [&](std::span<const T> part) {
    bool fine = true;
    for (const T& value : part)
      fine &= isFine(value);
    return fine;
  });
}

bool areBelow(std::span<const std::uint32_t> indices, std::size_t limit) {
  return isEachFine(indices, [limit](std::uint32_t i) { return i < limit; });
}

bool areNear(std::span<const glm::dvec3> points) {
  return isEachFine(points, [](const glm::dvec3& p) {
    return (std::abs(p.x) <= kFarthest) & (std::abs(p.y) <= kFarthest) & (std::abs(p.z) <= kFarthest);
  });
}

bool areBelow(const Triangle& corners, std::size_t limit) {
  return (corners[0] < limit) & (corners[1] < limit) & (corners[2] < limit);
}

/// True if ranges that begin at `first` follow each other without gaps through an array of `total` elements.
bool isPartition(std::span<const std::uint32_t> first, std::size_t total) {
  return !first.empty() && first.front() == 0 && first.back() == total && std::ranges::is_sorted(first);
}

bool areEdgesSound(const TriangleMesh::Arrays& m) {
  const std::size_t vertices = m.vertices.size(), faces = m.edgeFaces.size();
  std::uint64_t next = 0, last = 0;
  bool fine = true;
  for (const MeshEdge& e : m.edges.view()) {
    // Edges are in rising order, so none is there twice; the first vertex is always the lower one.
    const std::uint64_t name = std::uint64_t{e.v0} << 32 | e.v1;
    fine &= (e.v0 < e.v1) & (e.v1 < vertices) & (e.firstFace == next) & (e.faceCount > 0) & (name > last);
    next += e.faceCount;
    last = name;
  }
  return fine && next == faces;
}

/// True if isFine(index) holds for all indices below `count`.
template <typename IsFine>
bool isFineAtEach(std::size_t count, IsFine isFine) {
  std::atomic<bool> fine{true};
  parallelFor((count + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    bool isChunkFine = true;
    for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i)
      isChunkFine &= isFine(i);
    if (!isChunkFine) fine = false;
  });
  return fine;
}

/// True if triangles, edges and vertices name each other. Indices are known to be in range, and the number of
/// names to be right: if each is right and none is repeated, none is missing.
bool isAdjacencySound(const TriangleMesh::Arrays& m) {
  const auto rises = [](std::span<const std::uint32_t> names) {
    return std::ranges::adjacent_find(names, std::greater_equal<>()) == names.end();
  };
  const bool areSidesSound = isFineAtEach(m.triangles.size(), [&](std::size_t t) {
    bool fine = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(m.triangles[t][k], m.triangles[t][(k + 1) % 3]);
      const MeshEdge& e = m.edges[m.triangleEdges[t][k]];
      fine &= (e.v0 == low) & (e.v1 == high);
    }
    return fine;
  });
  return areSidesSound &&
         isFineAtEach(
             m.edges.size(),
             [&](std::size_t e) {
               const auto faces = m.edgeFaces.view().subspan(m.edges[e].firstFace, m.edges[e].faceCount);
               return rises(faces) && std::ranges::all_of(faces, [&](std::uint32_t face) {
                        return std::ranges::find(m.triangleEdges[face], e) != m.triangleEdges[face].end();
                      });
             }) &&
         isFineAtEach(m.vertices.size(), [&](std::size_t v) {
           const auto edges = m.vertexEdges.view().subspan(m.vertexFirstEdge[v],
                                                           m.vertexFirstEdge[v + 1] - m.vertexFirstEdge[v]);
           return rises(edges) && std::ranges::all_of(edges, [&](std::uint32_t e) {
                    return m.edges[e].v0 == v || m.edges[e].v1 == v;
                  });
         });
}

/// True if used lanes hold numbers of the size of a mesh, and unused ones are out of reach as built.
bool areBoundsSound(const Tree::Node& node) {
  bool fine = true;
  for (std::size_t lane = 0; lane < Tree::kWidth; ++lane) {
    const bool isUsed = node.child[lane] != Tree::kNoChild;
    const float reach = isUsed ? static_cast<float>(kFarthest) : 0.0F;
    for (std::size_t k = 0; k < 3; ++k) {
      const float offset = isUsed ? node.centre[k][lane] : node.centre[k][lane] - Tree::kOutOfReach;
      fine &= (std::abs(offset) <= reach) & (std::abs(node.half[k][lane]) <= reach) &
              (std::abs(node.n[k][lane]) <= 2.0F) & (std::abs(node.u[k][lane]) <= 2.0F);
    }
    fine &= (std::abs(node.leastN[lane]) <= 2.0F) & (std::abs(node.mostU[lane]) <= 2.0F) &
            (std::abs(node.mostV[lane]) <= 2.0F);
  }
  return fine;
}

/// Follows children from the root: each node but the root, and each leaf, must have exactly one parent.
class ShapeCheck {
 public:
  explicit ShapeCheck(const Tree::Arrays& tree)
      : tree_(tree),
        depth_(tree.nodes.size(), 0),
        counts_{tree.vertices.size(), tree.edges.size(), tree.faces.size()},
        isSeen_{std::vector<bool>(counts_[0]), std::vector<bool>(counts_[1]), std::vector<bool>(counts_[2])} {
  }

  bool run() {
    const std::size_t leaves = counts_[0] + counts_[1] + counts_[2];
    if (tree_.nodes.empty()) return leaves == 0;
    if (tree_.nodes[0].child[0] == Tree::kNoChild) return false;
    for (std::size_t lane = 1; lane < Tree::kWidth; ++lane) {
      if (tree_.nodes[0].child[lane] != Tree::kNoChild) return false;
    }
    depth_[0] = 1;
    for (std::uint32_t i = 0; i < tree_.nodes.size(); ++i) {
      // Children come after their parents, so a node without a depth by now has no parent.
      if (depth_[i] == 0 || depth_[i] > Tree::kMaxDepth) return false;
      for (const std::uint32_t child : tree_.nodes[i].child) {
        if (child != Tree::kNoChild && !take(child, i)) return false;
      }
    }
    return seen_ == leaves && areLowestKindsRight();
  }

 private:
  bool take(std::uint32_t child, std::uint32_t parent) {
    if (!Tree::isLeaf(child)) {
      const std::uint32_t node = Tree::nodeIndex(child);
      if (node <= parent || node >= depth_.size() || depth_[node] != 0) return false;
      depth_[node] = static_cast<std::uint8_t>(depth_[parent] + 1);
      return true;
    }
    const auto kind = static_cast<std::size_t>(Tree::leafKind(child));
    const std::uint32_t index = Tree::leafIndex(child);
    if (kind >= 3 || index >= counts_[kind] || isSeen_[kind][index]) return false;
    isSeen_[kind][index] = true;
    ++seen_;
    return true;
  }

  /// Searches for contacts rely on them.
  bool areLowestKindsRight() const {
    std::vector<FeatureKind> lowest(tree_.nodes.size(), FeatureKind::Face);
    for (std::size_t i = lowest.size(); i-- > 0;) {
      for (const std::uint32_t child : tree_.nodes[i].child) {
        if (child == Tree::kNoChild) continue;
        const FeatureKind kind = Tree::lowestKind(child);
        if (!Tree::isLeaf(child) && kind != lowest[Tree::nodeIndex(child)]) return false;
        lowest[i] = std::min(lowest[i], kind);
      }
    }
    return true;
  }

  const Tree::Arrays& tree_;
  std::vector<std::uint8_t> depth_;  ///< 0: no parent found yet.
  std::array<std::size_t, 3> counts_;
  std::array<std::vector<bool>, 3> isSeen_;
  std::size_t seen_ = 0;
};

bool areLeavesSound(const Tree::Arrays& t) {
  const std::size_t positions = t.positions.size(), neighbours = t.neighbours.size();
  return isEachFine(t.vertices.view(),
                    [=](const Tree::VertexLeaf& leaf) {
                      return (leaf.vertex < positions) &
                             (std::uint64_t{leaf.firstNeighbour} + leaf.neighbourCount <= neighbours);
                    }) &&
         isEachFine(t.edges.view(),
                    [=, edges = t.mesh.edges().size()](const Tree::EdgeLeaf& leaf) {
                      return (leaf.edge < edges) & (leaf.v0 < positions) & (leaf.v1 < positions) &
                             (leaf.opposite[0] < positions) & (leaf.opposite[1] < positions);
                    }) &&
         isEachFine(t.faces.view(), [=, faces = t.mesh.triangles().size()](const Tree::FaceLeaf& leaf) {
           return (leaf.face < faces) & areBelow(leaf.corners, positions);
         });
}

}  // namespace

bool isSound(const TriangleMesh::Arrays& m) {
  const std::size_t triangles = m.triangles.size(), edges = m.edges.size(), vertices = m.vertices.size();
  if (triangles > TriangleMesh::kMaxTriangles || vertices > TriangleMesh::kMaxTriangles) return false;
  if (m.edgeFaces.size() != 3 * triangles || m.triangleEdges.size() != triangles ||
      m.vertexEdges.size() != 2 * edges || m.vertexFirstEdge.size() != vertices + 1) {
    return false;
  }
  const bool areTrianglesSound = isEachFine(m.triangles.view(), [vertices](const Triangle& t) {
    return areBelow(t, vertices) & (t[0] != t[1]) & (t[1] != t[2]) & (t[2] != t[0]);
  });
  const std::array<glm::dvec3, 2> bounds{m.bounds.lower, m.bounds.upper};
  return areTrianglesSound && areNear(m.vertices) && areNear(bounds) && areEdgesSound(m) &&
         areBelow(m.edgeFaces, triangles) &&
         isEachFine(m.triangleEdges.view(), [edges](const auto& e) { return areBelow(e, edges); }) &&
         areBelow(m.vertexEdges, edges) && isPartition(m.vertexFirstEdge, m.vertexEdges.size()) &&
         isAdjacencySound(m);
}

bool isSound(const NormalConeTree::Arrays& t) {
  const bool isCentreNear = areNear({&t.centre, 1}) && t.size >= 0.0 && t.size <= kFarthest;
  return isCentreNear && t.positions.size() == t.mesh.vertices().size() && areNear(t.positions) &&
         areBelow(t.neighbours, t.positions.size()) && areLeavesSound(t) &&
         isEachFine(t.nodes.view(), areBoundsSound) && ShapeCheck(t).run();
}

}  // namespace nearfit
