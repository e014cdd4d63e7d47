#pragma once

#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "app/cli/device_report.h"
#include "app/cli/ticked_device.h"
#include "device/interface/haptic_device.h"
#include "device/thread/monotonic_clock.h"

namespace nearfit::cli {

/// Measures the speed of a handle from its places or turns.
class SpeedMeter {
 public:
  /// Returns the speed [m/s], [rad/s]; the last one if too little time has passed.
  double see(const glm::dvec3& place, Nanoseconds now) noexcept {
    const double time = toSeconds(now - time_);
    if (time_ == 0 || time >= kShortest) {
      if (time_ != 0) speed_ = glm::length(place - place_) / time;
      place_ = place;
      time_ = now;
    }
    return speed_;
  }

 private:
  static constexpr double kShortest = 0.01;  ///< [s]; two reports may come at once.

  glm::dvec3 place_{0.0};
  Nanoseconds time_ = 0;
  double speed_ = 0.0;
};

/// A push along an axis, or a torque about one, in the device's frame.
struct DevicePush {
  std::string name;
  glm::dvec3 axis;    ///< Unit.
  double size = 0.0;  ///< Its peak [N], [N m].
  bool isTurn = false;
};

/// Returns the strongest push and torque of a test [N], [N m]: felt, and dangerous to nobody. 0 without motors for it.
double testForceOf(const DeviceInfo& info);
double testTorqueOf(const DeviceInfo& info);

/// Returns the pushes of a test, in order: along each axis, then about each axis if the device has motors for torque.
/// @param isGradual  Of a device that nobody has felt yet: begins with small ones.
std::vector<DevicePush> pushesOf(const DeviceInfo& info, bool isGradual);

/// Pushes, rising and falling smoothly within a second. Failed, and at once without force, if the handle runs away or the
/// device stops; failed too if the handle clearly moved against the push. The device must be armed.
TestStep pushHandle(TickedDevice& ticked, const DevicePush& push);

/// Measures the time from a force until the pose moves: of motors, mechanics and link. Skipped if the handle is held too
/// firmly to tell. The device must be armed.
/// @param force  Sudden, to and fro along x [N].
/// @param noise  Of the pose at rest, rms [m].
TestStep measureLatency(TickedDevice& ticked, double force, double noise);

}  // namespace nearfit::cli
