#pragma once

#include <QString>

#include "device/interface/haptic_device.h"

namespace nearfit::desktop {

/// Tells the user in sentences what a device is doing.
/// @param isPushing  True if it can push.
/// @param note       HapticDevice::stateNote().
QString deviceText(DeviceState state, bool isPushing, const QString& note);

}  // namespace nearfit::desktop
