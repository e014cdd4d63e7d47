#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include <glm/vec3.hpp>

#include "core/base/progress.h"
#include "core/base/shared_array.h"
#include "core/mesh/flat_mesh.h"
#include "core/mesh/triangle_mesh.h"
#include "core/proximity/lmd.h"

namespace nearfit {

/// Rule by which a pair of features counts as a local minimum distance. A hierarchy is built for one rule.
enum class AcceptanceRule : std::uint8_t {
  Exact,  ///< The conditions that define a minimum.
  /// Approximate, as in Johnson & Willemsen 2003: the two points are nearest between a pair of triangles, and
  /// the segment between them lies in the span of the surface normals at each end. See normal_span.h.
  NormalSpan,
};

/// Numbers of features by kind.
struct FeatureCounts {
  std::size_t vertices = 0, edges = 0, faces = 0;
  std::size_t total() const noexcept { return vertices + edges + faces; }
};

/// All features of a mesh, whether they can carry a minimum or not.
inline FeatureCounts featuresOf(const TriangleMesh& mesh) noexcept {
  return {mesh.vertices().size(), mesh.edges().size(), mesh.triangles().size()};
}

/// Spatialized normal cone hierarchy over the features of one mesh that can carry a minimum, each in exactly
/// one leaf. Built once per mesh, or read from a file (tree_cache.h); immutable, so any number of threads
/// and parts can share it. Copies share the arrays.
///
/// Each child has an oriented box around its features and, on the same axes, limits on the directions in
/// which they can carry a minimum. These fit what a sphere and a cone cannot: the long thin features of CAD
/// meshes, and edges, which have no direction along themselves. Coordinates are relative to `centre()`, so a
/// mesh far from its origin loses no precision. Nodes have eight children, in single precision, as structures
/// of arrays; every bound is padded outward beyond its rounding. Source: Johnson & Cohen 2001; unlike there,
/// polar cones of features bound the directions, not triangle normals.
class NormalConeTree {
 public:
  static constexpr std::size_t kWidth = 8;  ///< Children per node.
  /// Max number of nodes from the root to a leaf. As nodes are full, 2^29 features need no more. Traversals
  /// rely on it.
  static constexpr std::size_t kMaxDepth = 12;
  /// Centre coordinate of lanes without a child [m]: out of reach of any mesh, with a finite square.
  static constexpr float kOutOfReach = 1e18F;

  /// Oriented box, and limits on the directions of the minima inside it, in single precision.
  struct Bound {
    std::array<float, 3> centre;   ///< [m]
    std::array<float, 3> n, u, v;  ///< Orthonormal axes: n along the mean direction, u along the box.
    std::array<float, 3> half;     ///< Half extents along n, u, v [m].
    /// A minimum's direction d (unit, outward) has d.n >= leastN, |d.u| <= mostU and |d.v| <= mostV.
    float leastN;
    float mostU, mostV;
  };

  /// Bounds of up to eight children, one per lane, and the children. The v axis is n x u.
  struct alignas(64) Node {
    std::array<std::array<float, kWidth>, 3> centre, n, u, half;
    std::array<float, kWidth> leastN, mostU, mostV;
    std::array<std::uint32_t, kWidth> child;  ///< See isLeaf(). Bounds of unused lanes are out of reach.

    Bound bound(std::size_t lane) const noexcept;  ///< Bound of a child.
    /// Squared half diagonal of a child's box [m^2].
    float sizeSquared(std::size_t lane) const noexcept;
  };
  static_assert(sizeof(Node) == 512);

  /// Mesh vertex of a leaf, and its range in the array of neighbours: those that bound its polar cone or, by
  /// AcceptanceRule::NormalSpan, the other two corners of each of its faces.
  struct VertexLeaf {
    std::uint32_t vertex, firstNeighbour, neighbourCount;
  };
  /// Mesh edge of a leaf, from vertex v0 to v1.
  struct EdgeLeaf {
    std::uint32_t edge, v0, v1;
    std::array<std::uint32_t, 2> opposite;  ///< Third corners of the faces that bound the polar arc.
  };
  /// Mesh triangle of a leaf, and its vertices.
  struct FaceLeaf {
    std::uint32_t face;
    Triangle corners;
  };

  /// The complete contents of a hierarchy; see the accessors.
  struct Arrays {
    glm::dvec3 centre{0.0};
    double size = 0.0;
    SharedArray<Node> nodes;
    SharedArray<glm::dvec3> positions;
    SharedArray<VertexLeaf> vertices;
    SharedArray<EdgeLeaf> edges;
    SharedArray<FaceLeaf> faces;
    SharedArray<std::uint32_t> neighbours;
    AcceptanceRule rule = AcceptanceRule::Exact;
    SharedArray<glm::dvec3> walls{};  ///< Only for AcceptanceRule::NormalSpan: see NormalSpanFeatures.
    TriangleMesh mesh{};
    double deviation = 0.0;
  };

