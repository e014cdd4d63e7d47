#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/proximity/query/lmd_query.h"
#include "core/proximity/tracking/candidate_list.h"
#include "core/proximity/tracking/lmd_tracker.h"

namespace nearfit {

/// Beyond this many sizes of both bodies together from the origin, double precision does not carry how far faces
/// overlap: `extent` had the wrong dimension and measure at 140,000. A tenth of that, to be safe.
constexpr double kMaxExtentOrigin = 1e4;

/// Marks all regions as marginal if `fromOrigin`, the largest distance from the origin of a body or pose [m], is
/// beyond that many sizes.
/// @param size  Sum of the bodies' diagonals [m].
void markFarRegions(std::vector<Lmd>& lmds, double fromOrigin, double size) noexcept;

/// All minima of one query.
struct LmdSet {
  std::vector<Lmd> lmds;   ///< Nearest first, in the scene mesh's frame; blocked ones are marked.
  bool isComplete = true;  ///< False if there are more than the limit; the nearest are kept.
  std::size_t areas = 0;   ///< Areas of contact, once mergeByArea() has been called.
  double queryTime = 0.0;  ///< Duration of the final query alone [s].
};

/// Two bodies that are followed from pose to pose, with what was searched ahead for them.
class FollowedPair {
 public:
  /// @param scene, part  Must outlive this.
  FollowedPair(const NormalConeTree& scene, const NormalConeTree& part) noexcept
      : scene_(&scene), part_(&part), tracker_(scene, part) {}

 private:
  friend class LmdCollector;
  const NormalConeTree *scene_, *part_;
  LmdTracker tracker_;
  CandidateList list_;
};

/// Finds complete sets of minima for reports, growing its storage as needed. Allocates: not for servo code.
class LmdCollector {
 public:
  /// @param limit     Max minima in a set; bounds memory to some kilobytes each.
  /// @param capacity  Initial room for minima; > 0.
  explicit LmdCollector(std::size_t limit, std::size_t capacity = LmdScratch::kDefaultCapacity)
      : limit_(limit), capacity_(capacity), scratch_(capacity) {}

  /// Runs findLmds() and marks blocked minima, and regions far from the origin of either mesh. Grows the storage
  /// and repeats the query if it was too small.
  LmdSet collect(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
                 double cutoff);

  /// Like collect(), but follows the part from pose to pose: searches ahead for what can become a minimum
  /// near a pose. That time is not part of `queryTime`.
  LmdSet collectTracked(const NormalConeTree& scene, const NormalConeTree& part,
                        const RigidTransform& sceneFromPart, double cutoff);
  /// The same for one of several pairs that are followed by turns.
  LmdSet collectTracked(FollowedPair& pair, const RigidTransform& sceneFromPart, double cutoff);

  /// Marks the minima of a set for whose area of contact another one stands (mergeAreas()), however much work it is.
  /// @param set  From collect() or collectTracked() with the same bodies, pose and cutoff.
  void mergeByArea(const NormalConeTree& scene, const NormalConeTree& part,
                   const RigidTransform& sceneFromPart, double cutoff, LmdSet& set);

 private:
  /// @param find  Maps (LmdScratch&, std::span<Lmd>) to LmdResult.
  template <class Find>
  LmdSet grow(const BodyPairQuery& query, Find&& find);

  std::size_t limit_;
  std::size_t capacity_;
  LmdScratch scratch_;
  /// Room for what a query finds. Kept: to make it takes longer than most queries.
  std::vector<Lmd> found_;
  std::optional<FollowedPair> followed_;  ///< The hierarchies last followed.
};

}  // namespace nearfit
