#pragma once

#include "device/interface/haptic_device.h"

namespace nearfit::cli {

struct DeviceTestOptions {
  bool hasConsent = false;  ///< Allows forces; if false, a user at a terminal is asked.
  bool isJson = false;
  bool isCalibrating = false;  ///< See HapticDevice::calibrate().
};

/// Tests a device: opens it, watches its reports and poses and, with consent, arms it and pushes gently along
/// each axis. Prints for each step whether it passed. Always turns forces off and closes the device. Throws
/// Error if a step failed.
void testDevice(HapticDevice& device, const DeviceTestOptions& options);

}  // namespace nearfit::cli
