#pragma once

#include <QString>

#include "device/haptic_device.h"

namespace nearfit::desktop {

/// What a device is doing, as sentences for its user.
/// @param isPushing  It can push.
/// @param note       HapticDevice::stateNote.
QString deviceText(DeviceState state, bool isPushing, const QString& note);

}  // namespace nearfit::desktop
