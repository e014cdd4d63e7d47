#include "core/proximity/overlap/placed_mesh.h"

#include "core/proximity/query/broad_phase.h"

namespace nearfit {

Aabb PlacedMesh::placed(const Aabb& box) const noexcept {
  return frameFromMesh_ == nullptr ? box : boundsOf(box, *frameFromMesh_);
}

glm::dvec3 PlacedMesh::toTree(const glm::dvec3& point) const noexcept {
  const glm::dvec3 inMesh = frameFromMesh_ == nullptr ? point : frameFromMesh_->inverse().applyToPoint(point);
  return inMesh - tree_.centre();
}

std::vector<std::uint32_t> PlacedMesh::facesNotIn(const NormalConeTree& tree) {
  std::vector<std::uint32_t> loose;
  const std::size_t count = tree.mesh().triangles().size();
  if (tree.faces().size() == count) return loose;
  std::vector<bool> isInTree(count, false);
  for (const NormalConeTree::FaceLeaf& leaf : tree.faces())
    isInTree[leaf.face] = true;
  for (std::uint32_t f = 0; f < count; ++f) {
    if (!isInTree[f]) loose.push_back(f);
  }
  return loose;
}

}  // namespace nearfit
