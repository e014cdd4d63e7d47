#pragma once

#include <filesystem>

#include "device/interface/haptic_device.h"

namespace nearfit::cli {

struct DeviceTestOptions {
  bool hasConsent = false;  ///< Allows forces; if false, a user at a terminal is asked.
  bool isJson = false;
  bool isCalibrating = false;  ///< See HapticDevice::calibrate().
  /// Where a report for others goes (writeDeviceReport()); empty for none. The test is longer then: noise at rest, axes
  /// by motions that a user at a terminal is asked for, and forces from 0.1 N on.
  std::filesystem::path report = {};
  /// With a report, forces follow only if each axis passed. True: also if nobody is at a terminal to be asked.
  bool allowsUnjudgedAxes = false;
};

/// Tests a device: opens it, watches its reports and poses and, with consent, arms it and pushes gently along
/// each axis, with motors for torque also about each. Prints for each step whether it passed. Always turns forces off and closes the device. Throws
/// Error if a step failed.
void testDevice(HapticDevice& device, const DeviceTestOptions& options);

}  // namespace nearfit::cli
