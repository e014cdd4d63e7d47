#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/math/rigid_transform.h"
#include "core/proximity/minimum.h"
#include "core/proximity/query/contact_query.h"
#include "core/proximity/query/cull_kernel.h"
#include "core/proximity/query/lmd_query.h"
#include "core/proximity/query/motion_budget.h"
#include "core/proximity/query/range_limits.h"

namespace nearfit {

/// Work of testing a pair of features for a minimum, in blocks of pairs culled.
constexpr std::uint64_t kWorkOfLeafTest = 4;

/// List of the pairs of features that can carry a minimum at any pose within a range of motion. Within the
/// range, testing these alone is exact.
///
/// Pairs are sorted by the share of the range at which they begin to matter, so that queries near its middle
/// look at fewer.
class CandidateList {
 public:
  /// Max size of a list and of its search. The defaults are some 4 MB, beyond which a tick would take as long
  /// as a cold query, and some 5 ms of search, beyond which a list comes too late.
  struct Bounds {
    std::size_t pairs = 1U << 15;
    std::uint64_t nodePairs = 1U << 17;
  };

  /// Builds the list by searching both trees, which must outlive its use. Allocates; not for the servo
  /// thread. The list is unusable afterwards if it would exceed the bounds.
  /// @param query       Its pose is the middle of the range.
  /// @param range       In the frame of the scene's mesh.
  /// @param relaxation  Max relaxation that nearbyPairs() may ask for [rad]. If > 0, the list leaves out
  ///                    regions of faces and serves nearbyPairs() only.
  /// @param hasLevels   False for a list whose pairs are always taken for a whole way: it is built faster.
  void build(const BodyPairQuery& query, const MotionRange& range, LmdScratch& scratch, const Bounds& bounds,
             double relaxation = 0.0, bool hasLevels = true);
  void build(const BodyPairQuery& query, const MotionRange& range, LmdScratch& scratch) {
    build(query, range, scratch, Bounds{});
  }

  /// Share of the range that a pose uses; above 1 the list does not hold. Infinity if the list is unusable.
  double spent(const RigidTransform& sceneFromPart) const noexcept;

  /// Share of the range's budget, for deviation from the stretch, that is left at a pose; negative where the
  /// list does not hold.
  double roomLeft(const RigidTransform& sceneFromPart) const noexcept;

  /// Time at which the list's stretch, if it went on, would be nearest to a pose; beyond -1 or 1 the list has ended.
  double timeAt(const RigidTransform& sceneFromPart) const noexcept;

  /// True if the list is exact for a pose and cutoff [m].
  bool covers(const RigidTransform& sceneFromPart, double cutoff) const noexcept;

  /// Finds the exact set at a pose, as findLmds does; no value if the list does not cover the pose and
  /// cutoff. Real-time safe.
  /// @param maxWork  Bound on blocks culled plus kWorkOfLeafTest for each pair tested. If the whole set takes more than half of it,
  ///                 the rest goes to the nearest minimum, as in findNearestLmds.
  std::optional<LmdResult> query(
      const RigidTransform& sceneFromPart, double cutoff, LmdScratch& scratch, std::span<Lmd> out,
      std::uint64_t maxWork = std::numeric_limits<std::uint64_t>::max()) const noexcept;

  /// Room for deviation that the list leaves all along a way of the part, straight as to the middle of its box; no value
  /// if it does not cover the way, or was built for a shorter cutoff or less relaxation. Real-time safe.
  std::optional<MotionBudget> roomAlong(const RigidTransform& from, const RigidTransform& to,
                                        const ContactReach& reach) const noexcept;

