#pragma once

#include <random>

/// Random numbers that are the same with every standard library (its distributions are not).
namespace nearfit::test {

/// Uniform in [0, 1).
inline double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

}  // namespace nearfit::test
