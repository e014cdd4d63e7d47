#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/math/triangle_corners.h"
#include "core/proximity/normal_cone_tree.h"
#include "core/proximity/query_workspace.h"
#include "core/proximity/tree_traversal.h"

namespace nearfit {

/// The pairs of faces of two bodies within reach of each other, whatever their sides, and their corners in
/// the scene's centred frame. Real-time safe.
class NearFaces {
 public:
  /// @param within  [m]; finite, > 0.
  NearFaces(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
            double within, LmdScratch::Data& workspace) noexcept
      : scene_(scene),
        part_(part),
        pose_(centredPose(scene, part, sceneFromPart)),
        workspace_(workspace),
        limits_(cullLimits(scene, part, pose_, within)),
        traversal_(scene, part, pose_, limits_, workspace.openNear, workspace.traversal) {}

  /// Calls visit(scene leaf, part leaf): of FaceLeafs. False when it stopped at the bound of work.
  template <class Visit>
  bool run(Visit&& visit, std::uint64_t maxNodePairs) noexcept {
    return traversal_.run(
        [&](const EntryPair& pair) {
          if (!isFace(pair.scene) || !isFace(pair.part)) return;
          visit(scene_.faces()[NormalConeTree::leafIndex(pair.scene)],
                part_.faces()[NormalConeTree::leafIndex(pair.part)]);
        },
        maxNodePairs);
  }

  /// From the next pairs on leaves out what is farther.
  void tighten(double within) noexcept {
    // The culls round: what is as near must not be lost.
    constexpr double kSlack = 1.0 + 1e-6;
    traversal_.tighten(static_cast<float>(kSlack * within));
  }

  /// Between the trees' centred frames.
  const RigidTransform& pose() const noexcept { return pose_; }
  glm::dvec3 scenePosition(std::uint32_t vertex) const noexcept { return scene_.positions()[vertex]; }
  glm::dvec3 partPosition(std::uint32_t vertex) const noexcept {
    return pose_.applyToPoint(part_.positions()[vertex]);
  }
  TriangleCorners sceneCorners(const NormalConeTree::FaceLeaf& f) const noexcept {
    return {scenePosition(f.corners[0]), scenePosition(f.corners[1]), scenePosition(f.corners[2])};
  }
  TriangleCorners partCorners(const NormalConeTree::FaceLeaf& f) const noexcept {
    return {partPosition(f.corners[0]), partPosition(f.corners[1]), partPosition(f.corners[2])};
  }

  /// After run() said false: no pair of faces that was not visited is nearer than this [m].
  double leastNotVisited() const noexcept;
  /// What a distance may be off by through rounding [m].
  double rounding() const noexcept;
  std::uint64_t nodePairs() const noexcept { return traversal_.nodePairs(); }

 private:
  static bool isFace(std::uint32_t leaf) noexcept {
    return NormalConeTree::leafKind(leaf) == FeatureKind::Face;
  }

  const NormalConeTree &scene_, &part_;
  RigidTransform pose_;
  LmdScratch::Data& workspace_;
  CullLimits limits_;
  TreeTraversal traversal_;
};

}  // namespace nearfit
