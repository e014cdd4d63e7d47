#include "core/proximity/query/broad_phase.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace nearfit {
namespace {

constexpr std::uint32_t kLeafSize = 4;

/// Rounding of a transformed corner, as a fraction of the lengths involved: some dozens of roundings.
constexpr double kBoundsPadding = 1e-14;

}  // namespace

Aabb boundsOf(const Aabb& box, const RigidTransform& worldFromBox) noexcept {
  if (box.isEmpty()) return {};
  const glm::dvec3 half = 0.5 * (box.upper - box.lower);
  const glm::dvec3 centre = worldFromBox.applyToPoint(box.centre());
  glm::dvec3 extent(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 side(0.0);
    side[axis] = half[axis];
    extent += glm::abs(worldFromBox.applyToVector(side));
  }
  extent += kBoundsPadding * (glm::length(centre) + glm::length(box.centre()) + glm::length(half));
  return {centre - extent, centre + extent};
}

bool BroadPhase::isFarther(const Aabb& box, const glm::dvec3& centre, double radius) noexcept {
  const glm::dvec3 nearest = glm::max(box.lower, glm::min(centre, box.upper));
  const glm::dvec3 d = centre - nearest;
  return glm::dot(d, d) > radius * radius;
}

BroadPhase::BroadPhase(std::span<const Aabb> boxes) : boxes_(boxes.begin(), boxes.end()) {
  for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
    if (glm::any(glm::isnan(boxes_[i].lower)) || glm::any(glm::isnan(boxes_[i].upper))) {
      boundless_.push_back(i);
    } else if (!boxes_[i].isEmpty()) {
      order_.push_back(i);
    }
  }
  if (order_.empty()) return;
  nodes_.reserve(2 * order_.size());
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(order_.size()));
}

void BroadPhase::split(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  Aabb box, centres;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Aabb& b = boxes_[order_[i]];
    box.add(b.lower);
    box.add(b.upper);
    centres.add(b.centre());
  }
  nodes_[node] = {box, first, count};
  if (count <= kLeafSize) return;
  const glm::dvec3 spread = centres.upper - centres.lower;
  const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    return boxes_[a].centre()[axis] < boxes_[b].centre()[axis];
  });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node] = {box, children, 0};
  split(children, first, half);
  split(children + 1, first + half, count - half);
}

}  // namespace nearfit
