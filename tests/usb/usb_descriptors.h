#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/usb/usb_description.h"

namespace nearfit::test {

using Bytes = std::vector<std::byte>;

struct EmulatedInterface {
  std::uint8_t classCode = 0xff, subclass = 0, protocol = 0;
  struct Endpoint {
    std::uint8_t address = 0;
    UsbTransferType type = UsbTransferType::Interrupt;
    std::uint16_t maxPacket = 64;
    std::uint8_t interval = 4;  ///< As bInterval: at high speed 4 is a millisecond.
  };
  std::vector<Endpoint> endpoints;
  Bytes reportDescriptor = {};    ///< Of HID interfaces.
  std::string kernelDriver = {};  ///< What the system bound to it; empty for none.
};

/// What an emulated device says that it is.
struct EmulatedDescription {
  std::uint16_t vendor = 0x1209, product = 1, release = 0x0100;
  std::string manufacturer = "Nearfit", productName = "Emulated device", serial = "1";
  int speed = 480;  ///< As sysfs has it [Mbit/s].
  std::vector<EmulatedInterface> interfaces;
};

Bytes deviceDescriptor(const EmulatedDescription& device);
/// With interfaces, HID descriptors and endpoints; interfaces are numbered as they stand.
Bytes configurationDescriptor(const EmulatedDescription& device);
/// Answer to the standard request GET_DESCRIPTOR, of the device or an interface; nothing: stall.
std::optional<Bytes> descriptorFor(const EmulatedDescription& device, std::uint16_t value,
                                   std::uint16_t index);

/// The bytes of a text or of anything else that is copied bytewise.
Bytes bytesOf(std::span<const std::byte> data);

}  // namespace nearfit::test
