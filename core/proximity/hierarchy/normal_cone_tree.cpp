#include "core/proximity/hierarchy/normal_cone_tree.h"

#include "core/proximity/hierarchy/normal_cone_tree_builder.h"

namespace nearfit {

NormalConeTree::Bound NormalConeTree::Node::bound(std::size_t lane) const noexcept {
  Bound b;
  for (std::size_t k = 0; k < 3; ++k) {
    b.centre[k] = centre[k][lane];
    b.n[k] = n[k][lane];
    b.u[k] = u[k][lane];
    b.half[k] = half[k][lane];
  }
  b.v = {b.n[1] * b.u[2] - b.n[2] * b.u[1], b.n[2] * b.u[0] - b.n[0] * b.u[2],
         b.n[0] * b.u[1] - b.n[1] * b.u[0]};
  b.leastN = leastN[lane];
  b.mostU = mostU[lane];
  b.mostV = mostV[lane];
  return b;
}

float NormalConeTree::Node::sizeSquared(std::size_t lane) const noexcept {
  return half[0][lane] * half[0][lane] + half[1][lane] * half[1][lane] + half[2][lane] * half[2][lane];
}

NormalConeTree::NormalConeTree(const TriangleMesh& mesh, const ProgressCallback& progress,
                               AcceptanceRule rule)
    : arrays_(NormalConeTreeBuilder(mesh, progress, rule).build()) {}

NormalConeTree::NormalConeTree(const FlatMesh& merged, const ProgressCallback& progress)
    : arrays_(NormalConeTreeBuilder(merged, progress).build()) {}

std::size_t NormalConeTree::byteSize() const noexcept {
  return arrays_.nodes.byteSize() + arrays_.positions.byteSize() + arrays_.vertices.byteSize() +
         arrays_.edges.byteSize() + arrays_.faces.byteSize() + arrays_.neighbours.byteSize() +
         arrays_.walls.byteSize();
}

}  // namespace nearfit
