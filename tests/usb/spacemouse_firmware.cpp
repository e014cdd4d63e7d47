#include "tests/usb/spacemouse_firmware.h"

#include <initializer_list>

namespace nearfit::test {
namespace {

void append(std::vector<std::byte>& to, std::initializer_list<unsigned> values) {
  for (const unsigned value : values)
    to.push_back(static_cast<std::byte>(value));
}

/// Usage page generic desktop, multi-axis controller, an application and a physical collection, report 1,
/// logical and physical limits, units.
void beginAxes(std::vector<std::byte>& to) {
  append(to, {0x05, 0x01, 0x09, 0x08, 0xa1, 0x01, 0xa1, 0x00, 0x85, 0x01, 0x16, 0xa2, 0xfe,
              0x26, 0x5e, 0x01, 0x36, 0x88, 0xfa, 0x46, 0x78, 0x05, 0x55, 0x0c, 0x65, 0x11});
}

/// Report 3, buttons, padded to two bytes; report 4, the light, padded to one.
void endWithButtonsAndLight(std::vector<std::byte>& to, unsigned buttonCount) {
  append(to, {0xa1, 0x02, 0x85,        0x03, 0x05,        0x01, 0x05,
              0x09, 0x19, 0x01,        0x29, buttonCount, 0x15, 0x00,
              0x25, 0x01, 0x35,        0x00, 0x45,        0x01, 0x75,
              0x01, 0x95, buttonCount, 0x81, 0x02,        0x95, 16 - buttonCount,
              0x81, 0x03, 0xc0});
  append(to, {0xa1, 0x02, 0x85, 0x04, 0x05, 0x08, 0x09, 0x4b, 0x15, 0x00, 0x25, 0x01,
              0x95, 0x01, 0x75, 0x01, 0x91, 0x02, 0x95, 0x07, 0x91, 0x03, 0xc0, 0xc0});
}

}  // namespace

std::vector<std::byte> spaceNavigatorDescriptor() {
  std::vector<std::byte> bytes;
  beginAxes(bytes);
  append(bytes, {0x09, 0x30, 0x09, 0x31, 0x09, 0x32, 0x75, 0x10, 0x95, 0x03, 0x81, 0x06, 0xc0});
  append(bytes, {0xa1, 0x00, 0x85, 0x02, 0x09, 0x33, 0x09, 0x34, 0x09, 0x35, 0x75, 0x10, 0x95, 0x03, 0x81,
                 0x06, 0xc0});
  endWithButtonsAndLight(bytes, 2);
  return bytes;
}

std::vector<std::byte> spaceMouseProDescriptor() {
  std::vector<std::byte> bytes;
  beginAxes(bytes);
  append(bytes, {0x09, 0x30, 0x09, 0x31, 0x09, 0x32, 0x09, 0x33, 0x09, 0x34, 0x09, 0x35, 0x75, 0x10, 0x95,
                 0x06, 0x81, 0x06, 0xc0});
  endWithButtonsAndLight(bytes, 15);
  return bytes;
}

std::vector<std::byte> SpaceMouseFirmware::descriptor() const {
  return model_ == Model::Navigator ? spaceNavigatorDescriptor() : spaceMouseProDescriptor();
}

std::optional<std::vector<std::byte>> SpaceMouseFirmware::onRequest(std::uint8_t requestType,
                                                                    std::uint8_t request, std::uint16_t value,
                                                                    std::vector<std::byte> data) {
  constexpr std::uint8_t kGetDescriptor = 0x06, kSetReport = 0x09;
  if (requestType == 0x81 && request == kGetDescriptor && value == 0x2200) return descriptor();
  if (requestType == 0x21 && request == kSetReport && value == 0x0204 && data.size() == 2 &&
      data[0] == std::byte{4}) {
    isLit = (data[1] & std::byte{1}) != std::byte{0};
    return std::vector<std::byte>{};
  }
  return std::nullopt;
}

std::vector<std::vector<std::byte>> SpaceMouseFirmware::reports() const {
  const auto axes = [&](unsigned number, std::size_t first, std::size_t count) {
    std::vector<std::byte> report{static_cast<std::byte>(number)};
    for (std::size_t i = first; i < first + count; ++i) {
      const auto bits = static_cast<std::uint16_t>(counts[i]);
      append(report, {bits & 0xffU, static_cast<unsigned>(bits) >> 8U});
    }
    return report;
  };
  std::vector<std::vector<std::byte>> all;
  if (model_ == Model::Navigator) {
    all.push_back(axes(1, 0, 3));
    all.push_back(axes(2, 3, 3));
  } else {
    all.push_back(axes(1, 0, 6));
  }
  std::vector<std::byte> pressed;
  append(pressed, {3U, buttons & 0xffU, static_cast<unsigned>(buttons) >> 8U});
  all.push_back(pressed);
  return all;
}

}  // namespace nearfit::test
