#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/aabb.h"
#include "core/math/rigid_transform.h"

namespace nearfit {

/// Returns a box that holds the transformed `box`, padded for rounding; empty if `box` is.
Aabb boundsOf(const Aabb& box, const RigidTransform& worldFromBox) noexcept;

/// Tree of the boxes of bodies at rest, to find those near a point without visiting the others. Immutable.
class BroadPhase {
 public:
  BroadPhase() = default;
  /// O(n log n). Searches never find an empty box, and always find one with a NaN coordinate.
  explicit BroadPhase(std::span<const Aabb> boxes);

  /// Calls visit(index) for each box within `radius` of `centre` [m], and maybe for some a little farther
  /// away. Real-time safe.
  template <class Visit>
  void visitNear(const glm::dvec3& centre, double radius, Visit&& visit) const noexcept {
    isEachNear(centre, radius, [&](std::uint32_t i) {
      visit(i);
      return true;
    });
  }

  /// True if holds(index) is true for each box that visitNear would visit; stops at the first for which it is
  /// not. Real-time safe.
  template <class Holds>
  bool isEachNear(const glm::dvec3& centre, double radius, Holds&& holds) const noexcept {
    for (const std::uint32_t i : boundless_) {
      if (!holds(i)) return false;
    }
    if (nodes_.empty()) return true;
    // Splits are at the median: the tree is no deeper than an index has bits, and two nodes wait per level.
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
    std::uint32_t first, count;  ///< Range in `order_` for a leaf; else the first of two children, and 0.
  };

  static bool isFarther(const Aabb& box, const glm::dvec3& centre, double radius) noexcept;
  void split(std::uint32_t node, std::uint32_t first, std::uint32_t count);

  std::vector<Aabb> boxes_;
  std::vector<std::uint32_t> boundless_;  ///< Boxes with a NaN coordinate.
  std::vector<std::uint32_t> order_;      ///< The others, in the order of the leaves.
  std::vector<Node> nodes_;
};

}  // namespace nearfit
