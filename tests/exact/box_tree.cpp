#include "tests/exact/box_tree.h"

#include <algorithm>
#include <numeric>

#include <glm/geometric.hpp>

namespace nearfit::test {

double Box::distance(const Box& other) const {
  const glm::dvec3 gap = glm::max(glm::max(lower - other.upper, other.lower - upper), glm::dvec3(0.0));
  return glm::length(gap);
}

Box boxAround(const Corners& corners) {
  Box box;
  for (const glm::dvec3& p : corners)
    box.add(p);
  return box;
}

BoxTree::BoxTree(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles().size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  nodes_.emplace_back();
  if (!order_.empty()) build(0, 0, static_cast<std::uint32_t>(order_.size()));
}

std::vector<Box> BoxTree::boxesAround(std::span<const glm::dvec3> vertices) const {
  std::vector<Box> boxes(nodes_.size());
  // Children stand behind their parents.
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    const Node& n = nodes_[i];
    if (n.child != 0) {
      boxes[i] = boxes[n.child];
      boxes[i].add(boxes[n.child + 1].lower);
      boxes[i].add(boxes[n.child + 1].upper);
      continue;
    }
    for (const std::uint32_t t : triangles(n)) {
      for (const glm::dvec3& p : corners(t, vertices))
        boxes[i].add(p);
    }
  }
  return boxes;
}

void BoxTree::build(std::uint32_t index, std::uint32_t first, std::uint32_t count) {
  constexpr std::uint32_t kFew = 1;
  Box box;
  for (std::uint32_t i = first; i < first + count; ++i) {
    for (const glm::dvec3& p : corners(order_[i]))
      box.add(p);
  }
  nodes_[index] = {box, first, count, 0};
  if (count <= kFew) return;
  const glm::dvec3 d = box.upper - box.lower;
  const glm::length_t axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
  const auto key = [&](std::uint32_t t) {
    const Corners c = corners(t);
    return c[0][axis] + c[1][axis] + c[2][axis];
  };
  const std::uint32_t half = count / 2;
  std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count,
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[index].child = child;
  nodes_.resize(nodes_.size() + 2);
  build(child, first, half);
  build(child + 1, first + half, count - half);
}

}  // namespace nearfit::test
