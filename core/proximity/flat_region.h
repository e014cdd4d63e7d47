#pragma once

#include <cstdint>
#include <span>

#include "core/proximity/box_pairs.h"
#include "core/proximity/minimum.h"

namespace nearfit {

/// Where to find the pieces that may cover some of another.
struct RegionNeighbours {
  const BoxPairs& boxes;  ///< Of all entries, by their index; pieces that overlap have a point
                          ///< of their boxes in common.
  std::span<const std::uint32_t> region;  ///< Of each entry, as a number that its region's entries share.
};

/// The representative of a flat region: what its pieces of the highest dimension cover, counted once, has its
/// centroid and extent there: area (or length) means, which do not depend on how the bodies are meshed. The
/// distance is the least of all, the features are the largest piece's. It is marginal when all such pieces
/// are.
///
/// @param group       Indices of the pieces, and points at their rims, in `minima`; at least one piece.
/// @param neighbours  Of all that is in `minima`.
/// @param tolerance   Lengths that differ by less are one [m].
/// Real-time safe. Linear, but for pieces that are marked as overlapping: those are held against what their
/// boxes overlap.
Lmd uniteRegion(std::span<const Minimum> minima, std::span<const std::uint32_t> group,
                const RegionNeighbours& neighbours, double tolerance) noexcept;

}  // namespace nearfit
