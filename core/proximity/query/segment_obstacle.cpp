#include "core/proximity/query/segment_obstacle.h"

#include <array>
#include <bit>

#include <glm/geometric.hpp>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/segment_passage.h"

namespace nearfit {
namespace {

/// Rounding of a segment to single precision, as a fraction of the lengths involved: some ten roundings.
constexpr double kSinglePadding = 1e-6;

void addFaceTo(SegmentPassage& passage, const NormalConeTree& tree, std::uint32_t face) noexcept {
  const Triangle& t = tree.faces()[face].corners;
  passage.add(tree.positions()[t[0]], tree.positions()[t[1]], tree.positions()[t[2]]);
}

}  // namespace

bool SegmentObstacle::blocks(const glm::dvec3& start, const glm::dvec3& direction,
                             const SegmentStretch& stretch) const noexcept {
  if (!(stretch.from < stretch.to)) return false;
  const SegmentBound bound = boundOf(start, direction, stretch);
  SegmentPassage passage(start, direction, stretch.from, stretch.to, clearance_);
  // At most seven siblings wait per level of the tree.
  std::array<std::uint32_t, 7 * 12 + 1> stack;
  std::size_t size = 0;
  // The root has one child, which holds everything; it is a leaf in a tree of a single feature.
  const std::uint32_t top = tree_.nodes()[0].child[0];
  stack[size++] = NormalConeTree::isLeaf(top) ? 0 : NormalConeTree::nodeIndex(top);
  while (size > 0) {
    const NormalConeTree::Node& node = tree_.nodes()[stack[--size]];
    for (std::uint32_t lanes = kernel_(node, bound); lanes != 0; lanes &= lanes - 1) {
      const std::uint32_t child = node.child[static_cast<std::size_t>(std::countr_zero(lanes))];
      if (!NormalConeTree::isLeaf(child)) {
        stack[size++] = NormalConeTree::nodeIndex(child);
      } else if (NormalConeTree::leafKind(child) == FeatureKind::Face) {
        addFaceTo(passage, tree_, NormalConeTree::leafIndex(child));
        if (passage.isClosed()) return true;
      }
    }
  }
  return false;
}

SegmentBound SegmentObstacle::boundOf(const glm::dvec3& start, const glm::dvec3& direction,
                                      const SegmentStretch& stretch) const noexcept {
  const glm::dvec3 middle = start + 0.5 * (stretch.from + stretch.to) * direction;
  const double halfLength = 0.5 * (stretch.to - stretch.from);
  SegmentBound bound;
  for (glm::length_t i = 0; i < 3; ++i) {
    bound.middle[static_cast<std::size_t>(i)] = static_cast<float>(middle[i]);
    bound.half[static_cast<std::size_t>(i)] = static_cast<float>(halfLength * direction[i]);
  }
  const double reach = tree_.size() + glm::length(middle) + halfLength;
  bound.padding = static_cast<float>(kSinglePadding * reach + clearance_);
  return bound;
}

}  // namespace nearfit