  /// Builds on all processors (see parallelFor). Throws Cancelled, and Error for 2^29 edges or more.
  /// @param rule  Rule by which queries judge this body's feature of a pair.
  explicit NormalConeTree(const TriangleMesh& mesh, const ProgressCallback& progress = {},
                          AcceptanceRule rule = AcceptanceRule::Exact);
  /// The same for a mesh with merged flats.
  explicit NormalConeTree(const FlatMesh& merged, const ProgressCallback& progress = {});
  /// Takes over the arrays of another hierarchy; checks nothing.
  explicit NormalConeTree(Arrays arrays) : arrays_(std::move(arrays)) {}

  /// A child is a node or a leaf; a leaf has kLeafBit. Two bits hold the kind of a leaf or, of a node, the lowest kind of
  /// the leaves below it; the rest is an index into nodes(), or into vertices(), edges() or faces().
  static constexpr std::uint32_t kLeafBit = 0x80000000U;
  static constexpr std::uint32_t kNoChild = 0xFFFFFFFFU;
  static constexpr std::uint32_t kKindShift = 29;
  static bool isLeaf(std::uint32_t child) noexcept { return (child & kLeafBit) != 0; }
  /// Kind of a leaf, or lowest kind below a node.
  static FeatureKind lowestKind(std::uint32_t child) noexcept {
    return static_cast<FeatureKind>(child >> kKindShift & 3U);
  }
  static FeatureKind leafKind(std::uint32_t leaf) noexcept { return lowestKind(leaf); }
  static std::uint32_t leafIndex(std::uint32_t leaf) noexcept { return leaf & kIndexBits; }
  static std::uint32_t nodeIndex(std::uint32_t child) noexcept { return child & kIndexBits; }
  /// The child for a node.
  static std::uint32_t nodeChild(std::uint32_t index, FeatureKind lowest) noexcept {
    return static_cast<std::uint32_t>(lowest) << kKindShift | index;
  }

  /// The mesh whose features these are. Leaves refer to its vertices, edges and triangles.
  const TriangleMesh& mesh() const noexcept { return arrays_.mesh; }
  /// No point of mesh() is farther than this from the mesh that it was made from, nor the other way round [m]:
  /// FlatMesh::deviation.
  double deviation() const noexcept { return arrays_.deviation; }

  /// True if no feature of the mesh can carry a minimum.
  bool isEmpty() const noexcept { return arrays_.nodes.empty(); }
  /// Nodes, the root first. The root has one child, which holds everything.
  std::span<const Node> nodes() const noexcept { return arrays_.nodes; }
  /// Positions of all mesh vertices, relative to centre() [m].
  std::span<const glm::dvec3> positions() const noexcept { return arrays_.positions; }
  /// Leaves by kind.
  std::span<const VertexLeaf> vertices() const noexcept { return arrays_.vertices; }
  std::span<const EdgeLeaf> edges() const noexcept { return arrays_.edges; }
  std::span<const FaceLeaf> faces() const noexcept { return arrays_.faces; }
  /// Vertices that VertexLeaf refers to, as indices of positions().
  std::span<const std::uint32_t> neighbours(const VertexLeaf& v) const noexcept {
    return arrays_.neighbours.view().subspan(v.firstNeighbour, v.neighbourCount);
  }
  AcceptanceRule rule() const noexcept { return arrays_.rule; }
  /// Walls of a vertex's span of normals, one per pair of neighbours; only for AcceptanceRule::NormalSpan.
  std::span<const glm::dvec3> walls(const VertexLeaf& v) const noexcept {
    return arrays_.walls.view().subspan(v.firstNeighbour / 2, v.neighbourCount / 2);
  }

  /// Centre of the mesh's bounding box in the mesh's frame [m]; positions and nodes are relative to it.
  const glm::dvec3& centre() const noexcept { return arrays_.centre; }
  /// Diagonal of the mesh's bounding box [m].
  double size() const noexcept { return arrays_.size; }

  /// Counts of the features in the hierarchy.
  FeatureCounts keptFeatures() const noexcept {
    return {arrays_.vertices.size(), arrays_.edges.size(), arrays_.faces.size()};
  }
  /// Counts of all features of the mesh.
  FeatureCounts allFeatures() const noexcept { return featuresOf(mesh()); }
  const Arrays& arrays() const noexcept { return arrays_; }
  /// Memory that the arrays hold, or map, without mesh() [bytes].
  std::size_t byteSize() const noexcept;

 private:
  static constexpr std::uint32_t kIndexBits = (1U << kKindShift) - 1U;

  Arrays arrays_;
};

}  // namespace nearfit
