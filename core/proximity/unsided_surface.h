#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// A mesh whose surface is taken to have no side, with what can be touched of it from any: of its edges those
/// that are not flat, of its vertices those that stick out. Each belongs to one triangle. Built once, in
/// about O(n); copies share the mesh and the hierarchy. Immutable.
class UnsidedSurface {
 public:
  UnsidedSurface(const TriangleMesh& mesh, const NormalConeTree& tree);

  const TriangleMesh& mesh() const noexcept { return mesh_; }
  const NormalConeTree& tree() const noexcept { return tree_; }
  bool hasVertex(std::uint32_t triangle, std::size_t corner) const noexcept {
    return (owned_[triangle] >> corner & 1U) != 0;
  }
  bool hasAnyVertex(std::uint32_t triangle) const noexcept { return (owned_[triangle] & 7U) != 0; }
  bool hasAnyEdge(std::uint32_t triangle) const noexcept { return owned_[triangle] >> 3U != 0; }
  /// The side from a corner to the next.
  bool hasEdge(std::uint32_t triangle, std::size_t corner) const noexcept {
    return (owned_[triangle] >> (3 + corner) & 1U) != 0;
  }

 private:
  TriangleMesh mesh_;
  NormalConeTree tree_;
  std::vector<std::uint8_t> owned_;  ///< By triangle: bits of its corners, then of its sides.
};

}  // namespace nearfit
