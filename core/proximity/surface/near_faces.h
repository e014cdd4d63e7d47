#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/math/triangle_corners.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/query_workspace.h"
#include "core/proximity/query/tree_traversal.h"

namespace nearfit {

/// Faces of two bodies in the scene's centred frame, regardless of their sides. Real-time safe.
class PlacedFaces {
 public:
  PlacedFaces(const NormalConeTree& scene, const NormalConeTree& part,
              const RigidTransform& sceneFromPart) noexcept
      : scene_(scene),
        part_(part),
        pose_(centredPose(scene, part, sceneFromPart)),
        turn_(glm::mat3_cast(pose_.rotation)) {}

  /// Pose of the part between the trees' centred frames.
  const RigidTransform& pose() const noexcept { return pose_; }
  TriangleCorners sceneCorners(const NormalConeTree::FaceLeaf& f) const noexcept {
    const auto x = scene_.positions();
    return {x[f.corners[0]], x[f.corners[1]], x[f.corners[2]]};
  }
  TriangleCorners partCorners(const NormalConeTree::FaceLeaf& f) const noexcept {
    const auto x = part_.positions();
    return {turn_ * x[f.corners[0]] + pose_.translation, turn_ * x[f.corners[1]] + pose_.translation,
            turn_ * x[f.corners[2]] + pose_.translation};
  }
  /// Max error of a distance through rounding [m].
  double rounding() const noexcept;

 private:
  const NormalConeTree &scene_, &part_;
  RigidTransform pose_;
  glm::dmat3 turn_;
};

/// Traversal of the pairs of faces of two bodies within reach of each other. Real-time safe.
class NearFaces {
 public:
  /// @param scene, part  Not empty.
  /// @param within       Max distance [m]; finite, > 0.
  NearFaces(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
            double within, LmdScratch::Data& workspace) noexcept
      : scene_(scene),
        part_(part),
        placed_(scene, part, sceneFromPart),
        workspace_(workspace),
        limits_(cullLimits(scene, part, placed_.pose(), within)),
        traversal_(scene, part, placed_.pose(), limits_, workspace.openNear, workspace.traversal) {}

  /// Calls visit(scene index, part index), indices in faces(), for each pair. False if `maxWork` stopped it.
  template <class Visit>
  bool run(Visit&& visit, std::uint64_t maxWork) noexcept {
    return traversal_.run(
        [&](const EntryPair& pair) {
          if (!isFace(pair.scene) || !isFace(pair.part)) return;
          visit(NormalConeTree::leafIndex(pair.scene), NormalConeTree::leafIndex(pair.part));
        },
        maxWork);
  }

  /// Lowers the max distance [m] from the next batch of pairs on.
  void tighten(double within) noexcept {
    // Culls round, and an equally near pair must not be lost.
    constexpr double kSlack = 1.0 + 1e-6;
    traversal_.tighten(static_cast<float>(kSlack * within));
  }

  const PlacedFaces& placed() const noexcept { return placed_; }
  /// After run() returned false: lower bound on the distance of all pairs of faces not visited [m].
  double leastNotVisited() const noexcept;
  /// Counts the work on a visited pair as this many pairs of nodes. run() exceeds its bound by the work on
  /// one batch of pairs at most.
  void spend(std::uint64_t work) noexcept { traversal_.spend(work); }
  /// Call within a visit: run() ends as at its bound.
  void stop() noexcept { traversal_.stop(); }
  /// Pairs of nodes opened, plus the work counted by spend().
  std::uint64_t work() const noexcept { return traversal_.nodePairs(); }

 private:
  static bool isFace(std::uint32_t leaf) noexcept {
    return NormalConeTree::leafKind(leaf) == FeatureKind::Face;
  }

  const NormalConeTree &scene_, &part_;
  PlacedFaces placed_;
  LmdScratch::Data& workspace_;
  CullLimits limits_;
  TreeTraversal traversal_;
};

}  // namespace nearfit
