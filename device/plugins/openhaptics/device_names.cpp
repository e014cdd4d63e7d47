#include "device/plugins/openhaptics/device_names.h"

#include <cstdlib>
#include <filesystem>
#include <set>
#include <system_error>

namespace nearfit::openhaptics {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> setupFolders() {
  std::vector<fs::path> folders;
  if (const char* home = ::secure_getenv("GTDD_HOME")) folders.push_back(fs::path(home) / "config");
  if (const char* home = ::secure_getenv("HOME")) folders.push_back(fs::path(home) / ".3dsystems" / "config");
  folders.emplace_back("/usr/share/3DSystems/config");
  return folders;
}

}  // namespace

std::vector<std::string> deviceNames() {
  for (const fs::path& folder : setupFolders()) {
    std::error_code error;
    std::set<std::string> names;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
      if (i->path().extension() == ".config") names.insert(i->path().stem().string());
    }
    if (!names.empty()) return {names.begin(), names.end()};
  }
  return {};
}

}  // namespace nearfit::openhaptics
