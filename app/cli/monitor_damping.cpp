#include "app/cli/monitor_damping.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace nearfit::cli {

Wrench MonitorDamping::step(const HandleInput& handle, bool isArmed, Nanoseconds now) noexcept {
  const auto age = static_cast<Nanoseconds>(std::clamp(handle.age, 0.0, 1.0) * 1e9);
  const glm::dvec3 velocity = velocity_.update(handle.pose.translation, now - age);
  if (!isArmed || !handle.isArmed || handle.isClutched) {
    pushingSince_ = 0;
    return {};
  }
  if (pushingSince_ == 0) pushingSince_ = now;
  const double speed = glm::length(velocity);
  // NaN gives no force.
  if (!(speed > 0.0 && speed < kNoneFrom) || !(handle.age <= kFresh)) return {};
  const double in = std::min(toSeconds(now - pushingSince_) / kFadeIn, 1.0);
  const double slow = std::clamp((kNoneFrom - speed) / (kNoneFrom - kAllUpTo), 0.0, 1.0);
  const double size = in * slow * std::min(kDamping * speed, kMax);
  return {-size / speed * velocity, glm::dvec3(0.0)};
}

}  // namespace nearfit::cli
