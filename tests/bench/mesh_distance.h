#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit::bench {

/// Distance of points to the surface of a mesh, by a tree of boxes.
class MeshDistance {
 public:
  /// @param mesh  Kept by reference; has a triangle.
  explicit MeshDistance(const TriangleMesh& mesh);

  /// `atMost` where nothing is nearer than that [m]; the smaller it is, the sooner it is found.
  double of(const glm::dvec3& point, double atMost) const;

  /// Distance from a point near the one before.
  /// @param triangle  The nearest to the point before, or any; becomes the nearest to this one.
  double ofNext(const glm::dvec3& point, std::uint32_t& triangle) const;

 private:
  struct Node {
    Aabb box;
    std::uint32_t first, count;  ///< Triangles.
    std::uint32_t child;         ///< The first of two beside each other; 0: none.
  };
  struct Best {
    double squared;
    std::uint32_t triangle;
  };
  void build(std::uint32_t node, std::span<const glm::dvec3> centres);
  void search(std::uint32_t node, const glm::dvec3& point, Best& best) const;
  double squaredTo(std::uint32_t triangle, const glm::dvec3& point) const;

  const TriangleMesh& mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace nearfit::bench
