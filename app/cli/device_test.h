#pragma once

#include "device/haptic_device.h"

namespace nearfit::cli {

struct DeviceTestOptions {
  bool hasConsent = false;  ///< Forces may go out; else the user is asked, where there is a terminal.
  bool isJson = false;
  bool isCalibrating = false;  ///< See HapticDevice::calibrate.
};

/// Opens a device, looks at its reports and poses, and if the user agrees arms it and pushes gently along
/// each axis; says of each step whether it passed. Forces end and the device is closed however this ends.
/// Throws Error when a step has failed.
void testDevice(HapticDevice& device, const DeviceTestOptions& options);

}  // namespace nearfit::cli
