#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/haptics/minima_allowance.h"
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
  /// Where springs decide the force: as much as lists and work space hold.
  static constexpr MinimaAllowance kFelt{1U << 18, mostMergeWork(LmdScratch::kDefaultCapacity)};
  /// Where minima are only shown: 0.4 ms and 1.6 on a slow core, the latter for some 400 pieces at least.
  static constexpr MinimaAllowance kShown{1U << 13, 1U << 15};

  struct Result {
    std::uint32_t count = 0;
    std::uint32_t lateBodies = 0;  ///< Searched anew, as no list covered the pose.
    bool isTruncated = false;
    bool isPoseBad = false;   ///< A body's pose is none.
    double distance = 0.0;    ///< Of the nearest [m]; infinity when there is none.
    double completeTo = 0.0;  ///< Every minimum nearer than this was found [m].
    /// Pairs of nodes and features looked at, and minima merged: of what is felt again, what it took then.
    std::uint64_t work = 0;
  };

  /// Bodies of which the minima stay known for the next tick.
  static constexpr std::size_t kMaxKeptBodies = 256;

  MinimaFinder();

  /// Within an allowance for all bodies together. What goes beyond it is left out, the nearest last, and the
  /// result says truncated.
  ///
  /// Calls feel(span of minima in world coordinates) for each body that has any. Minima come from the lists
  /// where they cover the pose, and from a search bounded by kMaxNodePairs where they do not; bodies that
  /// are far away cost nothing. Where nothing has changed since the last call (the tracked scene
  /// by its serial, the rest to the last bit), nothing is searched: what was found then is felt again.
  /// @param apart         The bodies that do not overlap the part are no nearer than this [m]; 0 when
  /// unknown.
  /// @param allowance     kFelt, or kShown where nothing depends on them.
  /// Real-time safe.
  template <class Feel>
  Result find(const TrackedScene& tracked, const RigidTransform& worldFromPart, double cutoff, double apart,
              const MinimaAllowance& allowance, Feel&& feel) noexcept {
    const Question question = questionOf(tracked, worldFromPart, {cutoff, apart}, allowance);
    if (isAnswerKept_ && tracked.serial != 0 && question == asked_) {
      result_.lateBodies = 0;
      for (const std::span<const Lmd> found : std::span(kept_).first(keptCount_))
        feel(found);
      return result_;
    }
    begin(question, allowance);
    if (tracked.scene->moving.geometry == nullptr) return result_;
    tracked.visitNear(worldFromPart, cutoff, [&](std::uint32_t body, const TrackedScene::Near* known) {
      const CandidateList* list = known != nullptr ? known->list.get() : nullptr;
      const bool overlaps = tracked.clearance.overlaps(body);
      const Task task{*tracked.scene, body, list, overlaps ? 0.0 : apart};
      const std::span<const Lmd> found = findOne(task, worldFromPart, cutoff);
      feel(found);
      keep(found);
    });
    isAnswerKept_ = isAnswerKept_ && !result_.isPoseBad;
    return result_;
  }

  /// The nearest minima of the last find(), for display. Real-time safe.
  void write(ServoSnapshot& snapshot) const noexcept;

 private:
  /// All that an answer depends on, by its bits: zeros of either sign are two.
  using Question = std::array<std::uint64_t, 12>;
  /// @param lengths  Cutoff, and how far apart bodies are.
  static Question questionOf(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                             const std::array<double, 2>& lengths, const MinimaAllowance& allowance) noexcept;

  struct Task {
    const ServoScene& scene;
    std::uint32_t body;
    const CandidateList* list;  ///< May be null.
    double apart;
  };

  void begin(const Question& question, const MinimaAllowance& allowance) noexcept;
  void spend(const LmdResult& result) noexcept;
  /// Room for the minima of one more body.
  std::span<Lmd> roomForOne() noexcept;
  void keep(std::span<const Lmd> found) noexcept;
  std::span<const Lmd> findOne(const Task& task, const RigidTransform& worldFromPart, double cutoff) noexcept;
  LmdResult search(const Task& task, const RigidTransform& bodyFromPart, double cutoff,
                   std::span<Lmd> out) noexcept;
  void keepForDisplay(PartId other, std::span<const Lmd> found) noexcept;

  LmdScratch scratch_;
  std::vector<Lmd> lmds_;                   ///< Of body after body, as long as there is room.
  std::vector<std::span<const Lmd>> kept_;  ///< The minima of each body; the first keptCount_ are in use.
  std::size_t usedLmds_ = 0, keptCount_ = 0;
  Question asked_{};
  bool isAnswerKept_ = false;         ///< What was asked last and found is all there.
  std::vector<SnapshotLmd> display_;  ///< Nearest of all bodies so far; the first displayCount_ are in use.
  std::size_t displayCount_ = 0;
  MinimaAllowance left_;
  std::uint64_t nodePairsLeft_ = 0;
  bool displayWasCut_ = false;
  Result result_;
};

}  // namespace nearfit
