#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/math/triangle_corners.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// True if a slab at least `gap` wide certainly lies between two triangles, which then are that far apart. Tries the
/// directions along which two features can be nearest; however roughly a direction is computed, a gap along it is there.
/// Triangles may be without area. Rounding of coordinates, some 1e-15 of their differences, is the caller's.
/// @param gap  [m]; > 0.
bool areSlabApart(const TriangleCorners& a, const TriangleCorners& b, double gap) noexcept;

/// Tree of axis-aligned boxes over the triangles of a mesh, in double precision: what the verifier of certificates
/// looks for near triangles with. Shares nothing with NormalConeTree and its queries, so that a mistake in one is not
/// one in the other.
class TriangleBoxes {
 public:
  /// O(n log n).
  explicit TriangleBoxes(const TriangleMesh& mesh);

  /// Pairs of nodes that wait to be looked at; one for each thread.
  using Waiting = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  /// True if it is proven that each triangle of this mesh is at least `gap` from each of the part's.
  /// @param thisFromPart  Unit quaternion.
  /// @param gap           [m]; > 0, large beside the rounding of coordinates, which is taken into account.
  bool isApart(const TriangleBoxes& part, const RigidTransform& thisFromPart, double gap,
               Waiting& waiting) const;

 private:
  struct Node {
    glm::dvec3 centre{0.0}, half{0.0};
    std::uint32_t first = 0, count = 0;  ///< Range of triangles, for a leaf.
    std::uint32_t child = 0;             ///< The first of two beside each other; 0 for a leaf.
    double size() const noexcept { return half.x + half.y + half.z; }
  };
  /// A triangle while the tree is built.
  struct Item {
    glm::dvec3 middle;
    std::uint32_t triangle;
  };

  void build(std::uint32_t node, std::span<Item> items, std::uint32_t first);

  glm::dvec3 centre_{0.0};  ///< Middle of the mesh's box, which corners and nodes are relative to [m].
  double reach_ = 0.0;      ///< Largest coordinate of the mesh [m].
  std::vector<TriangleCorners> corners_;
  std::vector<Node> nodes_;
};

}  // namespace nearfit
