#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit {

/// Mesh whose surface counts as having no side, with the features that can be touched from any side: edges
/// that are not flat, and vertices that stick out. One triangle owns each of them. Built once, in about O(n);
/// copies share the mesh and the hierarchy. Immutable.
class UnsidedSurface {
 public:
  /// Takes the hierarchy's mesh for the surface. Copies the hierarchy, which shares its arrays. O(n).
  explicit UnsidedSurface(const NormalConeTree& tree);

  const TriangleMesh& mesh() const noexcept { return tree_.mesh(); }
  const NormalConeTree& tree() const noexcept { return tree_; }
  /// True if the triangle owns the vertex at one of its corners (0 to 2).
  bool hasVertex(std::uint32_t triangle, std::size_t corner) const noexcept {
    return (owned_[triangle] >> corner & 1U) != 0;
  }
  bool hasAnyVertex(std::uint32_t triangle) const noexcept { return (owned_[triangle] & 7U) != 0; }
  bool hasAnyEdge(std::uint32_t triangle) const noexcept { return owned_[triangle] >> 3U != 0; }
  /// True if the triangle owns the side from one of its corners (0 to 2) to the next.
  bool hasEdge(std::uint32_t triangle, std::size_t corner) const noexcept {
    return (owned_[triangle] >> (3 + corner) & 1U) != 0;
  }

 private:
  NormalConeTree tree_;
  std::vector<std::uint8_t> owned_;  ///< By triangle: bits for its corners, then for its sides.
};

}  // namespace nearfit
