#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"
#include "tests/exact/box_index.h"

namespace nearfit::test {

Box boxAround(const Corners& corners);

/// Boxes over a mesh's triangles, halved until one is left.
class BoxTree {
 public:
  using Node = BoxIndex::Node;

  explicit BoxTree(const TriangleMesh& mesh);

  const TriangleMesh& mesh() const { return mesh_; }
  const Node& node(std::uint32_t i) const { return index_.node(i); }
  std::span<const std::uint32_t> triangles(const Node& n) const { return index_.boxes(n); }
  bool isEmpty() const { return mesh_.triangles().empty(); }
  Corners corners(std::uint32_t triangle) const { return corners(triangle, mesh_.vertices()); }
  Corners corners(std::uint32_t triangle, std::span<const glm::dvec3> vertices) const {
    const Triangle& t = mesh_.triangles()[triangle];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
  /// By node, around the same triangles with their vertices elsewhere.
  std::vector<Box> boxesAround(std::span<const glm::dvec3> vertices) const;

 private:
  TriangleMesh mesh_;
  BoxIndex index_;
};

}  // namespace nearfit::test
