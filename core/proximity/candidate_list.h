#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/math/rigid_transform.h"
#include "core/proximity/contact_query.h"
#include "core/proximity/cull_kernel.h"
#include "core/proximity/lmd_query.h"
#include "core/proximity/minimum.h"
#include "core/proximity/motion_budget.h"
#include "core/proximity/range_limits.h"

namespace nearfit {

/// The pairs of features that can carry a minimum at any pose within a range of motion: testing those alone
/// is exact there.
///
/// Pairs are sorted by the share of the range from which on they matter: near its middle, only those are
/// looked at that matter there.
class CandidateList {
 public:
  /// How much a list may be: by default some 4 MB, with more of which a tick would take as long as a cold
  /// query, and some 5 ms of search, longer than which comes too late.
  struct Bounds {
    std::size_t pairs = 1U << 15;
    std::uint64_t nodePairs = 1U << 17;
  };

  /// Searches both trees. For a thread that can take its time: allocates. The trees stay alive as long as the
  /// list is used. Unusable afterwards when it would be beyond the bounds.
  /// @param query       Its pose is the middle of the range.
  /// @param range       In the frame of the scene's mesh.
  /// @param relaxation  For nearbyPairs(): the turn by which conditions are relaxed there [rad].
  void build(const BodyPairQuery& query, const MotionRange& range, LmdScratch& scratch, const Bounds& bounds,
             double relaxation = 0.0);
  void build(const BodyPairQuery& query, const MotionRange& range, LmdScratch& scratch) {
    build(query, range, scratch, Bounds{});
  }

  /// Share of the range that a pose has spent; above 1 the list does not hold.
  double spent(const RigidTransform& sceneFromPart) const noexcept;

  /// Share of the range's room aside that is left at a pose; negative where the list does not hold.
  double roomLeft(const RigidTransform& sceneFromPart) const noexcept;

  /// Whether the list is exact for a pose and cutoff.
  bool covers(const RigidTransform& sceneFromPart, double cutoff) const noexcept;

  /// The exact set at a pose, as findLmds gives it; none when the list does not cover it. Real-time safe.
  /// @param maxWork  Bound on blocks culled and pairs tested. When the whole set takes more than half of it,
  ///                 the rest is for what is nearest, as findNearestLmds has it.
  std::optional<LmdResult> query(
      const RigidTransform& sceneFromPart, double cutoff, LmdScratch& scratch, std::span<Lmd> out,
      std::uint64_t maxWork = std::numeric_limits<std::uint64_t>::max()) const noexcept;

  /// As findNearbyPairs, from the list; it holds for as much of the slack as the list does. None when the
  /// list does not cover the pose, was made for a shorter cutoff, or for less relaxation. A list that cannot
  /// be gone through within the work is not begun. Real-time safe.
  std::optional<NearbyPairs> nearbyPairs(
      const RigidTransform& sceneFromPart, const ContactReach& reach, const MotionBudget& slack,
      LmdScratch& scratch, std::span<LeafPair> out,
      std::uint64_t maxWork = std::numeric_limits<std::uint64_t>::max()) const noexcept;

  std::size_t size() const noexcept { return levelEnds_.back(); }
  bool isUsable() const noexcept { return isUsable_; }
  double cutoff() const noexcept { return cutoff_; }

 private:
  struct LanePair {
    std::uint32_t sceneLane, partLane;
    std::uint8_t level;
  };

  /// Shares of the range up to which the pairs of a level and those before it are enough.
  static constexpr std::array<double, 4> kLevels{0.25, 0.5, 0.75, 1.0};

  /// A pose for which the list holds.
  struct CoveredPose {
    RigidTransform centred;
    std::size_t count;  ///< Pairs that matter there.
  };
  std::optional<CoveredPose> covered(const RigidTransform& sceneFromPart, double cutoff) const noexcept;
  /// Calls visit(scene leaf, part leaf) for those of the first `count` pairs that survive the culls, until it
  /// says false.
  /// @returns how many blocks of pairs were culled.
  template <class Visit>
  std::size_t visitPairs(const RigidTransform& centred, std::size_t count, const CullLimits& limits,
                         LmdScratch& scratch, Visit&& visit) const noexcept;
  RangeLimits limitsWithin(double share) const noexcept;
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
  const NormalConeTree *scene_ = nullptr, *part_ = nullptr;
  RigidTransform pose_;  ///< Between the trees' centred frames.
  double cutoff_ = 0.0, relaxation_ = 0.0;
  MotionRange range_;  ///< About pose_, in the scene's frame.
};

/// Whether no pair of features can carry a minimum within a budget of the query's pose, as far as
/// `maxNodePairs` of work tell: false when it takes more.
bool isClearWithin(const BodyPairQuery& query, const MotionBudget& budget, LmdScratch& scratch,
                   std::uint64_t maxNodePairs) noexcept;

}  // namespace nearfit
