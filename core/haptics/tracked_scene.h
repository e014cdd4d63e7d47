#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/haptics/servo_scene.h"
#include "core/proximity/broad_phase.h"
#include "core/proximity/candidate_list.h"

namespace nearfit {

/// A scene with what is known of it around a pose of the moving part: which bodies are near, and for each the
/// pairs of features that can carry a minimum. Exact wherever it says that it holds; where it does not, a
/// tick searches anew. Made by SceneTracker, read by ServoTick.
struct TrackedScene {
  struct Near {
    std::uint32_t body = 0;  ///< Of scene->bodies.
    /// Null when there were too many pairs to list.
    std::shared_ptr<const CandidateList> list;
  };

  std::shared_ptr<const ServoScene> scene;
  std::shared_ptr<const BroadPhase> bounds;  ///< Of the bodies, in world coordinates.

  /// Bodies that are not in `near` carry no minimum within `cutoff` at this pose of the moving part, nor at
  /// any other within the budget of it.
  RigidTransform worldFromPart;
  MotionBudget clear;
  double cutoff = 0.0;     ///< [m]; 0 when nothing is known.
  std::vector<Near> near;  ///< By rising body.

  /// Share of `clear` that is spent, or infinity when that does not help: above 1 other bodies may be near.
  double spent(const RigidTransform& pose, double forCutoff) const noexcept;

  /// Calls visit(body index, list or null) for every body that may carry a minimum. Real-time safe.
  template <class Visit>
  void visitNear(const RigidTransform& pose, double forCutoff, Visit&& visit) const noexcept;

 private:
  const CandidateList* listOf(std::uint32_t body) const noexcept;
};

/// The moving part's bounding sphere at a pose.
struct MovingBounds {
  glm::dvec3 centre;
  double radius;
};
MovingBounds movingBounds(const ServoScene& scene, const RigidTransform& worldFromPart) noexcept;

/// A scene of which nothing is known yet: every tick searches anew.
TrackedScene untracked(std::shared_ptr<const ServoScene> scene);

template <class Visit>
void TrackedScene::visitNear(const RigidTransform& pose, double forCutoff, Visit&& visit) const noexcept {
  if (spent(pose, forCutoff) <= 1.0) {
    for (const Near& entry : near)
      visit(entry.body, entry.list.get());
    return;
  }
  const MovingBounds moving = movingBounds(*scene, pose);
  bounds->visitNear(moving.centre, moving.radius + forCutoff,
                    [&](std::uint32_t body) { visit(body, listOf(body)); });
}

}  // namespace nearfit
