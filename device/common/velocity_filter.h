#pragma once

#include <cmath>

#include <glm/vec3.hpp>

#include "device/thread/monotonic_clock.h"

namespace nearfit {

/// Estimates the velocity of a handle from positions: differences, smoothed over kTime. Reports that arrive
/// late and all at once do not look fast, since each counts by how far the handle went. Real-time safe.
class VelocityFilter {
 public:
  /// Longer than a few reports, to even out an encoder's steps; far shorter than a hand's motion [s].
  static constexpr double kTime = 4e-3;

  /// Adds a position [m] and returns the velocity now [m/s].
  /// @param time  Arrival of the report.
  glm::dvec3 update(const glm::dvec3& position, Nanoseconds time) noexcept {
    if (hasLast_) {
      // A first-order lag of the velocity, which is constant between reports, integrated exactly.
      const double passed = std::fmax(toSeconds(time - lastTime_), 0.0);
      const double decay = std::exp(-passed / kTime);
      const double weight = passed > kMin ? (1.0 - decay) / passed : 1.0 / kTime;
      velocity_ = decay * velocity_ + weight * (position - lastPosition_);
    }
    hasLast_ = true;
    lastPosition_ = position;
    lastTime_ = time;
    return velocity_;
  }
  /// Forgets all positions.
  void reset() noexcept { *this = {}; }

 private:
  /// For shorter times the quotient equals its limit to rounding [s].
  static constexpr double kMin = 1e-9;

  bool hasLast_ = false;
  glm::dvec3 lastPosition_{0.0}, velocity_{0.0};
  Nanoseconds lastTime_ = 0;
};

}  // namespace nearfit
