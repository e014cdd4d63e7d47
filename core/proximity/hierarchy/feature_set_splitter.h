#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/proximity/hierarchy/feature_set_bounds.h"

namespace nearfit {

/// Splits a set of features in two so that queries open few of the resulting subsets: by position along the
/// mesh's or the set's axes, or by direction along the set's, whichever leaves subsets that are small in
/// both. Reuses its work space; one per thread.
class FeatureSetSplitter {
 public:
  /// Loads the features, which are named by their index here. Keeps both arrays by reference.
  /// @param centres  Relative to the tree's centre [m].
  /// @param extents  Along the axes of a set; must be current for its features when it is split.
  void load(std::span<const std::array<float, 3>> centres, std::span<const Extents> extents);

  /// Sets the scale for the splits that follow.
  /// @param size    Half the diagonal of the box of the set to split [m].
  /// @param spread  Max reach of its directions to the sides: the larger of mostU and mostV.
  void begin(float size, float spread) noexcept;

  /// Reorders `features` so that the first `cut` are one subset. Linear time.
  void split(std::span<std::uint32_t> features, std::size_t cut);

 private:
  /// Sort keys: position along the mesh's axes and the set's axes, direction along the set's axes.
  static constexpr std::size_t kKeys = 9, kPositionKeys = 6;

  /// Sort value in the upper half, feature in the lower.
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
