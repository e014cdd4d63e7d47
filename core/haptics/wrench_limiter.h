#pragma once

#include "core/haptics/device_limits.h"
#include "core/haptics/wrench.h"

namespace nearfit {

struct LimitedWrench {
  Wrench wrench;
  bool isClamped = false;  ///< The force, the torque or both were scaled down.
};

/// Scales force and torque, each by itself, down to its limit; directions stay as they are.
/// @param wrench  Finite.
/// Real-time safe.
LimitedWrench limitWrench(const Wrench& wrench, const DeviceLimits& limits) noexcept;

}  // namespace nearfit
