#pragma once

#include <optional>

#include "device/haptic_device.h"

namespace nearfit::cli {

struct MonitorOptions {
  std::optional<double> seconds;  ///< Until interrupted otherwise.
  bool isJson = false;
  bool isCalibrating = false;  ///< See HapticDevice::calibrate.
  bool isArming = false;       ///< Forces go out, those of MonitorDamping, once the device is ready.
};

/// Shows a device's pose, rate, jitter, buttons and state as they are, and the force that it is told: one
/// line that is rewritten on a terminal, else a line now and then. Its forces are off but for MonitorOptions.
/// Throws Error, also when the device is lost.
void monitorDevice(HapticDevice& device, const MonitorOptions& options);

/// "ready".
const char* stateName(DeviceState state) noexcept;

}  // namespace nearfit::cli
