#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace nearfit::polhem {

/// Reports of WoodenHaptics and Polhem (HID without report numbers): seven little-endian 16-bit numbers each
/// way. The device answers each command with a report. Its watchdog rests the motors after half a second
/// without a command. Pure; real-time safe.
/// Source: the makers' open firmware and API (Forsslund Systems), read for the format.

constexpr std::uint16_t kVendor = 0x1234, kProduct = 0x0006;
/// Any Teensy that speaks raw HID, whatever it is used for.
constexpr std::uint16_t kTeensyVendor = 0x16c0, kTeensyProduct = 0x0486;

constexpr std::size_t kPacketSize = 14;
constexpr std::size_t kRawHidSize = 64;  ///< Teensy packets, both ways: the same content, then zeros.

struct Report {
  std::array<std::int16_t, 6> encoders{};  ///< Counts since switch-on; they wrap.
  bool isButtonPressed = false;            ///< The calibration button was pressed since switch-on.
  bool operator==(const Report&) const = default;
};

/// Returns std::nullopt for a packet of another size.
std::optional<Report> decode(std::span<const std::byte> packet) noexcept;

/// The amplifiers bear no more for long [mA].
constexpr int kMaxMilliamps = 2000;

/// Returns the command for these motor currents, each clamped to kMaxMilliamps; padded with zeros to
/// a Teensy's packet.
std::array<std::byte, kRawHidSize> encode(const std::array<int, 3>& milliamps) noexcept;

}  // namespace nearfit::polhem
