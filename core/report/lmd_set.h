#pragma once

#include <cstddef>
#include <vector>

#include "core/mesh/mass_properties.h"
#include "core/proximity/lmd_query.h"

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

 private:
  std::size_t limit_;
  std::size_t capacity_;
  LmdScratch scratch_;
};

/// "vertex", "edge" or "face".
const char* nameOf(FeatureKind kind) noexcept;
/// "volume integrals" or "oriented box".
const char* nameOf(MassBasis basis) noexcept;

}  // namespace nearfit
