#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/haptics/servo_snapshot.h"
#include "core/haptics/tracked_scene.h"
#include "core/proximity/lmd_query.h"

namespace nearfit {

/// The exact minima of the moving part with all bodies around it, for display and springs.
class MinimaFinder {
 public:
  /// Minima kept for each body; beyond it the nearest, and the result says truncated.
  static constexpr std::size_t kMaxPerBody = 4096;
  /// Work of a tick on bodies that are searched anew: some 1.5 ms on a slow core. Beyond it the nearest
  /// minima of a body are kept, and the result says truncated.
  static constexpr std::uint64_t kMaxNodePairs = 1U << 15;

  struct Result {
    std::uint32_t count = 0;
    std::uint32_t lateBodies = 0;  ///< Searched anew, as no list covered the pose.
    bool isTruncated = false;
    bool isPoseBad = false;   ///< A body's pose is none.
    double distance = 0.0;    ///< Of the nearest [m]; infinity when there is none.
    double completeTo = 0.0;  ///< Every minimum nearer than this was found [m].
    std::uint64_t work = 0;   ///< Pairs of nodes and features looked at, and minima merged.
  };

  MinimaFinder();

  /// Calls feel(span of minima in world coordinates) for each body that has any. Minima come from the lists
  /// where they cover the pose, and from a search bounded by kMaxNodePairs where they do not; bodies that
  /// are far away cost nothing.
  /// @param apart  The bodies that do not overlap the part are no nearer than this [m]; 0 when unknown.
  /// Real-time safe.
  template <class Feel>
  Result find(const TrackedScene& tracked, const RigidTransform& worldFromPart, double cutoff, double apart,
              Feel&& feel) noexcept {
    begin();
    if (tracked.scene->moving.geometry == nullptr) return result_;
    tracked.visitNear(worldFromPart, cutoff, [&](std::uint32_t body, const TrackedScene::Near* known) {
      const CandidateList* list = known != nullptr ? known->list.get() : nullptr;
      const bool overlaps = tracked.clearance.overlaps(body);
      feel(findOne({*tracked.scene, body, list, overlaps ? 0.0 : apart}, worldFromPart, cutoff));
    });
    return result_;
  }

  /// The nearest minima of the last find(), for display. Real-time safe.
  void write(ServoSnapshot& snapshot) const noexcept;

 private:
  struct Task {
    const ServoScene& scene;
    std::uint32_t body;
    const CandidateList* list;  ///< May be null.
    double apart;
  };

  void begin() noexcept;
  std::span<const Lmd> findOne(const Task& task, const RigidTransform& worldFromPart, double cutoff) noexcept;
  LmdResult search(const Task& task, const RigidTransform& bodyFromPart, double cutoff) noexcept;
  void keepForDisplay(PartId other, std::size_t count) noexcept;

  LmdScratch scratch_;
  std::vector<Lmd> lmds_;             ///< Of one body.
  std::vector<SnapshotLmd> display_;  ///< Nearest of all bodies so far; the first displayCount_ are in use.
  std::size_t displayCount_ = 0;
  std::uint64_t nodePairsLeft_ = 0;
  bool displayWasCut_ = false;
  Result result_;
};

}  // namespace nearfit
