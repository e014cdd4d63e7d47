#pragma once

#include <string>

#include "device/interface/haptic_device.h"

namespace nearfit::cli {

/// Arms a device once, as soon as it is ready; never again after it was stopped.
class DeviceArmer {
 public:
  /// @param device    Must outlive this.
  /// @param isWanted  False: never arms.
  DeviceArmer(HapticDevice& device, bool isWanted) : device_(device), isWanted_(isWanted) {}

  /// Arms the device if it is ready. Prints to stderr, once, what an uncalibrated device waits for. Call it
  /// now and then on the controlling thread. Returns why the device refuses; empty if it does not.
  std::string poll();
  bool hasArmed() const noexcept { return hasArmed_; }

 private:
  HapticDevice& device_;
  bool isWanted_, hasArmed_ = false, hasTold_ = false;
};

}  // namespace nearfit::cli
