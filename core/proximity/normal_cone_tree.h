#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"
#include "core/proximity/lmd.h"

namespace nearfit {

/// How many of a mesh's features can carry a minimum at all (the others are not in the hierarchy).
struct FeatureCounts {
  std::size_t vertices = 0, edges = 0, faces = 0;
  std::size_t total() const noexcept { return vertices + edges + faces; }
};

/// Spatialized normal cone hierarchy over the features of one mesh that can carry a minimum, each in one
/// leaf. Built once for a mesh; immutable, so that any number of threads and parts share it.
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
    /// Half the diagonal of a child's box.
    float size(std::size_t lane) const noexcept;
  };
  static_assert(sizeof(Node) == 512);

  /// What a leaf child refers to.
  struct VertexLeaf {
    std::uint32_t vertex, firstNeighbour, neighbourCount;
  };
  struct EdgeLeaf {
    std::uint32_t edge, v0, v1;
    std::array<std::uint32_t, 2> opposite;  ///< Corners of the faces that bound the polar arc.
  };
  struct FaceLeaf {
    std::uint32_t face;
    Triangle corners;
  };

  explicit NormalConeTree(const TriangleMesh& mesh);

  /// Children are node indices, or leaves: kind in two bits and index into vertices(), edges() or faces().
  static constexpr std::uint32_t kLeafBit = 0x80000000U;
  static constexpr std::uint32_t kNoChild = 0xFFFFFFFFU;
  static bool isLeaf(std::uint32_t child) noexcept { return (child & kLeafBit) != 0; }
  static FeatureKind leafKind(std::uint32_t child) noexcept {
    return static_cast<FeatureKind>(child >> 29 & 3U);
  }
  static std::uint32_t leafIndex(std::uint32_t child) noexcept { return child & 0x1FFFFFFFU; }

  bool isEmpty() const noexcept { return nodes_.empty(); }
  /// The first node has one child: everything.
  std::span<const Node> nodes() const noexcept { return nodes_; }
  std::span<const glm::dvec3> positions() const noexcept { return positions_; }
  std::span<const VertexLeaf> vertices() const noexcept { return vertices_; }
  std::span<const EdgeLeaf> edges() const noexcept { return edges_; }
  std::span<const FaceLeaf> faces() const noexcept { return faces_; }
  std::span<const std::uint32_t> neighbours(const VertexLeaf& v) const noexcept {
    return std::span(neighbours_).subspan(v.firstNeighbour, v.neighbourCount);
  }

  /// Middle of the mesh's bounding box in its frame [m]; positions and nodes are relative to it.
  const glm::dvec3& centre() const noexcept { return centre_; }
  /// Diagonal of the bounding box [m].
  double size() const noexcept { return size_; }

  FeatureCounts keptFeatures() const noexcept { return {vertices_.size(), edges_.size(), faces_.size()}; }
  FeatureCounts allFeatures() const noexcept { return all_; }
  std::size_t byteSize() const noexcept;

 private:
  friend class NormalConeTreeBuilder;

  glm::dvec3 centre_{0.0};
  double size_ = 0.0;
  std::vector<Node> nodes_;
  std::vector<glm::dvec3> positions_;
  std::vector<VertexLeaf> vertices_;
  std::vector<EdgeLeaf> edges_;
  std::vector<FaceLeaf> faces_;
  std::vector<std::uint32_t> neighbours_;
  FeatureCounts all_;
};

}  // namespace nearfit
