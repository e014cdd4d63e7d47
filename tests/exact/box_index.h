#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/exact/box_tree.h"

namespace nearfit::test {

/// Boxes in a tree, halved along the longest side until few are left.
class BoxIndex {
 public:
  explicit BoxIndex(std::vector<Box> boxes);

  /// Fills `out` with the indices of the boxes that meet another, ascending.
  void findMeeting(const Box& other, std::vector<std::uint32_t>& out) const;

 private:
  struct Node {
    Box box;
    std::uint32_t first = 0, count = 0;
    std::uint32_t child = 0;  ///< The first of two beside each other; 0: none.
  };
  void build(std::size_t index, std::uint32_t first, std::uint32_t count);

  std::vector<Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace nearfit::test
