#pragma once

#include <cstddef>
#include <cstdint>

namespace nearfit {

/// Max work for finding minima in a tick. A unit is one pair of nodes or features visited, some 50 ns
/// on a slow core.
struct MinimaAllowance {
  std::uint64_t search = 0;  ///< For pairs of nodes and features; exceeded by kSearchBatch at most.
  std::uint64_t merge = 0;   ///< For merging minima and pieces of regions, and pairs of them.

  static constexpr std::uint64_t kSearchBatch = 128;
  /// Upper bound on the total work.
  constexpr std::uint64_t most() const noexcept { return search + kSearchBatch + merge; }
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

}  // namespace nearfit
