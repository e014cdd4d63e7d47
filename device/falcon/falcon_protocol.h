#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace nearfit::falcon {

/// Frames of the Novint Falcon's firmware, which answers each command with one report: 16 characters, `<`, 14
/// letters and `>`. A letter is 'A' plus four bits. Three 16-bit numbers take four letters each, lowest bits
/// first; then come the flags and an unused letter. No checksum. Pure; real-time safe.
/// Source: the protocol as libnifalcon documents it.

constexpr std::uint16_t kVendor = 0x0403, kProduct = 0xcb48;
constexpr std::size_t kFrameSize = 16;

/// Report::homed when every encoder has passed its index.
constexpr std::uint8_t kAllHomed = 7;

struct Report {
  std::array<std::int16_t, 3> encoders{};  ///< Counts from each encoder's index, once it is homed.
  std::uint8_t homed = 0;                  ///< Bit i: encoder i has passed its index since homing began.
  std::uint8_t buttons = 0;                ///< The grip's four buttons.
  bool operator==(const Report&) const = default;
};

enum Light : std::uint8_t { kGreen = 2, kBlue = 4, kRed = 8 };

struct Command {
  std::array<std::int16_t, 3> torques{};  ///< In motor units.
  std::uint8_t lights = 0;                ///< Bits of Light.
  bool isHoming = false;                  ///< Search for the encoders' indexes.
  bool operator==(const Command&) const = default;
};

std::array<std::byte, kFrameSize> encode(const Command& command) noexcept;

/// Finds frames in a stream of bytes, however it is cut into packets. Real-time safe.
class FrameReader {
 public:
  /// Returns the report that `next` completes, if it completes one.
  std::optional<Report> take(std::byte next) noexcept;
  /// Returns the number of damaged frames so far, without a first one that was joined midway.
  std::uint64_t damaged() const noexcept { return damaged_; }

 private:
  std::array<std::uint8_t, kFrameSize> frame_{};
  std::size_t size_ = 0;
  std::uint64_t damaged_ = 0;
};

}  // namespace nearfit::falcon
