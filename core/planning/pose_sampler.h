#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/planning/pose_planner.h"

namespace nearfit {

/// Random poses, the same on every machine for a seed.
class PoseSampler {
 public:
  explicit PoseSampler(std::uint64_t seed) : engine_(seed) {}

  /// 0 to 1, without 1.
  double share() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * share(); }
  /// Below `count`, which is not 0.
  std::size_t index(std::size_t count) {
    return static_cast<std::size_t>(share() * static_cast<double>(count));
  }

  glm::dvec3 direction() {
    const double z = between(-1.0, 1.0), angle = between(0.0, 2.0 * std::numbers::pi);
    const double across = std::sqrt(1.0 - z * z);
    return {across * std::cos(angle), across * std::sin(angle), z};
  }
  /// Source: Shoemake 1992.
  glm::dquat rotation() {
    const double u = share(), a = between(0.0, 2.0 * std::numbers::pi),
                 b = between(0.0, 2.0 * std::numbers::pi);
    const double p = std::sqrt(1.0 - u), q = std::sqrt(u);
    return {q * std::cos(b), p * std::sin(a), p * std::cos(a), q * std::sin(b)};
  }
  glm::dvec3 pointIn(const glm::dvec3& lower, const glm::dvec3& upper) {
    const double x = between(lower.x, upper.x), y = between(lower.y, upper.y);
    return {x, y, between(lower.z, upper.z)};
  }
  /// @param rotation  Of poses that may not turn.
  RigidTransform pose(const PoseBounds& bounds, const glm::dquat& rotation) {
    const glm::dvec3 centre = pointIn(bounds.lower, bounds.upper);
    return {bounds.mayTurn ? this->rotation() : rotation, centre};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace nearfit
