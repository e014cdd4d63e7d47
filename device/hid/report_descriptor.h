#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "device/usb/usb_description.h"

namespace nearfit {

enum class HidReportKind : std::uint8_t { Input, Output, Feature };

/// A value in a report: its place and its meaning.
struct HidField {
  HidReportKind kind = HidReportKind::Input;
  std::uint8_t reportId = 0;    ///< 0 if the device does not number its reports.
  std::uint32_t usage = 0;      ///< Page in the upper 16 bits, usage in the lower.
  std::uint32_t bitOffset = 0;  ///< From the first byte of the report, including its number.
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

/// Content of a HID report descriptor: all values that have a usage, in order.
struct HidReports {
  bool hasNumbers = false;                  ///< Reports begin with a byte that identifies them.
  std::vector<std::uint32_t> applications;  ///< Usages of the top-level collections.
  std::vector<HidField> fields;
};

/// Returns std::nullopt if the descriptor is damaged: items that run past its end, collections that
/// do not close, more than kMaxHidFields values, reports of more than kMaxReportBytes. Skips arrays
/// of selectors (keyboards).
/// Source: Device Class Definition for HID 1.11, 6.2.2.
std::optional<HidReports> parseReportDescriptor(std::span<const std::byte> descriptor);

/// Keeps a damaged count from filling the memory; a space mouse has some 60 values.
constexpr std::size_t kMaxHidFields = 4096;
/// Longest possible report over USB.
constexpr std::uint32_t kMaxReportBytes = 65535;

/// Returns the value of a field; std::nullopt if the report is too short or is another one. Real-time safe.
/// @param report  As received, including its number.
std::optional<std::int32_t> readField(std::span<const std::byte> report, const HidField& field,
                                      bool hasNumbers) noexcept;

/// Writes a value into a report, cut to the field's bits. No-op if the report is too short. Real-time safe.
void writeField(std::span<std::byte> report, const HidField& field, std::int32_t value) noexcept;

/// Returns an interface's HID report descriptor as read by the kernel's own driver; opens nothing and
/// disturbs nobody. Returns std::nullopt if no such driver is bound. May allocate.
std::optional<std::vector<std::byte>> systemReportDescriptor(const UsbDescription& device,
                                                             std::uint8_t interfaceNumber);

}  // namespace nearfit
