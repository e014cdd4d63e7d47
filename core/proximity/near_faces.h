#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/math/triangle_corners.h"
#include "core/proximity/normal_cone_tree.h"
#include "core/proximity/query_workspace.h"
#include "core/proximity/tree_traversal.h"

namespace nearfit {

/// The faces of two bodies in the scene's centred frame, whatever their sides. Real-time safe.
class PlacedFaces {
 public:
  PlacedFaces(const NormalConeTree& scene, const NormalConeTree& part,
              const RigidTransform& sceneFromPart) noexcept
      : scene_(scene),
        part_(part),
        pose_(centredPose(scene, part, sceneFromPart)),
        turn_(glm::mat3_cast(pose_.rotation)) {}

  /// Between the trees' centred frames.
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
  /// What a distance may be off by through rounding [m].
  double rounding() const noexcept;

 private:
  const NormalConeTree &scene_, &part_;
  RigidTransform pose_;
  glm::dmat3 turn_;
};

/// The pairs of faces of two bodies within reach of each other. Real-time safe.
class NearFaces {
 public:
  /// @param within  [m]; finite, > 0.
  NearFaces(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
            double within, LmdScratch::Data& workspace) noexcept
      : scene_(scene),
        part_(part),
        placed_(scene, part, sceneFromPart),
        workspace_(workspace),
        limits_(cullLimits(scene, part, placed_.pose(), within)),
        traversal_(scene, part, placed_.pose(), limits_, workspace.openNear, workspace.traversal) {}

  /// Calls visit(scene index, part index): of faces(). False when it stopped at the bound of work.
  template <class Visit>
  bool run(Visit&& visit, std::uint64_t maxWork) noexcept {
    return traversal_.run(
        [&](const EntryPair& pair) {
          if (!isFace(pair.scene) || !isFace(pair.part)) return;
          visit(NormalConeTree::leafIndex(pair.scene), NormalConeTree::leafIndex(pair.part));
        },
        maxWork);
  }

  /// From the next pairs on leaves out what is farther.
  void tighten(double within) noexcept {
    // The culls round: what is as near must not be lost.
    constexpr double kSlack = 1.0 + 1e-6;
    traversal_.tighten(static_cast<float>(kSlack * within));
  }

  const PlacedFaces& placed() const noexcept { return placed_; }
  /// After run() said false: no pair of faces that was not visited is nearer than this [m].
  double leastNotVisited() const noexcept;
  /// Lets what is done with a visited pair count as so many pairs of nodes. run() goes beyond its bound by no
  /// more than one batch of pairs takes.
  void spend(std::uint64_t work) noexcept { traversal_.spend(work); }
  /// From within a visit: run() ends as at its bound.
  void stop() noexcept { traversal_.stop(); }
  /// Pairs of nodes opened, and what was spent besides.
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
