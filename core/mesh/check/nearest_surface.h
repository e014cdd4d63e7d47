#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Finds how far points are from a mesh, whatever its defects, by a binary hierarchy of boxes over its triangles.
/// Thread-safe.
class NearestSurface {
 public:
  /// Shares the mesh's arrays. O(n log n).
  explicit NearestSurface(TriangleMesh mesh);

  /// Distance of a point from the nearest triangle [m]; infinity if there are none. O(log n) near the surface.
  double distance(const glm::dvec3& point) const noexcept;

 private:
  struct Entry {
    Aabb box;
    std::uint32_t triangle;
  };
  struct Node {
    Aabb box;
    std::uint32_t begin = 0, count = 0;  ///< Range in order_ of a leaf; count 0: no leaf.
    std::uint32_t right = 0;             ///< Second child; the first follows the node.
  };
  std::uint32_t makeNode(std::span<Entry> entries);
  void search(std::uint32_t at, const glm::dvec3& point, double& squared) const noexcept;

  TriangleMesh mesh_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;  ///< Triangles, leaf by leaf.
};

}  // namespace nearfit
