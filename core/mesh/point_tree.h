#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"

namespace nearfit {

/// Points in boxes that are halved, to find those near a segment.
class PointTree {
 public:
  /// @param points    Kept by reference.
  /// @param selected  Indices of those that count.
  PointTree(std::span<const glm::dvec3> points, std::vector<std::uint32_t> selected);

  /// Appends those of the points that may lie within `reach` of the segment, and more.
  void findNear(const glm::dvec3& from, const glm::dvec3& to, double reach, std::vector<std::uint32_t>& out);

  /// Boxes looked into so far: what a caller may bound its work by.
  std::uint64_t visits() const noexcept { return visits_; }

 private:
  struct Node {
    Aabb box;
    std::uint32_t first, count;
    std::uint32_t child;  ///< The first of two beside each other; 0: none.
  };
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);

  std::span<const glm::dvec3> points_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> stack_;
  std::uint64_t visits_ = 0;
};

}  // namespace nearfit
