#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace nearfit::polhem {

/// The reports of WoodenHaptics and Polhem (HID, no report numbers): seven numbers of 16 bits each way,
/// little end first. The device answers each command with a report. It has a watchdog: without a command for
/// half a second its motors rest. Pure; real-time safe. Source: the makers' open firmware and API (Forsslund
/// Systems), read for the format.

constexpr std::uint16_t kVendor = 0x1234, kProduct = 0x0006;
/// Of any Teensy that speaks raw HID, whatever it is for.
constexpr std::uint16_t kTeensyVendor = 0x16c0, kTeensyProduct = 0x0486;

constexpr std::size_t kPacketSize = 14;
constexpr std::size_t kRawHidSize = 64;  ///< Of a Teensy's packets, either way: the same, then zeros.

struct Report {
  std::array<std::int16_t, 6> encoders{};  ///< Counts since the device was switched on; they wrap.
  bool isButtonPressed = false;            ///< Its calibration button was, since it was switched on.
  bool operator==(const Report&) const = default;
};

/// Nothing where it is of another size.
std::optional<Report> decode(std::span<const std::byte> packet) noexcept;

/// Its amplifiers bear no more for long [mA].
constexpr int kMostMilliamps = 2000;

/// The command that drives the motors, cut to kMostMilliamps each; zeros up to a Teensy's size.
std::array<std::byte, kRawHidSize> encode(const std::array<int, 3>& milliamps) noexcept;

}  // namespace nearfit::polhem
