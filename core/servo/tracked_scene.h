#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/haptics/haptic_settings.h"
#include "core/proximity/query/broad_phase.h"
#include "core/proximity/surface/triangle_list.h"
#include "core/proximity/tracking/candidate_list.h"
#include "core/servo/servo_scene.h"

namespace nearfit {

/// Contacts count up to this many margins away: a step of the proxy can close such a gap.
constexpr double kContactReach = 2.6;

class PreparedPairs;

/// Distances to search.
struct SearchReach {
  double cutoff = 0.0;   ///< For minima [m].
  double contact = 0.0;  ///< For contacts [m]; 0 if none are needed.

  /// The larger of both [m].
  double widest() const noexcept { return cutoff < contact ? contact : cutoff; }
  bool operator==(const SearchReach&) const = default;
};

/// The reach that the settings need; contacts in the proxy mode only.
SearchReach searchReach(const HapticSettings& settings) noexcept;

/// Bodies that the part overlaps at a pose, and its distance to the others.
struct Clearance {
  std::uint64_t serial = 0;      ///< Changes each time this is determined; 0 if nothing is known.
  RigidTransform worldFromPart;  ///< The pose.
  double distance = 0.0;  ///< Lower bound on the distance to all bodies that are not overlapped [m]; >= 0.
  /// Bodies that the part overlaps or lies inside of, ascending. Null if nothing is known.
  std::shared_ptr<const std::vector<std::uint32_t>> overlapping;

  bool overlaps(std::uint32_t body) const noexcept {
    return overlapping && std::binary_search(overlapping->begin(), overlapping->end(), body);
  }
};

/// A scene with what is known around a pose of the moving part: which bodies are near, and for each the pairs
/// of features that can carry a minimum. Exact wherever it covers the pose; elsewhere a tick searches anew.
/// Made by SceneTracker, read by ServoTick.
struct TrackedScene {
  /// A body that may be near.
  struct Near {
    std::uint32_t body = 0;  ///< Index in scene->bodies.
    /// For minima, and for contacts; null if there were too many pairs to list, or none are needed.
    std::shared_ptr<const CandidateList> list{}, contacts{};
    /// For contacts with an unsided surface instead; null if none are needed, or too many pairs are near.
    std::shared_ptr<const TriangleList> triangles{};
    /// The pairs of `contacts`, if they are thousands, and those before: a look may still go on with them.
    std::shared_ptr<PreparedPairs> prepared{}, formerPrepared{};
  };

  /// Unique ID among all SceneTrackers. Equal serials permit reuse of a tick's results if all else is equal
  /// too; 0, for scenes changed by hand, disables reuse.
  std::uint64_t serial = 0;
  std::shared_ptr<const ServoScene> scene;
  std::shared_ptr<const BroadPhase> bounds;  ///< Boxes of the bodies, in the world frame.

  /// At this pose of the moving part, and at any other within the budget `clear` of it, bodies that are not
  /// in `near` carry no minimum within `cutoff`.
  RigidTransform worldFromPart;
  MotionBudget clear;
  double cutoff = 0.0;     ///< [m]; 0 if nothing is known.
  SearchReach reach;       ///< What the lists were made for.
  std::vector<Near> near;  ///< Ascending by body.
  Clearance clearance;     ///< With springs, a while behind the motion.

  /// Share of `clear` that a pose has spent; above 1, bodies that are not in `near` may be near. Infinity if
  /// `forCutoff` is beyond `cutoff`. Real-time safe.
  double spent(const RigidTransform& pose, double forCutoff) const noexcept;

  /// Share of its room for motion that a pose has spent of what `clearance` says: below 1, the part overlaps no solid
  /// there that it does not name. Infinity if nothing is known. Real-time safe.
  double clearanceSpent(const RigidTransform& pose) const noexcept;

  /// Calls visit(body index, Near or null) for every body that may carry a minimum within `forCutoff`.
  /// Real-time safe.
  template <class Visit>
  void visitNear(const RigidTransform& pose, double forCutoff, Visit&& visit) const noexcept;

 private:
  const Near* findNear(std::uint32_t body) const noexcept;
};

/// The moving part's bounding sphere at a pose, in the world frame [m].
struct MovingBounds {
  glm::dvec3 centre;
  double radius;
};
/// That sphere, padded for rounding. Real-time safe.
MovingBounds movingBounds(const ServoScene& scene, const RigidTransform& worldFromPart) noexcept;

/// Upper bound on the travel of any point of the moving part [m]. Real-time safe.
double travelBetween(const ServoScene& scene, const RigidTransform& from, const RigidTransform& to) noexcept;

/// A scene about which nothing is known yet: every tick searches anew. Allocates.
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
