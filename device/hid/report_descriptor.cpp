#include "device/hid/report_descriptor.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>

namespace nearfit {
namespace {

/// Item types and tags: an item's first byte without its two size bits (6.2.2.4 to 6.2.2.8).
enum Item : std::uint8_t {
  kInput = 0x80,
  kOutput = 0x90,
  kFeature = 0xb0,
  kCollection = 0xa0,
  kEndCollection = 0xc0,
  kUsagePage = 0x04,
  kLogicalMinimum = 0x14,
  kLogicalMaximum = 0x24,
  kReportSize = 0x74,
  kReportId = 0x84,
  kReportCount = 0x94,
  kPush = 0xa4,
  kPop = 0xb4,
  kUsage = 0x08,
  kUsageMinimum = 0x18,
  kUsageMaximum = 0x28,
};
constexpr std::uint8_t kLongItem = 0xfe;
constexpr std::uint32_t kConstant = 0x1, kVariable = 0x2, kRelativeFlag = 0x4;
constexpr std::uint32_t kApplication = 1;
constexpr std::size_t kMaxPushed = 16;
constexpr std::size_t kMaxUsages = 1024;

struct Globals {
  std::uint32_t usagePage = 0;
  std::int32_t logicalMinimum = 0, logicalMaximum = 0;
  std::uint32_t reportSize = 0, reportCount = 0;
  std::uint8_t reportId = 0;
};

class Parser {
 public:
  std::optional<HidReports> parse(std::span<const std::byte> text) {
    while (!text.empty()) {
      const std::uint8_t first = std::to_integer<std::uint8_t>(text[0]);
      if (first == kLongItem) {
        if (text.size() < 3) return std::nullopt;
        const std::size_t length = std::size_t{3} + std::to_integer<std::size_t>(text[1]);
        if (text.size() < length) return std::nullopt;
        text = text.subspan(length);
        continue;
      }
      const std::size_t size = (first & 3U) == 3 ? 4 : first & 3U;
      if (text.size() < 1 + size) return std::nullopt;
      if (!take(static_cast<std::uint8_t>(first & ~3U), text.subspan(1, size))) return std::nullopt;
      text = text.subspan(1 + size);
    }
    if (depth_ != 0) return std::nullopt;
    return std::move(reports_);
  }

 private:
  bool take(std::uint8_t item, std::span<const std::byte> data) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < data.size(); ++i)
      value |= std::to_integer<std::uint32_t>(data[i]) << (8 * i);
    switch (item) {
      case kInput:
        return takeMain(HidReportKind::Input, value);
      case kOutput:
        return takeMain(HidReportKind::Output, value);
      case kFeature:
        return takeMain(HidReportKind::Feature, value);
      case kCollection:
        if (value == kApplication && depth_ == 0 && !usages_.empty())
          reports_.applications.push_back(usages_.front());
        ++depth_;
        forgetLocals();
        return true;
      case kEndCollection:
        forgetLocals();
        return depth_-- > 0;
      default:
        return takeGlobal(item, value, data.size()) && takeLocal(item, value, data.size());
    }
  }

  bool takeGlobal(std::uint8_t item, std::uint32_t value, std::size_t size) {
    switch (item) {
      case kUsagePage:
        globals_.usagePage = value & 0xffffU;
        return true;
      case kLogicalMinimum:
        globals_.logicalMinimum = signedOf(value, size);
        return true;
      case kLogicalMaximum:
        // Many descriptors give an unsigned maximum in one byte, which reads as negative.
        globals_.logicalMaximum = signedOf(value, size);
        if (globals_.logicalMinimum >= 0 && globals_.logicalMaximum < 0 && size < 4)
          globals_.logicalMaximum = static_cast<std::int32_t>(value);
        return true;
      case kReportSize:
        globals_.reportSize = value;
        return true;
      case kReportCount:
        globals_.reportCount = value;
        return true;
      case kReportId:
        globals_.reportId = static_cast<std::uint8_t>(value);
        reports_.hasNumbers = true;
        return value >= 1 && value <= 255;
      case kPush:
        if (pushed_.size() == kMaxPushed) return false;
        pushed_.push_back(globals_);
        return true;
      case kPop:
        if (pushed_.empty()) return false;
        globals_ = pushed_.back();
        pushed_.pop_back();
        return true;
      default:
        return true;
    }
  }

  bool takeLocal(std::uint8_t item, std::uint32_t value, std::size_t size) {
    // A four-byte usage carries its own page.
    const std::uint32_t usage = size == 4 ? value : (globals_.usagePage << 16U) | (value & 0xffffU);
    switch (item) {
      case kUsage:
        return addUsages(usage, usage);
      case kUsageMinimum:
        usageMinimum_ = usage;
        return true;
      case kUsageMaximum:
        return addUsages(usageMinimum_, usage);
      default:
        return true;
    }
  }

  bool addUsages(std::uint32_t first, std::uint32_t last) {
    if (last < first || last - first >= kMaxUsages - std::min(usages_.size(), kMaxUsages)) return false;
    // Counts from 0: `last` may be the largest value.
    for (std::uint32_t i = 0; i <= last - first; ++i)
      usages_.push_back(first + i);
    return true;
  }

