#pragma once

#include <cstdint>

#include "core/proximity/lmd.h"

namespace nearfit {

/// Pair of features: a leaf child of each hierarchy (see NormalConeTree::isLeaf).
struct LeafPair {
  std::uint32_t scene = 0, part = 0;
};

/// True if features of two kinds can form a contact. The points that span a flat region stand for it: a face forms
/// contacts with vertices alone, an edge with no face. Of two nodes, their lowest kinds tell whether any features below
/// them can.
constexpr bool spansContact(FeatureKind a, FeatureKind b) noexcept {
  static_assert(static_cast<int>(FeatureKind::Vertex) == 0 && static_cast<int>(FeatureKind::Edge) == 1 &&
                static_cast<int>(FeatureKind::Face) == 2);
  return static_cast<int>(a) + static_cast<int>(b) <= static_cast<int>(FeatureKind::Face);
}

}  // namespace nearfit
