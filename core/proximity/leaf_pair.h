#pragma once

#include <cstdint>

namespace nearfit {

/// A leaf of either hierarchy: a pair of features.
struct LeafPair {
  std::uint32_t scene = 0, part = 0;
};

}  // namespace nearfit
