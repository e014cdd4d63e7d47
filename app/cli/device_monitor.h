#pragma once

#include <optional>

#include "device/interface/haptic_device.h"

namespace nearfit::cli {

struct MonitorOptions {
  std::optional<double> seconds;  ///< Duration [s]; empty: until interrupted.
  bool isJson = false;
  bool isCalibrating = false;  ///< See HapticDevice::calibrate().
  bool isArming = false;       ///< Arms the device once it is ready: forces of MonitorDamping go out.
};

/// Shows a device's pose, rate, jitter, buttons and state, and the force sent to it: one line that is
/// rewritten on a terminal, else a line every half second. Forces are off unless `isArming`. Throws Error,
/// also if the device is lost.
void monitorDevice(HapticDevice& device, const MonitorOptions& options);

/// Returns the name of a state, such as "ready".
const char* stateName(DeviceState state) noexcept;

}  // namespace nearfit::cli
