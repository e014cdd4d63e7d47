#pragma once

#include "device/interface/haptic_device.h"

namespace nearfit {

/// Base of devices that nobody arms, calibrates or resets, because they do not push or are simulated. start()
/// arms them, stop() disarms them; the calls below do nothing.
class PassiveDevice : public HapticDevice {
 public:
  void arm() final {}
  void disarm() noexcept final {}
  void calibrate() final {}
  void reset() final {}
};

}  // namespace nearfit
