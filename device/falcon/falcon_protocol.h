#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace nearfit::falcon {

/// The frames that the Novint Falcon's firmware takes and answers, one for one: 16 characters, `<` and 14
/// letters and `>`. A letter is 'A' plus four bits; three numbers of 16 bits are four letters each, the
/// lowest bits first; then the flags; the last letter says nothing. No checksum. Pure; real-time safe.
/// Source: the protocol as libnifalcon documents it.

constexpr std::uint16_t kVendor = 0x0403, kProduct = 0xcb48;
constexpr std::size_t kFrameSize = 16;

constexpr std::uint8_t kAllHomed = 7;

struct Report {
  std::array<std::int16_t, 3> encoders{};  ///< Counts from the index of each, once it is homed.
  std::uint8_t homed = 0;    ///< Bit i: encoder i has passed its index since it was told to home.
  std::uint8_t buttons = 0;  ///< Of the grip, four.
  bool operator==(const Report&) const = default;
};

enum Light : std::uint8_t { kGreen = 2, kBlue = 4, kRed = 8 };

struct Command {
  std::array<std::int16_t, 3> torques{};  ///< In the motors' own unit.
  std::uint8_t lights = 0;                ///< Of Light.
  bool isHoming = false;                  ///< Look for the encoders' indexes.
  bool operator==(const Command&) const = default;
};

std::array<std::byte, kFrameSize> encode(const Command& command) noexcept;

/// Finds frames in what comes, however it is cut into packets.
class FrameReader {
 public:
  /// The report that ends with this byte, if one does.
  std::optional<Report> take(std::byte next) noexcept;
  /// Of frames that were begun, those that were none; a first one that is met in its midst does not count.
  std::uint64_t damaged() const noexcept { return damaged_; }

 private:
  std::array<std::uint8_t, kFrameSize> frame_{};
  std::size_t size_ = 0;
  std::uint64_t damaged_ = 0;
};

}  // namespace nearfit::falcon
