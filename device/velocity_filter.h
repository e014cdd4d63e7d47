#pragma once

#include <cmath>

#include <glm/vec3.hpp>

#include "device/servo/monotonic_clock.h"

namespace nearfit {

/// The speed of a handle whose device tells only where it is: differences, smoothed over kTime. Reports that
/// arrive late and all at once do not look fast: each counts by how far the handle went. Real-time safe.
class VelocityFilter {
 public:
  /// Longer than a few reports, so that an encoder's steps even out; far shorter than a hand's motion [s].
  static constexpr double kTime = 4e-3;

  /// @param time  Of arrival.
  /// @return Of the handle now [m/s].
  glm::dvec3 update(const glm::dvec3& position, Nanoseconds time) noexcept {
    if (hasLast_) {
      // A first-order lag of the velocity, constant in between, integrated exactly.
      const double passed = std::fmax(toSeconds(time - lastTime_), 0.0);
      const double decay = std::exp(-passed / kTime);
      const double weight = passed > kLeast ? (1.0 - decay) / passed : 1.0 / kTime;
      velocity_ = decay * velocity_ + weight * (position - lastPosition_);
    }
    hasLast_ = true;
    lastPosition_ = position;
    lastTime_ = time;
    return velocity_;
  }
  void reset() noexcept { *this = {}; }

 private:
  /// Below this the quotient is its limit to rounding.
  static constexpr double kLeast = 1e-9;

  bool hasLast_ = false;
  glm::dvec3 lastPosition_{0.0}, velocity_{0.0};
  Nanoseconds lastTime_ = 0;
};

}  // namespace nearfit
