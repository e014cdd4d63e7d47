#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nearfit::test {

/// The device's side of WoodenHaptics and Polhem, without hardware: answers each command with a report.
/// (Theirs rests its motors when none comes for half a second; of that nothing is seen from outside.) No
/// thread and no clock.
class PolhemFirmware {
 public:
  static constexpr std::size_t kPacket = 14;

  /// @param packetSize  64 with a Teensy, whose packets are filled up.
  explicit PolhemFirmware(std::size_t packetSize = kPacket) : packetSize_(packetSize) {}

  void onPacket(std::span<const std::byte> packet);
  std::vector<std::byte> report() const;

  /// It forgets what it counted and was told.
  void powerOff();

  /// What it was last told to give its motors [mA].
  const std::array<int, 3>& told() const { return milliamps_; }
  std::uint64_t accepted() const { return accepted_; }
  std::uint64_t ignored() const { return ignored_; }

  // What the hand does.
  std::array<int, 6> counts{};
  bool isButtonFlagged = false;

 private:
  const std::size_t packetSize_;
  std::array<int, 3> milliamps_{};
  std::uint64_t accepted_ = 0, ignored_ = 0;
};

}  // namespace nearfit::test
