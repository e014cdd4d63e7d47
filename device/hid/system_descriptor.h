#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "device/usb/usb_description.h"

namespace nearfit {

/// The HID report descriptor of an interface as the system's own driver has read it: a look that opens
/// nothing and takes nothing from anybody. Nothing where no such driver is bound to it. May allocate.
std::optional<std::vector<std::byte>> systemReportDescriptor(const UsbDescription& device,
                                                             std::uint8_t interfaceNumber);

}  // namespace nearfit
