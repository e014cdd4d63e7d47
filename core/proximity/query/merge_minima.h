#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/box_pairs.h"
#include "core/proximity/minimum.h"
#include "core/proximity/query/touching.h"

namespace nearfit {

/// Work space of mergeMinima, allocated once.
struct MergeWork {
  /// Sort key, copied out of minima that are scattered in memory.
  struct Key {
    FeatureKey features;
    std::uint32_t index;
  };

  /// @param capacity  Max number of minima and region pieces to merge.
  explicit MergeWork(std::size_t capacity)
      : boxes(capacity), sides(capacity), parent(capacity), starts(capacity), keys(capacity) {}

  BoxPairs boxes;
  std::vector<PieceSides> sides;  ///< Sides of each entry that is a piece of a region of faces.
  std::vector<std::uint32_t> parent, starts;
  std::vector<Key> keys;
};

/// Counts of mergeMinima.
struct MergeResult {
  std::size_t count = 0;        ///< Minima after merging.
  std::uint64_t pairs = 0;      ///< Pairs of entries whose boxes overlap, all of which were examined.
  std::uint64_t touchings = 0;  ///< Pairs of these that needed an exact test for a common point.
};

/// Merges each set of entries that touch each other at one distance into one minimum: neighbouring features
/// that claim a minimum at their common boundary, and the pieces of a flat region with the points at its rim.
/// (Where faces are parallel only to kFlatTolerance, one of those points is the minimum, and the region
/// stands for it.) A set of points becomes its first entry that is not marginal, or else its first. Sets are
/// the transitive closure of touching, whatever the order of the entries.
///
/// @param minima       Entries, within the capacity of `work`; results overwrite some.
/// @param order        As long as `minima`. Receives, in its first `count` entries, the indices of the
///                     results in `minima`, nearest first; regions are represented at their centroids.
/// @param size         Size of both bodies together [m], for tolerances.
/// @param smallerSize  Size of the smaller body [m].
/// Real-time safe. O(n log n) if each piece has few neighbours.
MergeResult mergeMinima(std::span<Minimum> minima, std::span<std::uint32_t> order, MergeWork& work,
                        double size, double smallerSize) noexcept;

}  // namespace nearfit
