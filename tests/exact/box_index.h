#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace nearfit::test {

using Corners = std::array<glm::dvec3, 3>;

struct Box {
  glm::dvec3 lower{INFINITY}, upper{-INFINITY};

  void add(const glm::dvec3& p) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  bool meets(const Box& other) const {
    for (glm::length_t i = 0; i < 3; ++i) {
      if (lower[i] > other.upper[i] || other.lower[i] > upper[i]) return false;
    }
    return true;
  }
  /// Box of the boxes, but for rounding.
  double distance(const Box& other) const;
  double size() const { return upper.x - lower.x + upper.y - lower.y + upper.z - lower.z; }
};

/// Boxes in a tree, halved along the longest side until few are left.
class BoxIndex {
 public:
  struct Node {
    Box box;
    std::uint32_t first = 0, count = 0;  ///< Of the boxes within.
    std::uint32_t child = 0;             ///< The first of two beside each other; 0: none.
  };

  /// @param few  Max boxes of a node without children; >= 1.
  explicit BoxIndex(std::vector<Box> boxes, std::uint32_t few = 8);

  std::size_t size() const { return nodes_.size(); }  ///< Number of nodes; the root is 0.
  const Node& node(std::size_t i) const { return nodes_[i]; }
  /// Indices of the boxes within a node.
  std::span<const std::uint32_t> boxes(const Node& n) const {
    return std::span(order_).subspan(n.first, n.count);
  }

  /// Fills `out` with the indices of the boxes that meet another, ascending.
  void findMeeting(const Box& other, std::vector<std::uint32_t>& out) const;

 private:
  void build(std::size_t index, std::uint32_t first, std::uint32_t count);

  std::uint32_t few_;
  std::vector<Box> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace nearfit::test
