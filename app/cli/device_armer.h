#pragma once

#include <string>

#include "device/haptic_device.h"

namespace nearfit::cli {

/// Arms a device once, as soon as it is ready: never again after it was stopped.
class DeviceArmer {
 public:
  /// @param device  Outlives this.
  DeviceArmer(HapticDevice& device, bool isWanted) : device_(device), isWanted_(isWanted) {}

  /// Controlling thread, now and then. Says on stderr, once, what the device waits for.
  /// @return Why the device refuses; empty: it does not.
  std::string look();
  bool hasArmed() const noexcept { return hasArmed_; }

 private:
  HapticDevice& device_;
  bool isWanted_, hasArmed_ = false, hasTold_ = false;
};

}  // namespace nearfit::cli
