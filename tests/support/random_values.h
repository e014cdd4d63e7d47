#pragma once

#include <random>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/math/rotation_vector.h"

namespace nearfit::test {

/// Values of a fixed sequence: same seed, same values.
class RandomValues {
 public:
  explicit RandomValues(unsigned seed) : engine_(seed) {}

  double in(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }
  bool flip(double probability) { return in(0.0, 1.0) < probability; }
  /// Components within [-size, size].
  glm::dvec3 vector(double size) {
    const double x = in(-size, size), y = in(-size, size), z = in(-size, size);
    return {x, y, z};
  }
  /// Turned about any axis by up to half a turn and more, within a metre.
  RigidTransform pose() {
    const glm::dvec3 turn = vector(3.0);
    return {rotationOf(turn), vector(0.5)};
  }

 private:
  std::mt19937 engine_;
};

}  // namespace nearfit::test
