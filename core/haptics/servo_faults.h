#pragma once

#include "core/haptics/device_limits.h"
#include "core/haptics/haptic_settings.h"
#include "core/haptics/servo_snapshot.h"

namespace nearfit {

/// Whether a pose is finite and its quaternion near enough to unit length to be meant as a rotation.
bool isPose(const RigidTransform& pose) noexcept;

/// What is wrong with what goes into a tick. Real-time safe.
ServoFault faultOfInput(const HapticSettings& settings, const DeviceLimits& limits,
                        const RigidTransform& devicePose, double period) noexcept;

}  // namespace nearfit
