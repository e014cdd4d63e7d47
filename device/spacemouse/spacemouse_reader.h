#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "device/hid/report_descriptor.h"

namespace nearfit {

/// State of a space mouse: deflections of the cap, and buttons.
struct SpaceMouseState {
  /// Deflections along and about x, y, z, -1 to 1, in the right-handed frame of a person in front of the
  /// device: x to the right, y away, z up.
  std::array<double, 6> axes{};
  std::uint64_t buttons = 0;  ///< Bit 0 is the first button.
};

/// Decodes the reports of 3Dconnexion's devices and of other multi-axis controllers. Pure:
/// bytes in, state out.
///
/// The device's own frame has y towards the user and z down; both are flipped here. The HID report descriptor
/// says which byte is which axis: newer models put six axes into one report, older ones into two.
class SpaceMouseReader {
 public:
  /// Returns a reader for a descriptor; std::nullopt if it lacks one of the six axes X to Rz.
  static std::optional<SpaceMouseReader> fromDescriptor(std::span<const std::byte> reportDescriptor);
  /// Returns a reader for the layout that all models so far use: X Y Z in report 1; Rx Ry Rz behind
  /// them (newer models) or in report 2 (older ones); buttons in report 3. For devices whose
  /// descriptor cannot be read.
  static SpaceMouseReader withKnownLayout();

  /// Updates `state` with what the report carries. Returns false, and changes nothing, if the report is
  /// unknown or too short. Real-time safe.
  bool read(std::span<const std::byte> report, SpaceMouseState& state) const noexcept;

  /// An output report that sets the ring's light, number first.
  struct LedReport {
    std::array<std::byte, 8> bytes{};
    std::size_t size = 0;
  };
  /// Returns the report that turns the light on or off; std::nullopt if the device has none.
  std::optional<LedReport> ledReport(bool isOn) const noexcept;

  static constexpr std::size_t kMaxButtons = 64;

 private:
  using Axes = std::array<HidField, 6>;

  SpaceMouseReader() = default;
  bool isComplete() const noexcept;
  bool isOf(std::span<const std::byte> report, const HidField& field) const noexcept;
  /// Returns the layout that the report follows; null if the report is too short for its axes.
  const Axes* axesIn(std::span<const std::byte> report) const noexcept;

  bool hasNumbers_ = true;
  /// One layout, or two: in the known layout an axis may be in either of two places.
  Axes axes_{};
  Axes olderAxes_{};
  bool hasOlderLayout_ = false;
  std::array<HidField, kMaxButtons> buttons_{};
  std::size_t buttonCount_ = 0;
  HidField led_{};
};

}  // namespace nearfit
