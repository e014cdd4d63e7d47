#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/proximity/box_pairs.h"
#include "core/proximity/minimum.h"
#include "core/proximity/touching.h"

namespace nearfit {

/// Work space of mergeMinima, allocated once.
struct MergeWork {
  /// What entries are sorted by: at hand, not in minima that are strewn about in memory.
  struct Key {
    FeatureKey features;
    std::uint32_t index;
  };

  /// @param capacity  Minima, and pieces of flat regions, that can be merged.
  explicit MergeWork(std::size_t capacity)
      : boxes(capacity), sides(capacity), parent(capacity), starts(capacity), keys(capacity) {}

  BoxPairs boxes;
  std::vector<PieceSides> sides;  ///< Of each entry, where it is a piece of faces.
  std::vector<std::uint32_t> parent, starts;
  std::vector<Key> keys;
};

struct MergeResult {
  std::size_t count = 0;        ///< Of what is left.
  std::uint64_t pairs = 0;      ///< Of entries with boxes that overlap: what was looked at.
  std::uint64_t touchings = 0;  ///< Of them, those that had to be tested exactly for a common point.
};

/// Makes one minimum of each set of entries that touch each other at one distance: neighbouring features that
/// claim a minimum at their common boundary, and the pieces of a flat region with the points at its rim:
/// where faces are parallel only to kFlatTolerance, one of those points is the minimum and the region stands
/// for it. A set of points is what its first entry says that is not marginal, if there is one. Sets are the
/// transitive closure of touching, whatever the order of the entries.
///
/// @param order        Its first `count` entries then name the results in `minima`, nearest first, regions as
///                     their centroids; as long as `minima`.
/// @param size         Of both bodies together [m], for tolerances.
/// @param smallerSize  Of the smaller body [m].
/// Real-time safe. O(n log n) where each piece has a few neighbours.
MergeResult mergeMinima(std::span<Minimum> minima, std::span<std::uint32_t> order, MergeWork& work,
                        double size, double smallerSize) noexcept;

}  // namespace nearfit
