#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/proximity/normal_cone_tree.h"
#include "core/proximity/part_bounds.h"
#include "core/proximity/part_splitter.h"

namespace nearfit {

/// How many features a child of a node over `count` features holds when it is full: the least power of eight
/// that eight children need.
inline std::size_t fullChild(std::size_t count) {
  std::size_t size = 1;
  while (size * NormalConeTree::kWidth < count)
    size *= NormalConeTree::kWidth;
  return size;
}

/// Divides `items` into at most eight pieces that are full but for the last, the largest in half each time,
/// and returns them.
/// @param halve  Called with the items to order so that the first `cut` are one half.
template <class Item, class Halve>
std::vector<std::span<Item>> pieces(std::span<Item> items, Halve&& halve) {
  const std::size_t unit = fullChild(items.size());
  std::vector<std::span<Item>> out{items};
  for (;;) {
    auto& largest = *std::max_element(out.begin(), out.end(),
                                      [](const auto& a, const auto& b) { return a.size() < b.size(); });
    const std::span<Item> whole = largest;
    if (whole.size() <= unit || out.size() == NormalConeTree::kWidth) return out;
    const std::size_t cut = std::max<std::size_t>(1, (whole.size() / 2 + unit / 2) / unit) * unit;
    halve(whole, cut);
    largest = whole.first(cut);
    out.push_back(whole.subspan(cut));
  }
}

/// A node without children.
NormalConeTree::Node emptyNode() noexcept;
void setLane(NormalConeTree::Node& node, std::size_t lane, const NormalConeTree::Bound& b) noexcept;

/// Builds what hangs from one lane of a hierarchy, on one thread.
class SubtreeBuilder {
 public:
  /// @param geometry  Kept by reference.
  /// @param size      The mesh's diagonal [m].
  SubtreeBuilder(const FeatureGeometry& geometry, double size) : bounds_(geometry, size) {}

  /// @param centre  Of the feature's box, in the mesh's axes [m].
  /// @param leaf    The child that stands for it.
  void add(std::uint32_t feature, const std::array<float, 3>& centre, std::uint32_t leaf);

  /// Once. Bounds what was added, and leaves its nodes, the uppermost first; none for a single feature.
  void build(NormalConeTree::Bound& bound, std::vector<NormalConeTree::Node>& nodes);

 private:
  std::uint32_t buildNode(std::span<std::uint32_t> part, const NormalConeTree::Bound& bound,
                          std::vector<NormalConeTree::Node>& nodes);

  PartBounds bounds_;
  PartSplitter splitter_;
  std::vector<std::uint32_t> features_, leaves_;
  std::vector<std::array<float, 3>> centres_;
};

}  // namespace nearfit
