#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace nearfit {

enum class HidReportKind : std::uint8_t { Input, Output, Feature };

/// One value of a report: where it stands in it, and what it means.
struct HidField {
  HidReportKind kind = HidReportKind::Input;
  std::uint8_t reportId = 0;    ///< 0 where the device numbers no reports.
  std::uint32_t usage = 0;      ///< Page in the upper 16 bits, usage in the lower.
  std::uint32_t bitOffset = 0;  ///< From the report's first byte, the one with its number included.
  std::uint32_t bitCount = 0;   ///< 1 to 32.
  std::int32_t logicalMinimum = 0, logicalMaximum = 0;
  bool isRelative = false;

  bool isSigned() const noexcept { return logicalMinimum < 0; }
};

/// Usages that Nearfit looks for. Source: HID Usage Tables 1.3, 4 (generic desktop), 11 (LED), 12 (button).
namespace hid_usage {
constexpr std::uint32_t kX = 0x10030, kY = 0x10031, kZ = 0x10032;
constexpr std::uint32_t kRx = 0x10033, kRy = 0x10034, kRz = 0x10035;
constexpr std::uint32_t kMultiAxisController = 0x10008;
constexpr std::uint16_t kButtonPage = 0x09, kLedPage = 0x08;

constexpr std::uint16_t page(std::uint32_t usage) noexcept {
  return static_cast<std::uint16_t>(usage >> 16U);
}
}  // namespace hid_usage

/// What a HID report descriptor says: all values that have a usage, in its order.
struct HidReports {
  bool hasNumbers = false;                  ///< Reports begin with a byte that says which one it is.
  std::vector<std::uint32_t> applications;  ///< Usages of the top collections.
  std::vector<HidField> fields;
};

/// Nothing when the descriptor is damaged: items that run past its end, collections that do not close, more
/// than kMostHidFields values, reports of more than kMostReportBytes. Arrays of selectors (keyboards) are
/// passed over. Source: Device Class Definition for HID 1.11, 6.2.2.
std::optional<HidReports> parseReportDescriptor(std::span<const std::byte> descriptor);

/// A damaged count must not fill the memory; a space mouse has some 60.
constexpr std::size_t kMostHidFields = 4096;
/// As much as a report over USB can be.
constexpr std::uint32_t kMostReportBytes = 65535;

/// The value of a field in a report; nothing when the report is too short or another one.
/// @param report  As it came, its number included. Real-time safe.
std::optional<std::int32_t> readField(std::span<const std::byte> report, const HidField& field,
                                      bool hasNumbers) noexcept;

/// Writes a value into a report that is long enough; one that does not fit the field's bits is cut off.
void writeField(std::span<std::byte> report, const HidField& field, std::int32_t value) noexcept;

}  // namespace nearfit
