#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace nearfit::test {

/// The HID report descriptor of a SpaceNavigator: X Y Z in report 1, Rx Ry Rz in 2, two buttons in 3, its
/// light in 4.
std::vector<std::byte> spaceNavigatorDescriptor();
/// As newer models have it: all six axes in report 1.
std::vector<std::byte> spaceMouseProDescriptor();

/// What a space mouse sends and takes; frame as the device has it: y towards the user, z down, counts to 350.
class SpaceMouseFirmware {
 public:
  enum class Model { Navigator, Pro };
  explicit SpaceMouseFirmware(Model model) : model_(model) {}

  std::vector<std::byte> descriptor() const;
  /// Standard and class requests to its interface; nothing: stall.
  std::optional<std::vector<std::byte>> onRequest(std::uint8_t requestType, std::uint8_t request,
                                                  std::uint16_t value, std::vector<std::byte> data);
  /// The reports of one moment, in order.
  std::vector<std::vector<std::byte>> reports() const;

  std::array<std::int16_t, 6> counts{};
  std::uint16_t buttons = 0;
  bool isLit = false;

 private:
  Model model_;
};

}  // namespace nearfit::test
