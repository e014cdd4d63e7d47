#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

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
  /// Of the boxes, but for rounding.
  double distance(const Box& other) const;
  double size() const { return upper.x - lower.x + upper.y - lower.y + upper.z - lower.z; }
};

Box boxAround(const Corners& corners);

/// Boxes over a mesh's triangles, halved along the longest side until one is left.
class BoxTree {
 public:
  struct Node {
    Box box;
    std::uint32_t first = 0, count = 0;  ///< Of the triangles, where there are no children.
    std::uint32_t child = 0;             ///< The first of two beside each other; 0: none.
  };

  explicit BoxTree(const TriangleMesh& mesh);

  const TriangleMesh& mesh() const { return mesh_; }
  const Node& node(std::uint32_t i) const { return nodes_[i]; }
  std::span<const std::uint32_t> triangles(const Node& n) const {
    return std::span(order_).subspan(n.first, n.count);
  }
  bool isEmpty() const { return order_.empty(); }
  Corners corners(std::uint32_t triangle) const { return corners(triangle, mesh_.vertices()); }
  Corners corners(std::uint32_t triangle, std::span<const glm::dvec3> vertices) const {
    const Triangle& t = mesh_.triangles()[triangle];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
  /// By node, around the same triangles with their vertices elsewhere.
  std::vector<Box> boxesAround(std::span<const glm::dvec3> vertices) const;

 private:
  void build(std::uint32_t index, std::uint32_t first, std::uint32_t count);

  TriangleMesh mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace nearfit::test
