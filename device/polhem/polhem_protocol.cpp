#include "device/polhem/polhem_protocol.h"

#include <algorithm>

namespace nearfit::polhem {
namespace {

std::int16_t wordAt(std::span<const std::byte> packet, std::size_t index) noexcept {
  const auto low = std::to_integer<std::uint16_t>(packet[2 * index]);
  const auto high = std::to_integer<std::uint16_t>(packet[2 * index + 1]);
  return static_cast<std::int16_t>(low | high << 8U);
}

}  // namespace

std::optional<Report> decode(std::span<const std::byte> packet) noexcept {
  if (packet.size() != kPacketSize && packet.size() != kRawHidSize) return std::nullopt;
  Report report;
  for (std::size_t i = 0; i < report.encoders.size(); ++i)
    report.encoders[i] = wordAt(packet, i);
  report.isButtonPressed = wordAt(packet, report.encoders.size()) == 1;
  return report;
}

std::array<std::byte, kRawHidSize> encode(const std::array<int, 3>& milliamps) noexcept {
  // The fourth number is the command: 0 sets currents. The rest are arguments, of which it has none.
  std::array<std::byte, kRawHidSize> packet{};
  for (std::size_t i = 0; i < milliamps.size(); ++i) {
    const auto word = static_cast<std::uint16_t>(std::clamp(milliamps[i], -kMaxMilliamps, kMaxMilliamps));
    packet[2 * i] = static_cast<std::byte>(word & 0xffU);
    packet[2 * i + 1] = static_cast<std::byte>(word >> 8U);
  }
  return packet;
}

}  // namespace nearfit::polhem
