#pragma once

#include "core/haptics/wrench.h"

namespace nearfit {

/// Limits of what is sent to a device; finite, >= 0.
struct WrenchLimits {
  double maxForce = 10.0;  ///< [N]
  double maxTorque = 1.0;  ///< [N m]
};

struct LimitedWrench {
  Wrench wrench;
  bool isClamped = false;  ///< The force, the torque or both were scaled down.
};

/// Scales force and torque, each by itself, down to its limit; directions stay as they are.
/// @param wrench  Finite.
/// Real-time safe.
LimitedWrench limitWrench(const Wrench& wrench, const WrenchLimits& limits) noexcept;

}  // namespace nearfit
