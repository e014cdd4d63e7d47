#include "core/proximity/overlap/placed_mesh.h"

#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit {

glm::dvec3 PlacedMesh::toTree(const glm::dvec3& point) const noexcept {
  const glm::dvec3 inMesh = frameFromMesh_ == nullptr ? point : frameFromMesh_->inverse().applyToPoint(point);
  return inMesh - body_.tree.centre();
}

std::vector<std::uint32_t> PlacedMesh::facesNotIn(const MeshBody& body) {
  std::vector<std::uint32_t> loose;
  const std::size_t count = body.mesh.triangles().size();
  if (body.tree.faces().size() == count) return loose;
  std::vector<bool> isInTree(count, false);
  for (const NormalConeTree::FaceLeaf& leaf : body.tree.faces())
    isInTree[leaf.face] = true;
  for (std::uint32_t f = 0; f < count; ++f) {
    if (!isInTree[f]) loose.push_back(f);
  }
  return loose;
}

}  // namespace nearfit
