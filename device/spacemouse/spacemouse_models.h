#pragma once

#include <optional>
#include <vector>

#include "device/interface/device_error.h"
#include "device/usb/usb_description.h"

namespace nearfit::spacemouse {

/// True if 3Dconnexion made it, under its own or Logitech's name, and it sends reports. Not all of these are
/// space mice: see whyNone().
bool isOfMaker(const UsbDescription& device) noexcept;

/// True if its USB ID is known to have six axes.
bool isKnownModel(const UsbDescription& device) noexcept;

/// Returns the interfaces that may have the six axes, the likeliest first. Leaves out those that declare
/// themselves a mouse or keyboard, and those that the system knows to lack an axis: opening one takes it from
/// the desktop. Pointers refer into `device`.
std::vector<const UsbInterface*> candidates(const UsbDescription& device);

/// Returns why it is not a space mouse, as far as that shows without opening it;
/// std::nullopt if it may be one.
std::optional<DeviceRefusal> whyNone(const UsbDescription& device);

/// Returns the refusal for a device that had no six axes when opened.
DeviceRefusal noSixAxes();

}  // namespace nearfit::spacemouse
