#include "tests/exact/box_tree.h"

#include <cstddef>

namespace nearfit::test {

namespace {

std::vector<Box> boxesOfTriangles(const TriangleMesh& mesh) {
  std::vector<Box> boxes;
  for (const Triangle& t : mesh.triangles())
    boxes.push_back(boxAround({mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]}));
  return boxes;
}

}  // namespace

Box boxAround(const Corners& corners) {
  Box box;
  for (const glm::dvec3& p : corners)
    box.add(p);
  return box;
}

BoxTree::BoxTree(const TriangleMesh& mesh) : mesh_(mesh), index_(boxesOfTriangles(mesh), 1) {}

std::vector<Box> BoxTree::boxesAround(std::span<const glm::dvec3> vertices) const {
  std::vector<Box> boxes(index_.size());
  // Children stand behind their parents.
  for (std::size_t i = boxes.size(); i-- > 0;) {
    const Node& n = node(static_cast<std::uint32_t>(i));
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

}  // namespace nearfit::test
