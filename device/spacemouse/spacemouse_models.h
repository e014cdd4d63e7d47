#pragma once

#include <optional>
#include <vector>

#include "device/device_error.h"
#include "device/usb/usb_description.h"

namespace nearfit::spacemouse {

/// Whether 3Dconnexion made it and it has something to say; also of the years when Logitech's name was on its
/// devices. Not all of those are space mice: see whyNone.
bool isOfMaker(const UsbDescription& device) noexcept;

/// Known by its number to have six axes.
bool isKnownModel(const UsbDescription& device) noexcept;

/// Interfaces that may have the six axes, the likeliest first. Those that say that they are a mouse or a
/// keyboard, and those of which the system knows that they lack an axis, are left alone: opening one takes it
/// from the user's desktop.
std::vector<const UsbInterface*> candidates(const UsbDescription& device);

/// Why it is no space mouse, as far as that shows without its being opened; nothing when it may be one.
std::optional<DeviceRefusal> whyNone(const UsbDescription& device);

/// For those that proved to have none once they were open.
DeviceRefusal noSixAxes();

}  // namespace nearfit::spacemouse
