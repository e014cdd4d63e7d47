#include "device/usb/usb_description.h"

#include <algorithm>

#include <fmt/format.h>

namespace nearfit {

const UsbEndpoint* UsbInterface::streaming(bool isIn) const noexcept {
  const auto found = std::find_if(endpoints.begin(), endpoints.end(), [&](const UsbEndpoint& endpoint) {
    return endpoint.isIn() == isIn &&
           (endpoint.type == UsbTransferType::Interrupt || endpoint.type == UsbTransferType::Bulk);
  });
  return found == endpoints.end() ? nullptr : &*found;
}

std::string UsbDescription::id() const {
  return fmt::format("{:04x}:{:04x}", vendor, product);
}

std::string UsbDescription::node() const {
  return fmt::format("/dev/bus/usb/{:03}/{:03}", bus, address);
}

std::string UsbDescription::place() const {
  std::string text = fmt::format("{}", bus);
  for (std::size_t i = 0; i < ports.size(); ++i)
    text += fmt::format("{}{}", i == 0 ? '-' : '.', ports[i]);
  return text;
}

const UsbInterface* UsbDescription::findInterface(std::uint8_t number) const noexcept {
  const auto found = std::find_if(interfaces.begin(), interfaces.end(),
                                  [&](const UsbInterface& each) { return each.number == number; });
  return found == interfaces.end() ? nullptr : &*found;
}

bool UsbDescription::isSamePlugging(const UsbDescription& other) const noexcept {
  return vendor == other.vendor && product == other.product && bus == other.bus && address == other.address &&
         ports == other.ports;
}

}  // namespace nearfit
