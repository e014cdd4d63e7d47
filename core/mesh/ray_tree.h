#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"
#include "core/math/triangle_corners.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Where a segment first meets a mesh.
struct RayHit {
  double fraction = 0.0;  ///< Along the segment, 0 to 1.
  std::uint32_t triangle = 0;
  glm::dvec3 point{0.0};  ///< In the mesh's frame [m].
};

/// Finds the first triangle of a mesh on a segment, by a binary hierarchy of boxes. It takes as much memory for
/// long and thin triangles as for others, unlike a grid of cells, and the same at any scale. Thread-safe.
class RayTree {
 public:
  /// Bound on byteSize() for each of two triangles or more.
  static constexpr std::size_t kMaxBytesPerTriangle = 48;

  RayTree() = default;
  /// Shares the mesh's arrays. O(n log n): half a second for a million triangles.
  explicit RayTree(TriangleMesh mesh);

  /// The first triangle, seen from either side, that the segment meets or passes within a billionth of the
  /// mesh's largest coordinate: rounding lets no ray slip between neighbours. Triangles without area are not
  /// met. Nullopt if there is none, or a coordinate is not finite. O(n) at worst.
  std::optional<RayHit> firstHit(const glm::dvec3& from, const glm::dvec3& to) const noexcept;

  /// Memory without the mesh's arrays [bytes].
  std::size_t byteSize() const noexcept;

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
  struct Ray {
    glm::dvec3 from, along;  ///< From the segment's start to its end.
  };

  std::uint32_t makeNode(std::span<Entry> entries);
  double entryOf(const Aabb& box, const Ray& ray) const noexcept;
  void search(std::uint32_t at, const Ray& ray, RayHit& hit) const noexcept;
  void meet(std::uint32_t triangle, const Ray& ray, RayHit& hit) const noexcept;
  bool isWithin(const glm::dvec3& point, const TriangleCorners& corners,
                const glm::dvec3& normal) const noexcept;

  TriangleMesh mesh_;
  double slack_ = 0.0;  ///< [m]
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;  ///< Triangles, leaf by leaf.
};

}  // namespace nearfit
