#include "device/spacemouse/spacemouse_reader.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace nearfit {
namespace {

constexpr std::array<std::uint32_t, 6> kAxisUsages = {hid_usage::kX,  hid_usage::kY,  hid_usage::kZ,
                                                      hid_usage::kRx, hid_usage::kRy, hid_usage::kRz};
/// Signs that turn it to x right, y away, z up.
constexpr std::array<double, 6> kSigns = {1.0, -1.0, -1.0, 1.0, -1.0, -1.0};
/// The cap's full deflection, if the descriptor gives none or an absurd one.
constexpr std::int32_t kFullScale = 350;
/// "Generic indicator" on the LED page.
constexpr std::uint32_t kIndicator = 0x8004b;

HidField axisField(std::uint8_t report, std::uint32_t usage, std::uint32_t byte) noexcept {
  return {HidReportKind::Input, report, usage, 8 * byte, 16, -kFullScale, kFullScale, false};
}

double deflection(std::int32_t value, const HidField& field) noexcept {
  const std::int32_t max = field.logicalMaximum > 0 ? field.logicalMaximum : kFullScale;
  return std::clamp(static_cast<double>(value) / max, -1.0, 1.0);
}

}  // namespace

std::optional<SpaceMouseReader> SpaceMouseReader::fromDescriptor(
    std::span<const std::byte> reportDescriptor) {
  const std::optional<HidReports> reports = parseReportDescriptor(reportDescriptor);
  if (!reports) return std::nullopt;
  SpaceMouseReader reader;
  reader.hasNumbers_ = reports->hasNumbers;
  for (const HidField& field : reports->fields) {
    if (field.kind == HidReportKind::Output && field.usage == kIndicator && reader.led_.bitCount == 0)
      reader.led_ = field;
    if (field.kind != HidReportKind::Input) continue;
    const auto axis = std::find(kAxisUsages.begin(), kAxisUsages.end(), field.usage);
    if (axis != kAxisUsages.end()) {
      HidField& place = reader.axes_[static_cast<std::size_t>(axis - kAxisUsages.begin())];
      if (place.bitCount == 0) place = field;
    } else if (hid_usage::page(field.usage) == hid_usage::kButtonPage && field.bitCount == 1 &&
               reader.buttonCount_ < kMaxButtons) {
      reader.buttons_[reader.buttonCount_++] = field;
    }
  }
  if (!reader.isComplete()) return std::nullopt;
  return reader;
}

SpaceMouseReader SpaceMouseReader::withKnownLayout() {
  SpaceMouseReader reader;
  for (std::uint32_t i = 0; i < 6; ++i) {
    reader.axes_[i] = axisField(1, kAxisUsages[i], 1 + 2 * i);
    reader.olderAxes_[i] = axisField(i < 3 ? 1 : 2, kAxisUsages[i], 1 + 2 * (i % 3));
  }
  reader.hasOlderLayout_ = true;
  for (std::uint32_t i = 0; i < kMaxButtons; ++i)
    reader.buttons_[i] = {HidReportKind::Input,
                          3,
                          (std::uint32_t{hid_usage::kButtonPage} << 16U) | (i + 1),
                          8 + i,
                          1,
                          0,
                          1,
                          false};
  reader.buttonCount_ = kMaxButtons;
  reader.led_ = {HidReportKind::Output, 4, kIndicator, 8, 1, 0, 1, false};
  return reader;
}

bool SpaceMouseReader::isComplete() const noexcept {
  return std::all_of(axes_.begin(), axes_.end(), [](const HidField& field) { return field.bitCount > 0; });
}

bool SpaceMouseReader::isOf(std::span<const std::byte> report, const HidField& field) const noexcept {
  return !hasNumbers_ || (!report.empty() && std::to_integer<std::uint8_t>(report[0]) == field.reportId);
}

/// Of two known layouts, takes the newer one if all its axes fit in the report.
const SpaceMouseReader::Axes* SpaceMouseReader::axesIn(std::span<const std::byte> report) const noexcept {
  const auto isWhole = [&](const Axes& axes) {
    return std::all_of(axes.begin(), axes.end(), [&](const HidField& field) {
      return !isOf(report, field) || readField(report, field, hasNumbers_).has_value();
    });
  };
  const auto tells = [&](const Axes& axes) {
    return std::any_of(axes.begin(), axes.end(), [&](const HidField& field) { return isOf(report, field); });
  };
  const Axes& axes = hasOlderLayout_ && !(tells(axes_) && isWhole(axes_)) ? olderAxes_ : axes_;
  return isWhole(axes) ? &axes : nullptr;
}

bool SpaceMouseReader::read(std::span<const std::byte> report, SpaceMouseState& state) const noexcept {
  // A truncated report would push in a direction that nobody chose.
  const Axes* axes = axesIn(report);
  if (axes == nullptr) return false;
  bool isKnown = false;
  for (std::size_t i = 0; i < axes->size(); ++i) {
    const std::optional<std::int32_t> value = readField(report, (*axes)[i], hasNumbers_);
    if (!value) continue;
    state.axes[i] = kSigns[i] * deflection(*value, (*axes)[i]);
    isKnown = true;
  }
  for (std::size_t i = 0; i < buttonCount_; ++i) {
    const std::optional<std::int32_t> value = readField(report, buttons_[i], hasNumbers_);
    if (!value) continue;
    const std::uint64_t bit = std::uint64_t{1} << i;
    state.buttons = *value != 0 ? state.buttons | bit : state.buttons & ~bit;
    isKnown = true;
  }
  return isKnown;
}

std::optional<SpaceMouseReader::LedReport> SpaceMouseReader::ledReport(bool isOn) const noexcept {
  if (led_.bitCount == 0) return std::nullopt;
  LedReport report;
  const std::size_t size = (std::size_t{led_.bitOffset} + led_.bitCount + 7) / 8;
  if (size > report.bytes.size()) return std::nullopt;
  report.size = size;
  if (hasNumbers_) report.bytes[0] = std::byte{led_.reportId};
  writeField(std::span(report.bytes).first(size), led_, isOn ? 1 : 0);
  return report;
}

}  // namespace nearfit
