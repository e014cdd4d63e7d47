#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/proximity/hierarchy/feature_set_bounds.h"
#include "core/proximity/hierarchy/feature_set_splitter.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit {

/// Number of features below each full child of a node over `count` features: the smallest power of eight with
/// which eight children suffice.
inline std::size_t fullChild(std::size_t count) {
  std::size_t size = 1;
  while (size * NormalConeTree::kWidth < count)
    size *= NormalConeTree::kWidth;
  return size;
}

/// Divides `items` into at most eight spans, all but one full, halving the largest each time.
/// @param halve  halve(items, cut) reorders `items` so that the first `cut` are one half.
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

/// Returns a node without children.
NormalConeTree::Node emptyNode() noexcept;
/// Writes a bound to one lane of a node.
void setLane(NormalConeTree::Node& node, std::size_t lane, const NormalConeTree::Bound& b) noexcept;

/// Builds the subtree below one lane of a hierarchy, on one thread.
class SubtreeBuilder {
 public:
  /// @param geometry  Kept by reference.
  /// @param size      The mesh's diagonal [m].
  SubtreeBuilder(const FeatureGeometry& geometry, double size) : bounds_(geometry, size) {}

  /// @param feature  Its index in the FeatureGeometry.
  /// @param centre   Centre of the feature's box, relative to the tree's centre [m].
  /// @param leaf     Leaf child that refers to it.
  void add(std::uint32_t feature, const std::array<float, 3>& centre, std::uint32_t leaf);

  /// Call once. Bounds the added features and writes their nodes, root first, to the empty `nodes`; a single
  /// feature needs none.
  void build(NormalConeTree::Bound& bound, std::vector<NormalConeTree::Node>& nodes);

 private:
  std::uint32_t buildNode(std::span<std::uint32_t> part, const NormalConeTree::Bound& bound,
                          std::vector<NormalConeTree::Node>& nodes);

  FeatureSetBounds bounds_;
  FeatureSetSplitter splitter_;
  std::vector<std::uint32_t> features_, leaves_;
  std::vector<std::array<float, 3>> centres_;
};

}  // namespace nearfit
