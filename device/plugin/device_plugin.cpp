#include "device/plugin/device_plugin.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>

#include <dlfcn.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/files/user_folders.h"
#include "device/interface/device_error.h"

namespace nearfit {
namespace {

namespace fs = std::filesystem;

using ErrorText = std::array<char, 512>;

std::string textOf(const ErrorText& error) {
  const std::string text(error.data(), ::strnlen(error.data(), error.size()));
  return text.empty() ? "its plug-in gives no reason" : text;
}

[[noreturn]] void refuse(const fs::path& file, std::string problem, std::string remedy) {
  throw DeviceError(DeviceProblem::Unsupported, file.string(), std::move(problem), std::move(remedy));
}

/// The plug-in's code runs as the user, so nobody else may have written it.
void checkOwner(const fs::path& file) {
  struct stat status{};
  if (::stat(file.c_str(), &status) != 0) refuse(file, std::strerror(errno), "check the path");
  if (!S_ISREG(status.st_mode)) refuse(file, "it is not a file", "put the plug-in file there");
  const bool isTrusted = status.st_uid == 0 || status.st_uid == ::geteuid();
  if (!isTrusted)
    refuse(file, "it belongs to another user", "have it installed by root, or copy it yourself");
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0)
    refuse(file, "other users can write to it", "run: chmod go-w " + file.string());
}

void checkFunctions(const fs::path& file, const NearfitDevicePlugin* functions) {
  if (functions == nullptr)
    refuse(file, "the plug-in offers no functions", "ask its maker for a working version");
  if (functions->version != NEARFIT_DEVICE_VERSION || functions->size != sizeof(NearfitDevicePlugin)) {
    refuse(file,
           "it is made for version " + std::to_string(functions->version) +
               " of the plug-in interface, but this is version " + std::to_string(NEARFIT_DEVICE_VERSION),
           "install the plug-in for this version of Nearfit");
  }
  const bool isWhole = functions->name != nullptr && functions->count != nullptr &&
                       functions->describe != nullptr && functions->open != nullptr &&
                       functions->close != nullptr && functions->set_forces != nullptr &&
                       functions->read != nullptr && functions->write != nullptr;
  if (!isWhole) refuse(file, "it lacks required functions", "ask its maker for a working version");
}

template <std::size_t n>
void endText(char (&text)[n]) noexcept {
  text[n - 1] = '\0';
}

bool isUsable(const NearfitDeviceDescription& device) noexcept {
  const std::array<double, 7> numbers = {device.max_force,          device.max_torque, device.damping,
                                         device.rotational_damping, device.mass,       device.inertia,
                                         device.max_speed};
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x) && x >= 0.0; }) &&
         (device.force_axes == 0 || device.force_axes == 3 || device.force_axes == 6);
}

}  // namespace

std::shared_ptr<const DevicePlugin> DevicePlugin::load(const fs::path& file) {
  checkOwner(file);
  std::shared_ptr<DevicePlugin> plugin(new DevicePlugin);
  plugin->file_ = file;
  plugin->library_ = ::dlopen(fs::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (plugin->library_ == nullptr)
    refuse(file, std::string("it cannot be loaded: ") + ::dlerror(),
           "install the libraries that it needs, or remove it");
  using Entry = const NearfitDevicePlugin* (*)();
  const auto entry = reinterpret_cast<Entry>(::dlsym(plugin->library_, "nearfit_device_plugin"));
  if (entry == nullptr)
    refuse(file, "it is a library, but not a device plug-in", "remove it from this folder");
  const NearfitDevicePlugin* functions = entry();
  checkFunctions(file, functions);
  plugin->functions_ = functions;
  return plugin;
}

DevicePlugin::~DevicePlugin() {
  if (library_ != nullptr) ::dlclose(library_);
}

std::vector<NearfitDeviceDescription> DevicePlugin::devices() const {
  ErrorText error{};
  const std::int32_t count = functions_->count(error.data(), error.size());
  if (count < 0)
    throw DeviceError(DeviceProblem::Failed, name(), textOf(error),
                      "check that its maker's driver is installed");
  std::vector<NearfitDeviceDescription> found;
  for (std::int32_t i = 0; i < count; ++i) {
    NearfitDeviceDescription& device = found.emplace_back();
    if (functions_->describe(i, &device, error.data(), error.size()) != 0)
      throw DeviceError(DeviceProblem::Failed, name(), textOf(error), "plug the device in again");
    endText(device.name);
    endText(device.serial);
    if (!isUsable(device)) {
      throw DeviceError(DeviceProblem::Unsupported, name(),
                        std::string("its description of ") + device.name + " is not valid",
                        "ask the plug-in's maker for a working version");
    }
  }
  return found;
}

PluginSearch loadPlugins(const std::vector<fs::path>& folders) {
  PluginSearch search;
  for (const fs::path& folder : folders) {
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
      if (i->path().extension() == ".so") files.push_back(i->path());
    }
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
      try {
        search.plugins.push_back(DevicePlugin::load(file));
      } catch (const Error& problem) {
        search.problems.emplace_back(problem.what());
      }
    }
  }
  return search;
}

std::vector<fs::path> pluginFolders() {
  std::vector<fs::path> folders;
  if (const char* named = std::getenv("NEARFIT_PLUGINS")) {
    std::istringstream list(named);
    for (std::string folder; std::getline(list, folder, ':');) {
      if (!folder.empty()) folders.emplace_back(folder);
    }
    return folders;
  }
  if (const fs::path data = userFolder(UserFiles::Data); !data.empty()) folders.push_back(data / "plugins");
  folders.emplace_back("/usr/local/lib/nearfit/plugins");
  folders.emplace_back("/usr/lib/nearfit/plugins");
  return folders;
}

}  // namespace nearfit
