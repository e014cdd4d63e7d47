#include "device/usb/libusb_handles.h"

#include <array>
#include <cmath>

namespace nearfit::usb {
namespace {

struct ConfigFreer {
  void operator()(libusb_config_descriptor* config) const noexcept { libusb_free_config_descriptor(config); }
};
using Config = std::unique_ptr<libusb_config_descriptor, ConfigFreer>;

/// USB 2.0, 9.6.6: milliseconds up to full speed, from high speed on 125 us times a power of two.
double intervalOf(std::uint8_t interval, int speed) noexcept {
  if (interval == 0) return 0.0;
  return speed >= LIBUSB_SPEED_HIGH ? std::ldexp(125e-6, (interval > 16 ? 16 : interval) - 1)
                                    : 1e-3 * interval;
}

UsbEndpoint endpointOf(const libusb_endpoint_descriptor& from, int speed) noexcept {
  UsbEndpoint endpoint;
  endpoint.address = from.bEndpointAddress;
  endpoint.type = static_cast<UsbTransferType>(from.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK);
  // Bits 11 and 12 count additional packets per microframe.
  endpoint.maxPacket = static_cast<std::uint16_t>(from.wMaxPacketSize & 0x7ffU);
  if (endpoint.type == UsbTransferType::Interrupt) endpoint.interval = intervalOf(from.bInterval, speed);
  return endpoint;
}

std::vector<UsbInterface> interfacesOf(const libusb_config_descriptor& config, int speed) {
  std::vector<UsbInterface> interfaces;
  for (int i = 0; i < config.bNumInterfaces; ++i) {
    if (config.interface[i].num_altsetting < 1) continue;
    const libusb_interface_descriptor& from = config.interface[i].altsetting[0];
    UsbInterface& to = interfaces.emplace_back();
    to.number = from.bInterfaceNumber;
    to.classCode = from.bInterfaceClass;
    to.subclass = from.bInterfaceSubClass;
    to.protocol = from.bInterfaceProtocol;
    for (int e = 0; e < from.bNumEndpoints; ++e)
      to.endpoints.push_back(endpointOf(from.endpoint[e], speed));
  }
  return interfaces;
}

}  // namespace

DeviceList::DeviceList(libusb_context* context) {
  const ssize_t count = libusb_get_device_list(context, &devices_);
  if (count < 0) {
    const int code = static_cast<int>(count);
    throw DeviceError(problemOf(code), "USB", "its devices could not be listed: " + reasonOf(code));
  }
  count_ = static_cast<std::size_t>(count);
}

Context openContext() {
  libusb_context* context = nullptr;
  const int code = libusb_init(&context);
  if (code != 0) {
    throw DeviceError(problemOf(code), "USB", "it could not be started: " + reasonOf(code),
                      "check that /dev/bus/usb exists");
  }
  return Context(context);
}

std::optional<UsbDescription> describe(libusb_device* device) {
  libusb_device_descriptor from;
  if (libusb_get_device_descriptor(device, &from) != 0) return std::nullopt;
  UsbDescription to;
  to.vendor = from.idVendor;
  to.product = from.idProduct;
  to.release = from.bcdDevice;
  to.bus = libusb_get_bus_number(device);
  to.address = libusb_get_device_address(device);
  std::array<std::uint8_t, 7> ports{};  // USB 3.0, 10: at most seven tiers.
  const int count = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  if (count > 0) to.ports.assign(ports.begin(), ports.begin() + count);
  libusb_config_descriptor* config = nullptr;
  if (libusb_get_active_config_descriptor(device, &config) == 0) {
    const Config owner(config);
    to.interfaces = interfacesOf(*config, libusb_get_device_speed(device));
  }
  return to;
}

DeviceProblem problemOf(int code) noexcept {
  switch (code) {
    case LIBUSB_ERROR_ACCESS:
      return DeviceProblem::NoPermission;
    case LIBUSB_ERROR_BUSY:
      return DeviceProblem::Busy;
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return DeviceProblem::Gone;
    case LIBUSB_ERROR_NOT_SUPPORTED:
      return DeviceProblem::Unsupported;
    case LIBUSB_ERROR_TIMEOUT:
    case LIBUSB_ERROR_PIPE:
      return DeviceProblem::NotAnswering;
    default:
      return DeviceProblem::Failed;
  }
}

std::string reasonOf(int code) {
  return std::string(libusb_strerror(code)) + " (" + libusb_error_name(code) + ")";
}

}  // namespace nearfit::usb
