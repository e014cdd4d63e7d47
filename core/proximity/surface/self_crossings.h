#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/math/box_pairs.h"
#include "core/math/triangle_corners.h"
#include "core/proximity/overlap/containment.h"

namespace nearfit {

/// Indices of two triangles of a component.
using CrossingPair = std::array<std::uint32_t, 2>;

/// Corners of a triangle in the mesh's frame [m].
TriangleCorners cornersOf(const TriangleMesh& mesh, std::uint32_t triangle);

/// The boxes of a mesh's triangles, each component in a hierarchy of its own: however many components lie in
/// one place, a search of one does not see the others. O(n log n).
class PieceBoxes {
 public:
  PieceBoxes(const TriangleMesh& mesh, const MeshComponents& pieces);

  /// All triangles, component by component, in ascending order within each.
  std::span<const std::uint32_t> triangles() const noexcept { return triangles_; }
  /// Calls visit(triangle) for each triangle of a component whose box overlaps or touches `box`. Returns the
  /// number of nodes looked at.
  template <class Visit>
  std::uint64_t forEachAt(std::uint32_t piece, const Aabb& box, Visit&& visit) const noexcept {
    const std::uint32_t* const own = triangles_.data() + first_[piece];
    return boxes_[piece].forEachAt(box, [&](std::uint32_t i) { visit(own[i]); });
  }

 private:
  std::vector<std::uint32_t> triangles_;
  std::vector<std::size_t> first_;  ///< Place in triangles_ of each component's first; then the total.
  std::vector<BoxPairs> boxes_;     ///< By component.
};

/// Finds where components cross or touch themselves: all pairs of triangles of one component that share more
/// than their common corners, the lower index first, sorted. Decided exactly. Meetings of different
/// components do not count, and take no time.
///
/// No value if too many boxes of a component's triangles overlap (the work exceeds that of a hundred pairs per
/// triangle plus a hundred million), or more than a hundred thousand pairs meet. Runs on all processors;
/// O(n log n) for ordinary meshes.
std::optional<std::vector<CrossingPair>> findSelfCrossings(const TriangleMesh& mesh,
                                                           const MeshComponents& pieces,
                                                           const PieceBoxes& boxes);

}  // namespace nearfit
