#pragma once

#include <memory>
#include <optional>
#include <string>

#include <libusb.h>

#include "device/interface/device_error.h"
#include "device/usb/usb_description.h"

/// Owning handles for libusb. Only for the .cpp files of this folder: nothing else sees libusb.
namespace nearfit::usb {

struct ContextCloser {
  void operator()(libusb_context* context) const noexcept { libusb_exit(context); }
};
using Context = std::unique_ptr<libusb_context, ContextCloser>;

struct HandleCloser {
  void operator()(libusb_device_handle* handle) const noexcept { libusb_close(handle); }
};
using Handle = std::unique_ptr<libusb_device_handle, HandleCloser>;

struct TransferFreer {
  void operator()(libusb_transfer* transfer) const noexcept { libusb_free_transfer(transfer); }
};
using Transfer = std::unique_ptr<libusb_transfer, TransferFreer>;

/// All devices that a context sees; references them while it lives.
class DeviceList {
 public:
  /// Throws DeviceError.
  explicit DeviceList(libusb_context* context);
  ~DeviceList() { libusb_free_device_list(devices_, 1); }
  DeviceList(const DeviceList&) = delete;
  DeviceList& operator=(const DeviceList&) = delete;

  libusb_device** begin() const noexcept { return devices_; }
  libusb_device** end() const noexcept { return devices_ + count_; }

 private:
  libusb_device** devices_ = nullptr;
  std::size_t count_ = 0;
};

/// Starts libusb. Throws DeviceError if that fails.
Context openContext();

/// Reads a device's descriptors; std::nullopt if that fails, most likely because it is being unplugged.
std::optional<UsbDescription> describe(libusb_device* device);

/// Returns the DeviceProblem that a libusb error stands for.
/// @param code  libusb error, < 0.
DeviceProblem problemOf(int code) noexcept;
/// Returns libusb's own description of an error.
std::string reasonOf(int code);

}  // namespace nearfit::usb
