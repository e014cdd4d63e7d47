#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/aabb.h"

namespace nearfit {

/// Finds the overlaps in a set of boxes by a binary hierarchy, which is rebuilt for each set.
///
/// Real-time safe but for the constructor. Building, and finding the pairs of n boxes that each overlap a
/// few, takes O(n log n).
class BoxPairs {
 public:
  /// @param capacity  Max number of boxes in a set.
  explicit BoxPairs(std::size_t capacity);

  void clear() noexcept { count_ = nodeCount_ = 0; }
  /// Adds a non-empty box, within the capacity (unchecked); its index is the number of boxes added before it.
  void add(const Aabb& box) noexcept;
  /// Call once all boxes are added, before any search.
  void build() noexcept;

  /// Calls visit(i, j) once for each pair of boxes that overlap or touch, pairs close in the hierarchy first.
  template <class Visit>
  void forEachPair(Visit&& visit) const noexcept {
    if (nodeCount_ > 0) pairsWithin(0, visit);
  }
  /// Calls visit(i) for each box that overlaps or touches `box`. Returns the number of nodes looked at; each
  /// takes a bounded time besides its visits.
  template <class Visit>
  std::uint64_t forEachAt(const Aabb& box, Visit&& visit) const noexcept {
    return nodeCount_ > 0 ? entriesAt(0, box, visit) : 0;
  }

 private:
  struct Entry {
    Aabb box;
    std::uint32_t index;
  };
  struct Node {
    Aabb box;
    std::uint32_t begin, end;  ///< Range of its entries.
    std::uint32_t right;       ///< Second child; the first follows the node. 0 for a leaf.
  };

  static bool overlap(const Aabb& a, const Aabb& b) noexcept {
    // All six at once: branches here are unpredictable and cost more.
    const int x = static_cast<int>(a.lower.x <= b.upper.x) & static_cast<int>(b.lower.x <= a.upper.x);
    const int y = static_cast<int>(a.lower.y <= b.upper.y) & static_cast<int>(b.lower.y <= a.upper.y);
    const int z = static_cast<int>(a.lower.z <= b.upper.z) & static_cast<int>(b.lower.z <= a.upper.z);
    return (x & y & z) != 0;
  }
  std::uint32_t makeNode(std::uint32_t begin, std::uint32_t end) noexcept;
  std::span<const Entry> entriesOf(const Node& node) const noexcept {
    return {entries_.data() + node.begin, node.end - node.begin};
  }

  // Recursive, no deeper than the tree (twice that for two nodes); see splitBoxes().

  template <class Visit>
  void pairsWithin(std::uint32_t at, Visit& visit) const noexcept {
    const Node& node = nodes_[at];
    if (node.right != 0) {
      pairsWithin(at + 1, visit);
      pairsWithin(node.right, visit);
      pairsBetween(at + 1, node.right, visit);
      return;
    }
    const std::span<const Entry> entries = entriesOf(node);
    for (std::size_t i = 0; i < entries.size(); ++i) {
      for (std::size_t j = i + 1; j < entries.size(); ++j) {
        if (overlap(entries[i].box, entries[j].box)) visit(entries[i].index, entries[j].index);
      }
    }
  }

  template <class Visit>
  void pairsBetween(std::uint32_t a, std::uint32_t b, Visit& visit) const noexcept {
    const Node &na = nodes_[a], &nb = nodes_[b];
    if (!overlap(na.box, nb.box)) return;
    if (na.right == 0 && nb.right == 0) {
      for (const Entry& entry : entriesOf(na)) {
        if (!overlap(entry.box, nb.box)) continue;
        for (const Entry& other : entriesOf(nb)) {
          if (overlap(entry.box, other.box)) visit(entry.index, other.index);
        }
      }
    } else if (nb.right == 0 || (na.right != 0 && na.end - na.begin > nb.end - nb.begin)) {
      pairsBetween(a + 1, b, visit);
      pairsBetween(na.right, b, visit);
    } else {
      pairsBetween(a, b + 1, visit);
      pairsBetween(a, nb.right, visit);
    }
  }

  template <class Visit>
  std::uint64_t entriesAt(std::uint32_t at, const Aabb& box, Visit& visit) const noexcept {
    const Node& node = nodes_[at];
    if (!overlap(node.box, box)) return 1;
    if (node.right != 0) {
      const std::uint64_t left = entriesAt(at + 1, box, visit);
      return 1 + left + entriesAt(node.right, box, visit);
    }
    for (const Entry& entry : entriesOf(node)) {
      if (overlap(entry.box, box)) visit(entry.index);
    }
    return 1;
  }

  std::vector<Entry> entries_;
  std::vector<Node> nodes_;
  std::uint32_t count_ = 0, nodeCount_ = 0;
};

}  // namespace nearfit
