#pragma once

#include <optional>

#include "core/haptics/handle_input.h"
#include "core/haptics/wrench.h"
#include "device/common/velocity_filter.h"
#include "device/interface/haptic_device.h"
#include "device/thread/monotonic_clock.h"

namespace nearfit::cli {

/// A weak resistance to motion, as if the handle moved in syrup, so that a monitor has a force to show.
///
/// It fades in each time that the device begins to push. It only takes energy out as long as the device
/// measures correctly. If the device does not (a joint that counts backwards), the force is at most kMax,
/// and zero above kNoneFrom.
class MonitorDamping {
 public:
  static constexpr double kDamping = 2.0;  ///< Similar to the damping of devices themselves [N s/m].
  static constexpr double kMax = 0.5;      ///< Largest force, the same as that of --test [N].
  /// Speeds between which the force fades; a hand at a monitor is slower [m/s].
  static constexpr double kAllUpTo = 0.4, kNoneFrom = 0.6;
  static constexpr double kFadeIn = 1.0;  ///< Time to fade in [s].
  /// Older poses say nothing about the speed now [s].
  static constexpr double kFresh = 5e-3;

  /// Returns the wrench to send, in the device's frame; zero if the device does not push.
  Wrench step(const HandleInput& handle, bool isArmed, Nanoseconds now) noexcept;

 private:
  VelocityFilter velocity_;
  Nanoseconds pushingSince_ = 0;
};

struct MonitorOptions {
  std::optional<double> seconds;  ///< Duration [s]; empty: until interrupted.
  bool isJson = false;
  bool isCalibrating = false;  ///< See HapticDevice::calibrate().
  bool isArming = false;       ///< Arms the device once it is ready: forces of MonitorDamping go out.
};

/// Shows a device's pose, rate, jitter, buttons, grip and state, and the force sent to it: one line that is
/// rewritten on a terminal, else a line every half second. Forces are off unless `isArming`. Throws Error,
/// also if the device is lost.
void monitorDevice(HapticDevice& device, const MonitorOptions& options);

/// Returns the name of a state, such as "ready".
const char* stateName(DeviceState state) noexcept;

}  // namespace nearfit::cli
