#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "device/usb/usb_description.h"

namespace nearfit {

/// The USB devices of this machine, and their coming and going. One controlling thread.
class UsbBus {
 public:
  /// Throws DeviceError if libusb or its thread cannot start.
  UsbBus();
  ~UsbBus();
  UsbBus(const UsbBus&) = delete;
  UsbBus& operator=(const UsbBus&) = delete;

  /// Returns all devices that are plugged in, by bus and address. Leaves out those whose descriptors cannot
  /// be read, as happens during unplugging. Throws DeviceError.
  std::vector<UsbDescription> list() const;

  /// True if the system announces changes; otherwise list() must be polled.
  bool tellsOfChanges() const noexcept;
  /// Returns the number of changes so far. Any thread.
  std::uint64_t changes() const noexcept;

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace nearfit
