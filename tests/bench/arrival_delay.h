#pragma once

#include "device/servo/servo_loop.h"

namespace nearfit::bench {

/// Ticks until the servo has what another thread searched for, from when that may begin. As SceneRefresher
/// has it: it looks for a pose four times a tick, and may wait for its turn.
/// @param searchTime  [s]
inline double arrivalDelay(double searchTime) {
  constexpr double kWakeUp = 0.5;
  return kWakeUp + searchTime / ServoLoop::kPeriod;
}

}  // namespace nearfit::bench
