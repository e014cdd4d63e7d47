#pragma once

#include "device/haptic_device.h"

namespace nearfit {

/// A device that nobody arms, calibrates or resets: it does not push, or it is a hand of the program's own,
/// and it is armed from its start to its end. What is asked of that sort does nothing.
class PassiveDevice : public HapticDevice {
 public:
  void arm() final {}
  void disarm() noexcept final {}
  void calibrate() final {}
  void reset() final {}
};

}  // namespace nearfit
