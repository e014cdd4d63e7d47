#include "device/usb/usb_access.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "core/base/error.h"

namespace nearfit {
namespace {

/// The kernel's name for programs that have claimed an interface.
constexpr const char* kProgram = "usbfs";

class NodeFile {
 public:
  explicit NodeFile(const std::string& node) noexcept
      : descriptor_(::open(node.c_str(), O_RDWR | O_CLOEXEC)), error_(descriptor_ < 0 ? errno : 0) {}
  ~NodeFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  NodeFile(const NodeFile&) = delete;
  NodeFile& operator=(const NodeFile&) = delete;

  int error() const noexcept { return error_; }
  /// Returns the driver that holds the interface; empty if none does.
  std::string holderOf(std::uint8_t interfaceNumber) const {
    usbdevfs_getdriver holder{};
    holder.interface = interfaceNumber;
    if (::ioctl(descriptor_, USBDEVFS_GETDRIVER, &holder) != 0) return {};
    return {holder.driver, ::strnlen(holder.driver, sizeof holder.driver)};
  }

 private:
  int descriptor_, error_;
};

UsbAccess refused(int error) {
  switch (error) {
    case EACCES:
    case EPERM:
      return {DeviceProblem::NoPermission, "you have no permission to open it", "install the udev rules", {}};
    case ENOENT:
    case ENODEV:
      return {DeviceProblem::Gone, "it is no longer plugged in", "plug it in again", {}};
    default:
      return {DeviceProblem::Failed,
              std::string("it cannot be opened: ") + std::strerror(error),
              "plug it in again",
              {}};
  }
}

std::string attributeOf(const UsbDescription& device, const char* attribute) {
  std::ifstream file("/sys/bus/usb/devices/" + device.place() + '/' + attribute);
  std::string line, text;
  std::getline(file, line);
  for (const char c : line)
    text += c < 0x20 || c > 0x7e ? '?' : c;
  return text;
}

}  // namespace

UsbAccess usbAccess(const UsbDescription& device) {
  const NodeFile node(device.node());
  if (node.error() != 0) return refused(node.error());
  UsbAccess access;
  for (const UsbInterface& each : device.interfaces) {
    const std::string holder = node.holderOf(each.number);
    if (holder == kProgram) {
      return {DeviceProblem::Busy,
              "another program is using it",
              "close the program that uses it (another Nearfit, or its maker's)",
              {}};
    }
    if (access.kernelDriver.empty()) access.kernelDriver = holder;
  }
  return access;
}

std::string usbProductName(const UsbDescription& device) {
  return attributeOf(device, "product");
}

std::string usbMakerName(const UsbDescription& device) {
  return attributeOf(device, "manufacturer");
}

std::string udevRulesFile() {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const std::array<fs::path, 2> places = {
      program.parent_path().parent_path() / "lib/udev/rules.d/70-nearfit.rules",
      fs::path(NEARFIT_RESOURCE_DIR) / "udev/70-nearfit.rules"};
  for (const fs::path& file : places) {
    if (fs::is_regular_file(file, ignored)) return file.string();
  }
  throw FileError(places[0].string(), "the file of udev rules is missing", "install Nearfit again");
}

std::string udevCommand() {
  return fmt::format(
      "sudo cp '{}' /etc/udev/rules.d/ && sudo udevadm control --reload && sudo udevadm trigger",
      udevRulesFile());
}

}  // namespace nearfit
