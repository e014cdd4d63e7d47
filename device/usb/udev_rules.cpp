#include "device/usb/udev_rules.h"

#include <array>
#include <filesystem>

#include <fmt/format.h>

#include "core/base/error.h"

namespace nearfit {

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
