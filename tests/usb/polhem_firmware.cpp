#include "tests/usb/polhem_firmware.h"

namespace nearfit::test {
namespace {

int wordAt(std::span<const std::byte> packet, std::size_t index) {
  const int low = std::to_integer<int>(packet[2 * index]), high = std::to_integer<int>(packet[2 * index + 1]);
  const int word = low + 256 * high;
  return word >= 32768 ? word - 65536 : word;
}

}  // namespace

void PolhemFirmware::onPacket(std::span<const std::byte> packet) {
  if (packet.size() != packetSize_) {
    ++ignored_;
    return;
  }
  ++accepted_;
  // Command 1 sets the counters; all else are currents.
  if (wordAt(packet, 3) == 1) {
    for (std::size_t i = 0; i < 3; ++i) {
      counts[i] = wordAt(packet, 4 + i);
      counts[3 + i] = wordAt(packet, i);
    }
    isButtonFlagged = false;
    milliamps_ = {};
    return;
  }
  for (std::size_t i = 0; i < milliamps_.size(); ++i)
    milliamps_[i] = wordAt(packet, i);
}

std::vector<std::byte> PolhemFirmware::report() const {
  std::vector<std::byte> packet;
  const auto put = [&](int word) {
    packet.push_back(static_cast<std::byte>(word & 0xff));
    packet.push_back(static_cast<std::byte>(word >> 8 & 0xff));
  };
  for (const int count : counts)
    put(count);
  put(isButtonFlagged ? 1 : 0);
  packet.resize(packetSize_);
  return packet;
}

void PolhemFirmware::powerOff() {
  counts = {};
  isButtonFlagged = false;
  milliamps_ = {};
}

}  // namespace nearfit::test
