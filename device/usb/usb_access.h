#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "device/interface/device_error.h"
#include "device/usb/usb_description.h"

namespace nearfit {

/// Result of usbAccess().
struct UsbAccess {
  std::optional<DeviceProblem> problem;  ///< Why not; empty if it could.
  std::string reason, remedy;            ///< Explain `problem`, worded as in an Error.
  std::string kernelDriver;              ///< Holds an interface now, and lets go on opening; may be empty.
};
/// Finds out whether a device could be opened, without disturbing it or its user.
UsbAccess usbAccess(const UsbDescription& device);

/// Return the device's own names, in printable ASCII; empty if it has none.
std::string usbProductName(const UsbDescription& device);
std::string usbMakerName(const UsbDescription& device);

/// Returns the path of the udev rules that let users open devices, installed or in the source tree. Throws
/// FileError if there are none.
std::string udevRulesFile();

/// Returns a one-line shell command that lets the user open devices. Throws as udevRulesFile() does.
std::string udevCommand();

}  // namespace nearfit
