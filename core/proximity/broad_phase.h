#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/aabb.h"
#include "core/math/rigid_transform.h"

namespace nearfit {

/// Box of a box that is turned and moved, padded for rounding.
Aabb boundsOf(const Aabb& box, const RigidTransform& worldFromBox) noexcept;

/// A tree of the boxes of bodies that stand still, to find those near a point without looking at the others.
/// Immutable.
class BroadPhase {
 public:
  BroadPhase() = default;
  /// O(n log n). Empty boxes are never found, those that are not finite always.
  explicit BroadPhase(std::span<const Aabb> boxes);

  /// Calls visit(index) for each box within `radius` of `centre`, and maybe some that are a little farther.
  /// Real-time safe.
  template <class Visit>
  void visitNear(const glm::dvec3& centre, double radius, Visit&& visit) const noexcept {
    isEachNear(centre, radius, [&](std::uint32_t i) {
      visit(i);
      return true;
    });
  }

  /// Whether holds(index) is true of each of these; the first of which it is not is the last to be asked.
  /// Real-time safe.
  template <class Holds>
  bool isEachNear(const glm::dvec3& centre, double radius, Holds&& holds) const noexcept {
    for (const std::uint32_t i : boundless_) {
      if (!holds(i)) return false;
    }
    if (nodes_.empty()) return true;
    // Halves are a median apart: the tree is no deeper than the index has bits, and two wait at each level.
    std::array<std::uint32_t, 66> stack;
    std::size_t size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (isFarther(node.box, centre, radius)) continue;
      if (node.count == 0) {
        stack[size++] = node.first;
        stack[size++] = node.first + 1;
        continue;
      }
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        if (!isFarther(boxes_[order_[i]], centre, radius) && !holds(order_[i])) return false;
      }
    }
    return true;
  }

 private:
  struct Node {
    Aabb box;
    std::uint32_t first, count;  ///< Of `order_` in a leaf; otherwise the first of two children, and 0.
  };

  static bool isFarther(const Aabb& box, const glm::dvec3& centre, double radius) noexcept;
  void split(std::uint32_t node, std::uint32_t first, std::uint32_t count);

  std::vector<Aabb> boxes_;
  std::vector<std::uint32_t> boundless_;  ///< Boxes that are not finite.
  std::vector<std::uint32_t> order_;      ///< The others, as the leaves have them.
  std::vector<Node> nodes_;
};

}  // namespace nearfit
