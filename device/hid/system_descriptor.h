#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "device/usb/usb_description.h"

namespace nearfit {

/// Returns an interface's HID report descriptor as read by the kernel's own driver; opens nothing and
/// disturbs nobody. Returns std::nullopt if no such driver is bound. May allocate.
std::optional<std::vector<std::byte>> systemReportDescriptor(const UsbDescription& device,
                                                             std::uint8_t interfaceNumber);

}  // namespace nearfit
