#include "tests/usb/usb_descriptors.h"

#include <array>

namespace nearfit::test {
namespace {

/// USB 2.0, 9.4; HID 1.11, 7.1.
enum DescriptorType : std::uint8_t {
  kDevice = 1,
  kConfiguration = 2,
  kString = 3,
  kInterface = 4,
  kEndpoint = 5,
  kHid = 0x21,
  kHidReport = 0x22,
};
constexpr std::uint16_t kEnglish = 0x0409;

void put8(Bytes& to, unsigned value) {
  to.push_back(static_cast<std::byte>(value));
}

void put16(Bytes& to, unsigned value) {
  put8(to, value & 0xffU);
  put8(to, value >> 8U);
}

Bytes hidDescriptor(const EmulatedInterface& face) {
  Bytes bytes;
  put8(bytes, 9);
  put8(bytes, kHid);
  put16(bytes, 0x0111);
  put8(bytes, 0);  // No country.
  put8(bytes, 1);
  put8(bytes, kHidReport);
  put16(bytes, static_cast<unsigned>(face.reportDescriptor.size()));
  return bytes;
}

void putInterface(Bytes& to, const EmulatedInterface& face, unsigned number) {
  put8(to, 9);
  put8(to, kInterface);
  put8(to, number);
  put8(to, 0);
  put8(to, static_cast<unsigned>(face.endpoints.size()));
  put8(to, face.classCode);
  put8(to, face.subclass);
  put8(to, face.protocol);
  put8(to, 0);
  if (!face.reportDescriptor.empty()) {
    const Bytes hid = hidDescriptor(face);
    to.insert(to.end(), hid.begin(), hid.end());
  }
  for (const EmulatedInterface::Endpoint& endpoint : face.endpoints) {
    put8(to, 7);
    put8(to, kEndpoint);
    put8(to, endpoint.address);
    put8(to, static_cast<unsigned>(endpoint.type));
    put16(to, endpoint.maxPacket);
    put8(to, endpoint.interval);
  }
}

Bytes stringDescriptor(const std::string& ascii) {
  Bytes bytes;
  put8(bytes, 2 + 2 * static_cast<unsigned>(ascii.size()));
  put8(bytes, kString);
  for (const char c : ascii)
    put16(bytes, static_cast<unsigned char>(c));
  return bytes;
}

Bytes languages() {
  Bytes bytes;
  put8(bytes, 4);
  put8(bytes, kString);
  put16(bytes, kEnglish);
  return bytes;
}

}  // namespace

Bytes bytesOf(std::span<const std::byte> data) {
  return {data.begin(), data.end()};
}

Bytes deviceDescriptor(const EmulatedDescription& device) {
  Bytes bytes;
  put8(bytes, 18);
  put8(bytes, kDevice);
  put16(bytes, 0x0200);
  for (int i = 0; i < 3; ++i)
    put8(bytes, 0);  // Class, subclass and protocol are the interfaces'.
  put8(bytes, 64);
  put16(bytes, device.vendor);
  put16(bytes, device.product);
  put16(bytes, device.release);
  for (const unsigned index : {1U, 2U, 3U})
    put8(bytes, index);
  put8(bytes, 1);
  return bytes;
}

Bytes configurationDescriptor(const EmulatedDescription& device) {
  Bytes faces;
  for (std::size_t i = 0; i < device.interfaces.size(); ++i)
    putInterface(faces, device.interfaces[i], static_cast<unsigned>(i));
  Bytes bytes;
  put8(bytes, 9);
  put8(bytes, kConfiguration);
  put16(bytes, static_cast<unsigned>(9 + faces.size()));
  put8(bytes, static_cast<unsigned>(device.interfaces.size()));
  put8(bytes, 1);
  put8(bytes, 0);
  put8(bytes, 0x80);
  put8(bytes, 250);  // 500 mA.
  bytes.insert(bytes.end(), faces.begin(), faces.end());
  return bytes;
}

std::optional<Bytes> descriptorFor(const EmulatedDescription& device, std::uint16_t value,
                                   std::uint16_t index) {
  const unsigned type = value >> 8U, number = value & 0xffU;
  switch (type) {
    case kDevice:
      return deviceDescriptor(device);
    case kConfiguration:
      return configurationDescriptor(device);
    case kString: {
      if (number == 0) return languages();
      const std::array<std::string, 3> strings = {device.manufacturer, device.productName, device.serial};
      if (number > strings.size()) return std::nullopt;
      return stringDescriptor(strings.at(number - 1));
    }
    case kHid:
    case kHidReport: {
      if (index >= device.interfaces.size()) return std::nullopt;
      const EmulatedInterface& face = device.interfaces[index];
      if (face.reportDescriptor.empty()) return std::nullopt;
      return type == kHid ? hidDescriptor(face) : face.reportDescriptor;
    }
    default:
      return std::nullopt;
  }
}

}  // namespace nearfit::test
