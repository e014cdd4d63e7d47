#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "device/hid/report_descriptor.h"

namespace nearfit {

/// What a space mouse says: how far its cap is pushed and turned, and which buttons are down.
struct SpaceMouseState {
  /// Deflections along x, y, z and about them, -1 to 1, in a right-handed frame as one sits before the
  /// device: x to the right, y away from oneself, z up.
  std::array<double, 6> axes{};
  std::uint64_t buttons = 0;  ///< Bit 0: the first.
};

/// Reads the reports of 3Dconnexion's devices (and of other multi-axis controllers). Pure: bytes in, state
/// out.
///
/// The device's own frame has y towards the user and z down; here both are turned round. Which byte is which
/// axis comes from the HID report descriptor, as newer models put six axes into one report where older ones
/// have two.
class SpaceMouseReader {
 public:
  /// By the descriptor; nothing when it has no six axes X to Rz.
  static std::optional<SpaceMouseReader> fromDescriptor(std::span<const std::byte> reportDescriptor);
  /// As all models so far send them: X Y Z in report 1 and, of older ones, Rx Ry Rz in report 2, of newer
  /// ones behind those of report 1; buttons in report 3. For devices whose descriptor cannot be had.
  static SpaceMouseReader withKnownLayout();

  /// Takes over what the report says; the rest of `state` stays. False, and nothing is changed, when it is
  /// none that is known, or too short. Real-time safe.
  bool read(std::span<const std::byte> report, SpaceMouseState& state) const noexcept;

  /// The report that lights its ring, number first; nothing where it has none.
  struct LedReport {
    std::array<std::byte, 8> bytes{};
    std::size_t size = 0;
  };
  std::optional<LedReport> ledReport(bool isOn) const noexcept;

  static constexpr std::size_t kMostButtons = 64;

 private:
  using Axes = std::array<HidField, 6>;

  SpaceMouseReader() = default;
  bool isComplete() const noexcept;
  bool isOf(std::span<const std::byte> report, const HidField& field) const noexcept;
  /// Null when the report is too short for those that it has.
  const Axes* axesIn(std::span<const std::byte> report) const noexcept;

  bool hasNumbers_ = true;
  /// One report, or two of a kind: an axis may stand at either of two places in the known layout.
  Axes axes_{};
  Axes olderAxes_{};
  bool hasOlderLayout_ = false;
  std::array<HidField, kMostButtons> buttons_{};
  std::size_t buttonCount_ = 0;
  HidField led_{};
};

}  // namespace nearfit
