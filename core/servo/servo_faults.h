#pragma once

#include "core/haptics/device_limits.h"
#include "core/haptics/haptic_settings.h"
#include "core/servo/servo_snapshot.h"

namespace nearfit {

/// True if the pose is finite and its quaternion close enough to unit length (0.5 to 2) to mean a rotation.
/// Real-time safe.
bool isPose(const RigidTransform& pose) noexcept;

/// The fault in the inputs of a tick, or None. Real-time safe.
/// @param period  Since the last tick [s].
ServoFault faultOfInput(const HapticSettings& settings, const DeviceLimits& limits,
                        const RigidTransform& devicePose, double period) noexcept;

}  // namespace nearfit
