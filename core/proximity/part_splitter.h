#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/proximity/part_bounds.h"

namespace nearfit {

/// Divides the features of a part in two so that a query has reason to open few of the pieces: by position
/// along the mesh's axes or the part's, or by direction along the part's, whichever leaves pieces that are
/// small in both. Keeps its work space; one per thread.
class PartSplitter {
 public:
  /// Takes in what is known of features, named by their index here; kept by reference.
  /// @param centres  In the mesh's axes [m].
  /// @param extents  Along the axes of a part; those of its features must be right when it is split.
  void load(std::span<const std::array<float, 3>> centres, std::span<const Extents> extents);

  /// @param size    Half the diagonal of the box of the part that is split from now on [m].
  /// @param spread  How far its directions reach to the sides: mostU or mostV.
  void begin(float size, float spread) noexcept;

  /// Puts the first piece's `cut` features first. Takes time in proportion to the number of features.
  void split(std::span<std::uint32_t> features, std::size_t cut);

 private:
  /// Three axes of the mesh and three of the part for position, three of the part for direction.
  static constexpr std::size_t kKeys = 9, kPositionKeys = 6;

  /// What a feature is sorted by, and below that the feature.
  using Key = std::uint64_t;
  static std::uint32_t featureOf(Key key) noexcept { return static_cast<std::uint32_t>(key); }

  Key key(std::size_t kind, std::uint32_t feature) const noexcept;
  void sort(std::size_t kind, std::span<const std::uint32_t> features, std::size_t stride, std::size_t cut);
  float cost(std::span<const Key> features) const noexcept;

  std::span<const Extents> extents_;
  std::span<const std::array<float, 3>> centres_;
  float reach_ = 0.0F;
  std::size_t keysTried_ = kKeys;
  std::vector<Key> keys_, best_;
};

}  // namespace nearfit
