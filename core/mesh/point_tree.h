#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"

namespace nearfit {

/// Tree of boxes over points, to find those near a segment.
class PointTree {
 public:
  /// @param points    Kept by reference.
  /// @param selected  Indices of the points to include.
  PointTree(std::span<const glm::dvec3> points, std::vector<std::uint32_t> selected);

  /// Appends the indices of all points within `reach` of the segment, and of some farther ones.
  void findNear(const glm::dvec3& from, const glm::dvec3& to, double reach, std::vector<std::uint32_t>& out);

  /// Number of boxes visited so far, for callers that bound their work.
  std::uint64_t visits() const noexcept { return visits_; }

 private:
  struct Node {
    Aabb box;
    std::uint32_t first, count;
    std::uint32_t child;  ///< First of two adjacent children; 0 for a leaf.
  };
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);

  std::span<const glm::dvec3> points_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> stack_;
  std::uint64_t visits_ = 0;
};

}  // namespace nearfit
