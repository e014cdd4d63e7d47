#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "device/haptic_device.h"
#include "device/plugin/nearfit_device.h"

namespace nearfit {

/// A plug-in that is loaded: it stays so until the last device of it is gone.
class DevicePlugin {
 public:
  /// Loads a shared library. It runs code of its own then: only files that nobody else can write are taken.
  /// Throws DeviceError that says why not: not a library, not a plug-in, of another version, writable by
  /// others.
  static std::shared_ptr<const DevicePlugin> load(const std::filesystem::path& file);
  ~DevicePlugin();
  DevicePlugin(const DevicePlugin&) = delete;
  DevicePlugin& operator=(const DevicePlugin&) = delete;

  const NearfitDevicePlugin& functions() const noexcept { return *functions_; }
  std::string name() const { return functions_->name; }
  const std::filesystem::path& file() const noexcept { return file_; }

  /// Devices that are plugged in, checked: finite numbers, texts that end. Throws DeviceError with the
  /// plug-in's own words.
  std::vector<NearfitDeviceDescription> devices() const;

 private:
  DevicePlugin() = default;

  std::filesystem::path file_;
  void* library_ = nullptr;
  const NearfitDevicePlugin* functions_ = nullptr;
};

/// What was found in the folders of plug-ins.
struct PluginSearch {
  std::vector<std::shared_ptr<const DevicePlugin>> plugins;
  std::vector<std::string> problems;  ///< Of files that could not be loaded: what, where, and what to do.
};

/// Loads all `*.so` in the folders, by name. A folder that is not there has none.
PluginSearch loadPlugins(const std::vector<std::filesystem::path>& folders);

/// Where plug-ins are looked for: what NEARFIT_PLUGINS names (folders, with colons between), else
/// `nearfit/plugins` in XDG_DATA_HOME (~/.local/share) and in /usr/local/lib and /usr/lib.
std::vector<std::filesystem::path> pluginFolders();

/// A device of a plug-in. @param index  Of the last devices().
std::unique_ptr<HapticDevice> makePluginDevice(std::shared_ptr<const DevicePlugin> plugin, int index,
                                               const NearfitDeviceDescription& description);

}  // namespace nearfit
