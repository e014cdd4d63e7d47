#pragma once

#include <memory>
#include <optional>
#include <string>

#include <libusb.h>

#include "device/device_error.h"
#include "device/usb/usb_description.h"

/// libusb's handles with an owner. For the .cpp files of this folder alone: nothing else sees libusb.
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

/// All devices that a context sees, referenced as long as this lives.
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

/// Throws DeviceError when libusb cannot start.
Context openContext();

/// Nothing when its descriptors cannot be read: it is being unplugged, most likely.
std::optional<UsbDescription> describe(libusb_device* device);

/// @param code  Of libusb, < 0.
DeviceProblem problemOf(int code) noexcept;
/// What libusb calls it, in words.
std::string reasonOf(int code);

}  // namespace nearfit::usb
