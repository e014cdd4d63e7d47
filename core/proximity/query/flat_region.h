#pragma once

#include <cstdint>
#include <span>

#include "core/math/box_pairs.h"
#include "core/proximity/minimum.h"

namespace nearfit {

/// Where to find the pieces that may cover another piece, or some of it.
struct RegionNeighbours {
  const BoxPairs& boxes;  ///< Boxes of all entries, by index; those of overlapping pieces share a point.
  std::span<const std::uint32_t> region;  ///< A number per entry, which the entries of its region share.
};

/// Returns the representative of a flat region. Its centroid and extent are those of the union of the pieces
/// of the highest dimension: means over area (or length), which do not depend on the meshing of the bodies.
/// Exception: if faces overlap only in a strip that is shorter than the edges beside it and no wider than
/// kFlatTolerance times their length and distance, the edges count instead of the faces. Its distance is the
/// min of all pieces, its features are the largest piece's. It is marginal if all are.
///
/// @param group       Indices in `minima` of the pieces and of the points at their rims; at least one piece.
/// @param neighbours  For all entries of `minima`.
/// @param tolerance   Lengths that differ by less count as equal [m].
/// Real-time safe. Linear, but pieces marked as overlapping are compared with those whose boxes meet theirs.
Lmd uniteRegion(std::span<const Minimum> minima, std::span<const std::uint32_t> group,
                const RegionNeighbours& neighbours, double tolerance) noexcept;

}  // namespace nearfit
