#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"
#include "core/progress.h"
#include "core/proximity/acceptance_rule.h"
#include "core/proximity/lmd.h"
#include "core/shared_array.h"

namespace nearfit {

/// How many of a mesh's features can carry a minimum at all (the others are not in the hierarchy).
struct FeatureCounts {
  std::size_t vertices = 0, edges = 0, faces = 0;
  std::size_t total() const noexcept { return vertices + edges + faces; }
};

/// Spatialized normal cone hierarchy over the features of one mesh that can carry a minimum, each in one
/// leaf. Built once for a mesh, or mapped from a file (tree_cache.h); immutable, so that any number of
/// threads and parts share it. Copies share the arrays.
///
/// Each child has an oriented box around its features, and limits in the same axes on the directions in which
/// they can carry a minimum. Long thin features of CAD meshes have long thin boxes, and an edge has no
/// direction along itself: a sphere and a cone would know neither. Coordinates are relative to `centre()`, so
/// that a mesh far from its origin loses no precision. Nodes have eight children in single precision,
/// structure of arrays; every bound is padded outward beyond its rounding. Source: Johnson & Cohen 2001;
/// directions are bounded by the polar cones of features, not by triangle normals.
class NormalConeTree {
 public:
  static constexpr std::size_t kWidth = 8;
  /// Nodes from the first to any leaf: as nodes are full, 2^29 features need no more. Traversals rely on it.
  static constexpr std::size_t kMaxDepth = 12;
  /// Centre of the lanes that have no child: out of reach of any mesh, and its square still finite.
  static constexpr float kOutOfReach = 1e18F;

  /// An oriented box and the directions of the minima that it can hold, in single precision.
  struct Bound {
    std::array<float, 3> centre;
    std::array<float, 3> n, u, v;  ///< Axes, unit and square: n along the mean direction, u along the box.
    std::array<float, 3> half;     ///< Half extents along n, u, v.
    float leastN;                  ///< A minimum's direction d (unit, outward) has d.n >= leastN,
    float mostU, mostV;            ///< |d.u| <= mostU and |d.v| <= mostV.
  };

  /// Bounds of up to eight children, lane by lane, and what the children are. The v axis is n x u.
  struct alignas(64) Node {
    std::array<std::array<float, kWidth>, 3> centre, n, u, half;
    std::array<float, kWidth> leastN, mostU, mostV;
    std::array<std::uint32_t, kWidth> child;  ///< See isLeaf(). Unused lanes lie out of everything's reach.

    Bound bound(std::size_t lane) const noexcept;
    /// Square of half the diagonal of a child's box [m^2].
    float sizeSquared(std::size_t lane) const noexcept;
  };
  static_assert(sizeof(Node) == 512);

  /// What a leaf child refers to.
  struct VertexLeaf {
    std::uint32_t vertex, firstNeighbour, neighbourCount;  ///< By the rule of normal spans: in pairs.
  };
  struct EdgeLeaf {
    std::uint32_t edge, v0, v1;
    std::array<std::uint32_t, 2> opposite;  ///< Corners of the faces that bound the polar arc.
  };
  struct FaceLeaf {
    std::uint32_t face;
    Triangle corners;
  };

  /// All that a hierarchy is.
  struct Arrays {
    glm::dvec3 centre{0.0};
    double size = 0.0;
    FeatureCounts all;
    SharedArray<Node> nodes;
    SharedArray<glm::dvec3> positions;
    SharedArray<VertexLeaf> vertices;
    SharedArray<EdgeLeaf> edges;
    SharedArray<FaceLeaf> faces;
    SharedArray<std::uint32_t> neighbours;
    AcceptanceRule rule = AcceptanceRule::Exact;
    SharedArray<glm::dvec3> walls{};  ///< By the rule of normal spans alone: see NormalSpanFeatures.
    /// Last of the vertices and edges that are there though they carry no minimum; see withIdleFeatures().
    FeatureCounts idle{};
  };

  /// Builds on all processors (see parallelFor). Throws Cancelled, and Error when the mesh is too large.
  /// @param rule  That queries with this hierarchy then follow, for what this body has to say of a pair.
  explicit NormalConeTree(const TriangleMesh& mesh, const ProgressCallback& progress = {},
                          AcceptanceRule rule = AcceptanceRule::Exact);
  /// With the features, too, that cannot carry a minimum: they are held against the others like the rest and
  /// then refused, so that queries have the same answers. To measure what leaving them out saves.
  static NormalConeTree withIdleFeatures(const TriangleMesh& mesh);
  /// Takes arrays that another hierarchy was made of; nothing is checked.
  explicit NormalConeTree(Arrays arrays) : arrays_(std::move(arrays)) {}

  /// Children are node indices, or leaves: kind in two bits and index into vertices(), edges() or faces().
  static constexpr std::uint32_t kLeafBit = 0x80000000U;
  static constexpr std::uint32_t kNoChild = 0xFFFFFFFFU;
  static bool isLeaf(std::uint32_t child) noexcept { return (child & kLeafBit) != 0; }
  static FeatureKind leafKind(std::uint32_t child) noexcept {
    return static_cast<FeatureKind>(child >> 29 & 3U);
  }
  static std::uint32_t leafIndex(std::uint32_t child) noexcept { return child & 0x1FFFFFFFU; }

  bool isEmpty() const noexcept { return arrays_.nodes.empty(); }
  /// The first node has one child: everything.
  std::span<const Node> nodes() const noexcept { return arrays_.nodes; }
  std::span<const glm::dvec3> positions() const noexcept { return arrays_.positions; }
  std::span<const VertexLeaf> vertices() const noexcept { return arrays_.vertices; }
  std::span<const EdgeLeaf> edges() const noexcept { return arrays_.edges; }
  std::span<const FaceLeaf> faces() const noexcept { return arrays_.faces; }
  std::span<const std::uint32_t> neighbours(const VertexLeaf& v) const noexcept {
    return arrays_.neighbours.view().subspan(v.firstNeighbour, v.neighbourCount);
  }
  AcceptanceRule rule() const noexcept { return arrays_.rule; }
  std::span<const glm::dvec3> walls(const VertexLeaf& v) const noexcept {
    return arrays_.walls.view().subspan(v.firstNeighbour / 2, v.neighbourCount / 2);
  }

  /// Middle of the mesh's bounding box in its frame [m]; positions and nodes are relative to it.
  const glm::dvec3& centre() const noexcept { return arrays_.centre; }
  /// Diagonal of the bounding box [m].
  double size() const noexcept { return arrays_.size; }

  bool isIdle(FeatureKind kind, std::uint32_t index) const noexcept {
    return (kind == FeatureKind::Vertex && index >= arrays_.vertices.size() - arrays_.idle.vertices) ||
           (kind == FeatureKind::Edge && index >= arrays_.edges.size() - arrays_.idle.edges);
  }

  FeatureCounts keptFeatures() const noexcept {
    return {arrays_.vertices.size(), arrays_.edges.size(), arrays_.faces.size()};
  }
  FeatureCounts allFeatures() const noexcept { return arrays_.all; }
  const Arrays& arrays() const noexcept { return arrays_; }
  /// Memory held by the arrays, or mapped [bytes].
  std::size_t byteSize() const noexcept;

 private:
  Arrays arrays_;
};

}  // namespace nearfit
