#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/proximity/query/contact_areas.h"
#include "core/proximity/query/lmd_query.h"
#include "core/servo/servo_snapshot.h"
#include "core/servo/tracked_scene.h"

namespace nearfit {

/// Max work for finding minima in a tick. A unit is one pair of nodes or features visited, some 50 ns
/// on a slow core.
struct MinimaAllowance {
  std::uint64_t search = 0;  ///< For pairs of nodes and features; exceeded by kSearchBatch at most.
  std::uint64_t merge = 0;   ///< For merging minima and pieces of regions, and pairs of them.
  std::uint64_t areas = 0;   ///< For merging the minima of an area of contact (mergeAreas()); 0: none are.

  static constexpr std::uint64_t kSearchBatch = 128;
  /// Upper bound on the total work.
  constexpr std::uint64_t most() const noexcept {
    return search + kSearchBatch + merge + (areas > 0 ? areas + kMaxAreaExcess : 0);
  }
};

/// Work of one minimum or piece of a region: it is merged, and tested against what may block it. Pieces are
/// compared in pairs whose boxes overlap; in a flat contact these are far fewer than all pairs.
constexpr std::uint64_t kWorkOfPiece = 32, kPiecePairsOfWork = 4;

/// Work of merging this many pieces, compared in this many pairs.
constexpr std::uint64_t mergeWork(std::uint64_t pieces, std::uint64_t pairs) noexcept {
  return kWorkOfPiece * pieces + pairs / kPiecePairsOfWork;
}

/// Upper bound on the work of merging this many pieces, whichever pairs of them overlap.
constexpr std::uint64_t mostMergeWork(std::uint64_t pieces) noexcept {
  return mergeWork(pieces, pieces * pieces / 2);
}

/// Max number of pieces that can be merged within this work in any case.
constexpr std::size_t mergeablePieces(std::uint64_t work) noexcept {
  std::uint64_t low = 0, high = 1U << 20;
  while (high - low > 1) {
    const std::uint64_t middle = (low + high) / 2;
    (mostMergeWork(middle) <= work ? low : high) = middle;
  }
  return static_cast<std::size_t>(low);
}

/// Finds the exact minima of the moving part with all bodies around it, for display and springs.
class MinimaFinder {
 public:
  /// Max minima kept for each body. If there are more, the nearest are kept, and the result says truncated.
  static constexpr std::size_t kMaxPerBody = 4096;
  /// Max work of a tick on bodies that are searched anew: some 1.5 ms on a slow core. Beyond it the nearest
  /// minima of a body are kept, and the result says truncated.
  static constexpr std::uint64_t kMaxNodePairs = 1U << 15;
  /// For springs, whose force depends on the minima: as much as lists and work space hold.
  static constexpr MinimaAllowance kFelt{1U << 20, mostMergeWork(LmdScratch::kDefaultCapacity)};
  /// The same with one spring for each area of contact. Some hundred minima take a hundredth of it; of thousands the
  /// farthest keep their own springs.
  static constexpr MinimaAllowance kFeltByArea{kFelt.search, kFelt.merge, 1U << 20};
  /// For minima that are only shown: on a slow core some 0.3 ms of search and 0.3 ms of merging, enough for 130
  /// pieces; and where contacts have taken most of the tick's time.
  static constexpr MinimaAllowance kShown{3U << 11, 3U << 11}, kShownInFullTick{1U << 9, 1U << 10};

  struct Result {
    std::uint32_t count = 0;       ///< Minima found, of all bodies.
    std::uint32_t areas = 0;       ///< Areas of contact of these; without merging all that are not blocked.
    std::uint32_t lateBodies = 0;  ///< Bodies searched anew, since no list covered the pose.
    bool isTruncated = false;      ///< Minima may be missing.
    bool isPoseBad = false;        ///< The pose of a body is invalid.
    double distance = 0.0;         ///< Distance of the nearest minimum [m]; infinity if there is none.
    double completeTo = 0.0;       ///< Every minimum nearer than this was found [m].
    /// Pairs of nodes and features visited, and merging. For a reused result, the work that it
    /// took originally.
    std::uint64_t work = 0;
  };

  /// Max bodies whose minima are kept for reuse in the next tick.
  static constexpr std::size_t kMaxKeptBodies = 256;

  /// Allocates all work space.
  MinimaFinder();

  /// Finds the minima within the cutoff, with an allowance of work for all bodies together. Beyond the
  /// allowance minima are left out, the nearest last, and the result says truncated.
  ///
  /// With an allowance for areas, of the minima of an area of contact of one body all but the nearest are marked as
  /// merged; beyond that allowance the farthest minima are not.
  ///
  /// Calls feel(span of minima in world coordinates) once for each body that may be near; the span may be
  /// empty. Minima come from the lists where they cover the pose, else from a search bounded by
  /// kMaxNodePairs. Far bodies cost nothing. If nothing has changed since the last call (the tracked scene by
  /// its serial, all else bit for bit), nothing is searched: feel() gets the same minima again.
  ///
  /// @param cutoff     [m]; finite, > 0.
  /// @param apart      Lower bound on the distance to the bodies that do not overlap the part
  ///                   [m]; 0 if unknown.
  /// @param allowance  kFelt or kFeltByArea, or kShown if no force depends on the minima.
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

  /// Writes the nearest minima of the last find(), and its counts, to the snapshot. Real-time safe.
  void write(ServoSnapshot& snapshot) const noexcept;

 private:
  /// Everything that a result depends on, bit for bit: +0 and -0 differ.
  using Question = std::array<std::uint64_t, 13>;
  /// @param lengths  Cutoff, and lower bound on the distance [m].
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
  /// Marks those for whose area of contact another one stands.
  void mergeByArea(const Task& task, const RigidTransform& bodyFromPart, double cutoff,
                   std::span<Lmd> found) noexcept;
  void keepForDisplay(const Task& task, std::span<const Lmd> found) noexcept;

  LmdScratch scratch_;
  std::vector<Lmd> lmds_;                   ///< Minima of one body after another, while there is room.
  std::vector<std::span<const Lmd>> kept_;  ///< Minima of each body; the first keptCount_ are in use.
  std::size_t usedLmds_ = 0, keptCount_ = 0;
  Question asked_{};
  bool isAnswerKept_ = false;  ///< The minima found for the last question are all kept.
  /// Nearest minima of all bodies so far; the first displayCount_ are in use.
  std::vector<SnapshotLmd> display_;
  std::size_t displayCount_ = 0;
  MinimaAllowance left_;
  std::uint64_t nodePairsLeft_ = 0;
  bool displayWasCut_ = false, mergesAreas_ = false;
  Result result_;
};

}  // namespace nearfit
