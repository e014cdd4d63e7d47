#include "device/hid/system_descriptor.h"

#include <filesystem>
#include <fstream>
#include <string>

namespace nearfit {
namespace {

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
