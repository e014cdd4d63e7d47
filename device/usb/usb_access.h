#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "device/device_error.h"
#include "device/usb/usb_description.h"

namespace nearfit {

/// Whether a device could be opened now, found out without disturbing it or whoever uses it.
struct UsbAccess {
  std::optional<DeviceProblem> problem;  ///< None: it could.
  std::string reason, remedy;            ///< As of an Error.
  std::string kernelDriver;  ///< That holds one of its interfaces, and lets go when it is opened; or empty.
};
UsbAccess usbAccess(const UsbDescription& device);

/// As it calls itself, printable ASCII; empty where it does not say.
std::string usbProductName(const UsbDescription& device);
std::string usbMakerName(const UsbDescription& device);

}  // namespace nearfit