  /// As findNearbyPairs, from the list; the result holds for as much of the slack as the list does. No value
  /// if the list does not cover the pose, or was built for a shorter cutoff or less relaxation. Does not
  /// begin if a pass over the list exceeds `maxWork`. Real-time safe.
  std::optional<NearbyPairs> nearbyPairs(
      const RigidTransform& sceneFromPart, const ContactReach& reach, const MotionBudget& slack,
      LmdScratch& scratch, std::span<LeafPair> out,
      std::uint64_t maxWork = std::numeric_limits<std::uint64_t>::max()) const noexcept {
    return nearbyPairsAlong(sceneFromPart, sceneFromPart, reach, slack, scratch, out, maxWork);
  }
  /// The same for all poses within `slack` of a way, as in roomAlong().
  std::optional<NearbyPairs> nearbyPairsAlong(
      const RigidTransform& from, const RigidTransform& to, const ContactReach& reach,
      const MotionBudget& slack, LmdScratch& scratch, std::span<LeafPair> out,
      std::uint64_t maxWork = std::numeric_limits<std::uint64_t>::max()) const noexcept;

  /// Adds all pairs to a vector.
  void appendPairs(std::vector<LeafPair>& out) const;

  /// Pairs of nodes that the last build opened.
  std::uint64_t searchWork() const noexcept { return searchWork_; }
  /// Number of pairs.
  std::size_t size() const noexcept { return levelEnds_.back(); }
  /// False before build(), and if the last build exceeded its bounds.
  bool isUsable() const noexcept { return isUsable_; }
  /// Cutoff that the list was built for [m].
  double cutoff() const noexcept { return cutoff_; }

 private:
  struct LanePair {
    std::uint32_t sceneLane, partLane;
    std::uint8_t level;
  };

  /// Shares of the range, one per level; within each, the pairs of its level and of those before suffice.
  static constexpr std::array<double, 4> kLevels{0.25, 0.5, 0.75, 1.0};

  /// A pose that the list covers.
  struct CoveredPose {
    RigidTransform centred;
    std::size_t count;  ///< Number of pairs that matter there.
  };
  std::optional<CoveredPose> covered(const RigidTransform& sceneFromPart, double cutoff) const noexcept;
  /// Calls visit(scene leaf, part leaf) for each of the first `count` pairs that survives the culls, until
  /// visit returns false.
  /// @param cull  Returns the lanes of a block that survive.
  /// @returns Number of blocks of pairs culled.
  template <class Cull, class Visit>
  std::size_t visitPairs(std::size_t count, Cull&& cull, Visit&& visit) const noexcept;
  RangeLimits limitsWithin(double share) const noexcept;
  /// A way between the centred frames.
  struct Way {
    RigidTransform middle;
    MotionStretch stretch;
    bool isOfOnePose = true;
  };
  Way wayBetween(const RigidTransform& from, const RigidTransform& to) const noexcept;
  /// The way, if the list can serve it with that reach.
  std::optional<Way> wayFor(const RigidTransform& from, const RigidTransform& to,
                            const ContactReach& reach) const noexcept;
  std::optional<MotionBudget> roomAlong(const Way& way) const noexcept;
  double spentAt(const RigidTransform& centred) const noexcept;
  MotionBudget asideOf(const RigidTransform& centred) const noexcept;
  void findLevels(const LmdScratch::Data& workspace) noexcept;
  void pack();
  void copyPair(const LanePair& pair, BoundPairs& block, std::size_t at) const noexcept;
  std::size_t countFor(double share) const noexcept;

  std::vector<BoundPairs> blocks_;
  std::vector<LanePair> found_;
  std::array<std::size_t, kLevels.size()> levelEnds_{};
  bool isUsable_ = false;
  std::uint64_t searchWork_ = 0;
  const NormalConeTree *scene_ = nullptr, *part_ = nullptr;
  RigidTransform pose_;  ///< Between the trees' centred frames.
  double cutoff_ = 0.0, relaxation_ = 0.0;
  MotionRange range_;  ///< About pose_, in the scene's axes.
};

/// True if no pair of features can carry a minimum within a budget of the query's pose; false also if finding
/// out takes more than `maxNodePairs`. Real-time safe.
bool isClearWithin(const BodyPairQuery& query, const MotionBudget& budget, LmdScratch& scratch,
                   std::uint64_t maxNodePairs) noexcept;

}  // namespace nearfit
