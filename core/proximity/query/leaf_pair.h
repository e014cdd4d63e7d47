#pragma once

#include <cstdint>

namespace nearfit {

/// Pair of features: a leaf child of each hierarchy (see NormalConeTree::isLeaf).
struct LeafPair {
  std::uint32_t scene = 0, part = 0;
};

}  // namespace nearfit
