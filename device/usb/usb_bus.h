#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "device/usb/usb_description.h"

namespace nearfit {

/// The USB devices of this machine, and when they come and go. One controlling thread.
class UsbBus {
 public:
  /// Throws DeviceError when libusb or its thread cannot be had.
  UsbBus();
  ~UsbBus();
  UsbBus(const UsbBus&) = delete;
  UsbBus& operator=(const UsbBus&) = delete;

  /// All devices that are plugged in, by bus and address. One whose descriptors cannot be read is left out:
  /// that happens while it is being unplugged. Throws DeviceError.
  std::vector<UsbDescription> list() const;

  /// True when the system tells of devices that come and go; else list() has to be asked from time to time.
  bool tellsOfChanges() const noexcept;
  /// Rises each time that one comes or goes. Any thread.
  std::uint64_t changes() const noexcept;

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace nearfit