  bool takeMain(HidReportKind kind, std::uint32_t flags) {
    const std::uint64_t bits = std::uint64_t{globals_.reportSize} * globals_.reportCount;
    std::uint32_t& end = ends_[static_cast<std::size_t>(kind)][globals_.reportId];
    if (globals_.reportSize > 0xffff || bits + end > 8 * std::uint64_t{kMaxReportBytes}) return false;
    const bool isData = (flags & kConstant) == 0 && (flags & kVariable) != 0 && globals_.reportSize >= 1 &&
                        globals_.reportSize <= 32 && !usages_.empty();
    if (isData) {
      if (reports_.fields.size() + globals_.reportCount > kMaxHidFields) return false;
      for (std::uint32_t i = 0; i < globals_.reportCount; ++i) {
        // The last usage holds for all remaining values.
        const std::uint32_t usage = usages_[std::min<std::size_t>(i, usages_.size() - 1)];
        reports_.fields.push_back({kind, globals_.reportId, usage, end + i * globals_.reportSize,
                                   globals_.reportSize, globals_.logicalMinimum, globals_.logicalMaximum,
                                   (flags & kRelativeFlag) != 0});
      }
    }
    end += static_cast<std::uint32_t>(bits);
    forgetLocals();
    // Offsets omit the report number here; parseReportDescriptor() adds it.
    return true;
  }

  void forgetLocals() {
    usages_.clear();
    usageMinimum_ = 0;
  }

  static std::int32_t signedOf(std::uint32_t value, std::size_t size) noexcept {
    if (size == 1) return static_cast<std::int8_t>(value);
    if (size == 2) return static_cast<std::int16_t>(value);
    return static_cast<std::int32_t>(value);
  }

  HidReports reports_;
  Globals globals_;
  std::vector<Globals> pushed_;
  std::vector<std::uint32_t> usages_;
  std::uint32_t usageMinimum_ = 0;
  int depth_ = 0;
  std::array<std::array<std::uint32_t, 256>, 3> ends_{};  ///< Bits so far, per kind and report number.
};

namespace fs = std::filesystem;

/// Linux accepts no longer descriptor (HID_MAX_DESCRIPTOR_SIZE) [bytes].
constexpr std::size_t kMaxDescriptor = 4096;

std::optional<std::vector<std::byte>> readAll(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> text(kMaxDescriptor);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  const auto size = static_cast<std::size_t>(file.gcount());
  if (size == 0) return std::nullopt;
  std::vector<std::byte> bytes;
  bytes.reserve(size);
  for (std::size_t i = 0; i < size; ++i)
    bytes.push_back(static_cast<std::byte>(text[i]));
  return bytes;
}

/// True for folder "1-3:1.0", device "1-3" and interface 0, whatever the configuration's number.
bool isInterface(const std::string& folder, const std::string& device, std::uint8_t number) {
  const std::string begin = device + ':', end = '.' + std::to_string(number);
  return folder.size() > begin.size() + end.size() && folder.compare(0, begin.size(), begin) == 0 &&
         folder.compare(folder.size() - end.size(), end.size(), end) == 0;
}

/// Returns a folder's entries; none if it cannot be read, since devices may vanish meanwhile.
std::vector<fs::path> childrenOf(const fs::path& folder) {
  std::vector<fs::path> children;
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error))
    children.push_back(i->path());
  return children;
}

}  // namespace

std::optional<HidReports> parseReportDescriptor(std::span<const std::byte> descriptor) {
  std::optional<HidReports> reports = Parser().parse(descriptor);
  if (reports && reports->hasNumbers) {
    for (HidField& field : reports->fields)
      field.bitOffset += 8;
  }
  return reports;
}

std::optional<std::int32_t> readField(std::span<const std::byte> report, const HidField& field,
                                      bool hasNumbers) noexcept {
  if (std::uint64_t{field.bitOffset} + field.bitCount > 8 * report.size()) return std::nullopt;
  if (hasNumbers && std::to_integer<std::uint8_t>(report[0]) != field.reportId) return std::nullopt;
  std::uint32_t value = 0;
  for (std::uint32_t i = 0; i < field.bitCount; ++i) {
    const std::uint32_t bit = field.bitOffset + i;
    value |= ((std::to_integer<std::uint32_t>(report[bit / 8]) >> (bit % 8)) & 1U) << i;
  }
  if (field.isSigned() && field.bitCount < 32 && (value >> (field.bitCount - 1)) != 0)
    value |= ~0U << field.bitCount;
  return static_cast<std::int32_t>(value);
}

void writeField(std::span<std::byte> report, const HidField& field, std::int32_t value) noexcept {
  if (std::uint64_t{field.bitOffset} + field.bitCount > 8 * report.size()) return;
  for (std::uint32_t i = 0; i < field.bitCount; ++i) {
    const std::uint32_t bit = field.bitOffset + i;
    const std::byte mask{static_cast<unsigned char>(1U << (bit % 8))};
    if (((static_cast<std::uint32_t>(value) >> i) & 1U) != 0)
      report[bit / 8] |= mask;
    else
      report[bit / 8] &= ~mask;
  }
}

std::optional<std::vector<std::byte>> systemReportDescriptor(const UsbDescription& device,
                                                             std::uint8_t interfaceNumber) {
  const std::string place = device.place();
  for (const fs::path& face : childrenOf("/sys/bus/usb/devices/" + place)) {
    if (!isInterface(face.filename().string(), place, interfaceNumber)) continue;
    for (const fs::path& driver : childrenOf(face)) {
      if (auto descriptor = readAll(driver / "report_descriptor")) return descriptor;
    }
  }
  return std::nullopt;
}

}  // namespace nearfit
