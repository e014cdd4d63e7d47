#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/haptics/haptic_settings.h"
#include "core/haptics/servo_scene.h"
#include "core/proximity/broad_phase.h"
#include "core/proximity/candidate_list.h"

namespace nearfit {

/// Contacts count this many margins away: a step of the proxy can close so much.
constexpr double kContactReach = 2.6;

/// How far is looked.
struct SearchReach {
  double cutoff = 0.0;   ///< For minima [m].
  double contact = 0.0;  ///< For contacts [m]; 0 where none are wanted.

  double widest() const noexcept { return cutoff < contact ? contact : cutoff; }
  bool operator==(const SearchReach&) const = default;
};

/// What the settings ask for.
SearchReach searchReach(const HapticSettings& settings) noexcept;

/// Which bodies the part does not overlap, and how far from a pose that is sure.
struct Clearance {
  std::uint64_t serial = 0;  ///< Another each time that it is found out; 0: nothing is known.
  RigidTransform worldFromPart;
  double distance = 0.0;  ///< No body but the overlapping ones is nearer [m]; >= 0.
  /// Bodies that the part meets or is inside of, by rising index.
  std::shared_ptr<const std::vector<std::uint32_t>> overlapping;

  bool overlaps(std::uint32_t body) const noexcept {
    return overlapping && std::binary_search(overlapping->begin(), overlapping->end(), body);
  }
};

/// A scene with what is known of it around a pose of the moving part: which bodies are near, and for each the
/// pairs of features that can carry a minimum. Exact wherever it says that it holds; where it does not, a
/// tick searches anew. Made by SceneTracker, read by ServoTick.
struct TrackedScene {
  struct Near {
    std::uint32_t body = 0;  ///< Of scene->bodies.
    /// For minima, and for contacts; null when there were too many pairs to list, or none are wanted.
    std::shared_ptr<const CandidateList> list, contacts;
  };

  /// Of all that SceneTrackers have made, this one's alone: where nothing else has changed either, neither
  /// has what a tick found. 0 where it may have been changed by hand since.
  std::uint64_t serial = 0;
  std::shared_ptr<const ServoScene> scene;
  std::shared_ptr<const BroadPhase> bounds;  ///< Of the bodies, in world coordinates.

  /// Bodies that are not in `near` carry no minimum within `cutoff` at this pose of the moving part, nor at
  /// any other within the budget of it.
  RigidTransform worldFromPart;
  MotionBudget clear;
  double cutoff = 0.0;     ///< [m]; 0 when nothing is known.
  SearchReach reach;       ///< What the lists are made for.
  std::vector<Near> near;  ///< By rising body.
  Clearance clearance;     ///< Known where contacts are wanted.

  /// Share of `clear` that is spent, or infinity when that does not help: above 1 other bodies may be near.
  double spent(const RigidTransform& pose, double forCutoff) const noexcept;

  /// Calls visit(body index, Near or null) for every body that may carry a minimum. Real-time safe.
  template <class Visit>
  void visitNear(const RigidTransform& pose, double forCutoff, Visit&& visit) const noexcept;

 private:
  const Near* findNear(std::uint32_t body) const noexcept;
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
      visit(entry.body, &entry);
    return;
  }
  const MovingBounds moving = movingBounds(*scene, pose);
  bounds->visitNear(moving.centre, moving.radius + forCutoff,
                    [&](std::uint32_t body) { visit(body, findNear(body)); });
}

}  // namespace nearfit
