#pragma once

#include <cstdint>

namespace nearfit {

/// Spreads the bits of a number, for hash tables (the finaliser of SplitMix64).
constexpr std::uint64_t mixedBits(std::uint64_t x) noexcept {
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31U);
}

}  // namespace nearfit
