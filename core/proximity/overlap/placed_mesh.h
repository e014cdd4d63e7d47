#pragma once

#include <cstdint>
#include <vector>

#include "core/exact/triangle_predicates.h"
#include "core/math/aabb.h"
#include "core/math/rigid_transform.h"
#include "core/math/triangle_corners.h"
#include "core/mesh/triangle_mesh.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit {

/// Mesh of a body at a pose in some frame, with its vertices rounded to double precision there.
class PlacedMesh {
 public:
  /// @param tree           Of the mesh; kept by reference.
  /// @param frameFromMesh  Kept by pointer; null for the mesh's own frame, where nothing is rounded.
  PlacedMesh(const NormalConeTree& tree, const RigidTransform* frameFromMesh)
      : tree_(tree), frameFromMesh_(frameFromMesh), loose_(facesNotIn(tree)) {}

  const TriangleMesh& mesh() const noexcept { return tree_.mesh(); }
  const NormalConeTree& tree() const noexcept { return tree_; }
  /// Indices of triangles too thin to have a face in the hierarchy.
  const std::vector<std::uint32_t>& looseTriangles() const noexcept { return loose_; }

  /// Position of a mesh vertex in the pose's frame [m].
  glm::dvec3 vertex(std::uint32_t v) const noexcept {
    const glm::dvec3& p = mesh().vertices()[v];
    return frameFromMesh_ == nullptr ? p : frameFromMesh_->applyToPoint(p);
  }
  /// Corners of a mesh triangle in the pose's frame [m].
  TriangleCorners corners(std::uint32_t triangle) const noexcept {
    const Triangle& t = mesh().triangles()[triangle];
    return {vertex(t[0]), vertex(t[1]), vertex(t[2])};
  }
  /// Returns a box in the pose's frame that holds what `box`, in the mesh's frame, holds; empty if it is.
  Aabb placed(const Aabb& box) const noexcept;
  /// Maps a point from the pose's frame to the hierarchy's centred frame, to rounding.
  glm::dvec3 toTree(const glm::dvec3& point) const noexcept;

 private:
  static std::vector<std::uint32_t> facesNotIn(const NormalConeTree& tree);

  const NormalConeTree& tree_;
  const RigidTransform* frameFromMesh_;  ///< Null: the mesh's own frame, without rounding.
  std::vector<std::uint32_t> loose_;
};

}  // namespace nearfit
