#include "core/mesh/point_tree.h"

#include <algorithm>
#include <utility>

namespace nearfit {
namespace {

/// True if the segment comes within `reach` of the box, by the slab test; may be true somewhat beyond.
bool meets(const Aabb& box, const glm::dvec3& from, const glm::dvec3& to, double reach) {
  double enters = 0.0, leaves = 1.0;
  for (glm::length_t i = 0; i < 3; ++i) {
    const double low = box.lower[i] - reach - from[i], high = box.upper[i] + reach - from[i];
    const double along = to[i] - from[i];
    if (along == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    const double a = low / along, b = high / along;
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
  }
  return enters <= leaves;
}

}  // namespace

PointTree::PointTree(std::span<const glm::dvec3> points, std::vector<std::uint32_t> selected)
    : points_(points), order_(std::move(selected)) {
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(order_.size()));
}

void PointTree::build(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  constexpr std::uint32_t kFew = 8;
  Aabb box;
  for (std::uint32_t i = first; i < first + count; ++i)
    box.add(points_[order_[i]]);
  nodes_[node] = {box, first, count, 0};
  if (count <= kFew) return;
  const glm::dvec3 d = box.upper - box.lower;
  const glm::length_t axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    return points_[a][axis] != points_[b][axis] ? points_[a][axis] < points_[b][axis] : a < b;
  });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].child = child;
  nodes_.resize(nodes_.size() + 2);
  build(child, first, half);
  build(child + 1, first + half, count - half);
}

void PointTree::findNear(const glm::dvec3& from, const glm::dvec3& to, double reach,
                         std::vector<std::uint32_t>& out) {
  stack_.assign(1, 0);
  while (!stack_.empty()) {
    const Node& node = nodes_[stack_.back()];
    stack_.pop_back();
    ++visits_;
    if (node.count == 0 || !meets(node.box, from, to, reach)) continue;
    if (node.child != 0) {
      stack_.push_back(node.child);
      stack_.push_back(node.child + 1);
    } else {
      out.insert(out.end(), order_.begin() + node.first, order_.begin() + node.first + node.count);
    }
  }
}

}  // namespace nearfit
