#pragma once

#include <cstddef>
#include <cstdint>

namespace nearfit {

/// What finding minima may take in a tick, in units of work: a pair of nodes or of features looked at is one,
/// some 50 ns on a slow core.
struct MinimaAllowance {
  std::uint64_t search = 0;  ///< For pairs of nodes and features; beyond it by kSearchBatch at most.
  std::uint64_t merge = 0;   ///< For pieces and minima, and pairs of them.

  static constexpr std::uint64_t kSearchBatch = 128;
  constexpr std::uint64_t most() const noexcept { return search + kSearchBatch + merge; }
};

/// A piece of a region, or a minimum, is merged and then held against what may bar its way; two with boxes
/// that overlap are held against each other, which in a flat contact is far less than each with each.
constexpr std::uint64_t kWorkOfPiece = 32, kPiecePairsOfWork = 4;

/// Of so many pieces, and pairs of them.
constexpr std::uint64_t mergeWork(std::uint64_t pieces, std::uint64_t pairs) noexcept {
  return kWorkOfPiece * pieces + pairs / kPiecePairsOfWork;
}

/// Of so many pieces at most, whatever pairs of them overlap.
constexpr std::uint64_t mostMergeWork(std::uint64_t pieces) noexcept {
  return mergeWork(pieces, pieces * pieces / 2);
}

/// The most pieces that surely can be merged within so much work.
constexpr std::size_t mergeablePieces(std::uint64_t work) noexcept {
  std::uint64_t low = 0, high = 1U << 20;
  while (high - low > 1) {
    const std::uint64_t middle = (low + high) / 2;
    (mostMergeWork(middle) <= work ? low : high) = middle;
  }
  return static_cast<std::size_t>(low);
}

}  // namespace nearfit
