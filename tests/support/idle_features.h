#pragma once

#include <cstdint>
#include <span>

#include "core/mesh/features.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/lmd_query.h"

/// Features that cannot carry a minimum, which hierarchies leave out: for measuring what that saves, and for
/// checking that it changes no answer.
namespace nearfit::test {

/// Adds the vertices and edges that findFeatures() omits because they cannot carry a minimum: reflex and flat
/// edges, and vertices whose polar cone is empty, flat or in the material. They go behind the features of
/// their kind. Their cones are what a hierarchy without that knowledge would use: bounds of the normals of
/// their faces, as in Johnson & Cohen 2001. Omits edges and vertices where the surface has no side.
void addIdleFeatures(const TriangleMesh& mesh, MeshFeatures& features);

/// A hierarchy that also holds the idle features.
class FullHierarchy {
 public:
  explicit FullHierarchy(const TriangleMesh& mesh);

  const NormalConeTree& tree() const noexcept { return tree_; }
  /// Numbers of idle features, which are the last of their kind.
  const FeatureCounts& idle() const noexcept { return idle_; }
  /// True if the leaf's feature carries no minimum.
  bool isIdle(std::uint32_t leaf) const noexcept;

 private:
  FeatureCounts idle_;  ///< Set while `tree_` is built, which therefore comes after it.
  NormalConeTree tree_;
};

/// Finds the same minima as findLmds(), to the last bit: it also tests pairs with idle features, and rejects
/// them afterwards.
LmdResult findLmds(const FullHierarchy& scene, const FullHierarchy& part, const RigidTransform& sceneFromPart,
                   double cutoff, LmdScratch& scratch, std::span<Lmd> out) noexcept;

}  // namespace nearfit::test
