#include "tests/exact/box_index.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>

namespace nearfit::test {

double Box::distance(const Box& other) const {
  const glm::dvec3 gap = glm::max(glm::max(lower - other.upper, other.lower - upper), glm::dvec3(0.0));
  return glm::length(gap);
}

BoxIndex::BoxIndex(std::vector<Box> boxes, std::uint32_t few)
    : few_(few), boxes_(std::move(boxes)), order_(boxes_.size()), nodes_(1) {
  std::iota(order_.begin(), order_.end(), 0U);
  build(0, 0, static_cast<std::uint32_t>(order_.size()));
}

void BoxIndex::build(std::size_t index, std::uint32_t first, std::uint32_t count) {
  Box box;
  for (std::uint32_t i = first; i < first + count; ++i) {
    box.add(boxes_[order_[i]].lower);
    box.add(boxes_[order_[i]].upper);
  }
  nodes_[index] = {box, first, count, 0};
  if (count <= few_) return;
  const glm::dvec3 d = box.upper - box.lower;
  const glm::length_t axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
  const auto key = [&](std::uint32_t i) { return boxes_[i].lower[axis] + boxes_[i].upper[axis]; };
  const std::uint32_t half = count / 2;
  std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count,
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  const std::size_t child = nodes_.size();
  nodes_[index].child = static_cast<std::uint32_t>(child);
  nodes_.resize(child + 2);
  build(child, first, half);
  build(child + 1, first + half, count - half);
}

void BoxIndex::findMeeting(const Box& other, std::vector<std::uint32_t>& out) const {
  out.clear();
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const Node& node = nodes_[open.back()];
    open.pop_back();
    if (!node.box.meets(other)) continue;
    if (node.child != 0) {
      open.insert(open.end(), {node.child, node.child + 1});
      continue;
    }
    for (const std::uint32_t i : boxes(node)) {
      if (boxes_[i].meets(other)) out.push_back(i);
    }
  }
  std::sort(out.begin(), out.end());
}

}  // namespace nearfit::test
