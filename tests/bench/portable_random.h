#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include <glm/vec3.hpp>

#include "tests/support/portable_random.h"

/// Random numbers that are the same with every standard library (its distributions are not).
namespace nearfit::bench {

using test::uniform;

/// Uniform on the unit sphere.
inline glm::dvec3 randomDirection(std::mt19937_64& random) {
  const double z = 2.0 * uniform(random) - 1.0;
  const double angle = 2.0 * std::numbers::pi * uniform(random);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace nearfit::bench
