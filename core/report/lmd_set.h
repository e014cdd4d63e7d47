#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/mesh/mass_properties.h"
#include "core/proximity/candidate_list.h"
#include "core/proximity/lmd_query.h"
#include "core/proximity/lmd_tracker.h"

namespace nearfit {

/// All minima of one query.
struct LmdSet {
  std::vector<Lmd> lmds;   ///< Nearest first, points in the scene mesh's frame; blocked ones are marked.
  bool isComplete = true;  ///< False when there are more than the collector's limit: its nearest are there.
  double queryTime = 0.0;  ///< Of the query that gave this set alone [s].
};

/// Finds whole sets for reports, with as much storage as they need. Not for servo code: it allocates.
class LmdCollector {
 public:
  /// @param limit     Minima that a set may hold; bounds memory at some kilobytes each.
  /// @param capacity  Minima to begin with room for; > 0.
  explicit LmdCollector(std::size_t limit, std::size_t capacity = LmdScratch::kDefaultCapacity)
      : limit_(limit), capacity_(capacity), scratch_(capacity) {}

  /// As findLmds, and marks what is blocked; storage that proves too small is grown, and the query run again.
  LmdSet collect(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
                 double cutoff);

  /// The same by following the part from pose to pose: what can become a minimum near a pose is searched
  /// ahead, and the time of that is no part of `queryTime`.
  LmdSet collectTracked(const NormalConeTree& scene, const NormalConeTree& part,
                        const RigidTransform& sceneFromPart, double cutoff);

 private:
  /// @param find  (LmdScratch&, std::span<Lmd>) to LmdResult.
  template <class Find>
  LmdSet grow(const BodyPairQuery& query, Find&& find);

  std::size_t limit_;
  std::size_t capacity_;
  LmdScratch scratch_;
  std::optional<LmdTracker> tracker_;  ///< Of the trees last followed.
  CandidateList list_;
  const NormalConeTree *followedScene_ = nullptr, *followedPart_ = nullptr;
};

/// "vertex", "edge" or "face".
const char* nameOf(FeatureKind kind) noexcept;
/// "volume integrals" or "oriented box".
const char* nameOf(MassBasis basis) noexcept;

}  // namespace nearfit
