#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "device/interface/device_supervisor.h"
#include "device/interface/haptic_device.h"
#include "device/plugin/nearfit_device.h"

namespace nearfit {

/// A loaded plug-in; stays loaded until its last device is gone.
class DevicePlugin {
 public:
  /// Loads a shared library, whose code then runs with the user's rights. So only files that belong to the user
  /// or root and that nobody else can write are accepted, in such folders; so are the folders above, up to the root, but
  /// for sticky ones (/tmp), which others may write to. What was checked is loaded, even if
  /// the name stands for another file by then. Throws DeviceError with the reason: not a library, not a plug-in,
  /// another version, another user's, writable by others.
  static std::shared_ptr<const DevicePlugin> load(const std::filesystem::path& file);
  ~DevicePlugin();
  DevicePlugin(const DevicePlugin&) = delete;
  DevicePlugin& operator=(const DevicePlugin&) = delete;

  /// The plug-in's functions; none is null. Valid while this lives.
  const NearfitDevicePlugin& functions() const noexcept { return *functions_; }
  std::string name() const { return functions_->name; }
  const std::filesystem::path& file() const noexcept { return file_; }

  /// Returns the devices that are plugged in, checked: finite numbers, terminated texts. Throws DeviceError
  /// with the plug-in's own message; NoDriver if it cannot do without what its maker gives out.
  std::vector<NearfitDeviceDescription> devices() const;

 private:
  DevicePlugin() = default;

  std::filesystem::path file_;
  int descriptor_ = -1;  ///< Of the file; open as long as the loader knows the library by it.
  void* library_ = nullptr;
  const NearfitDevicePlugin* functions_ = nullptr;
};

/// Plug-ins found in the search folders.
struct PluginSearch {
  std::vector<std::shared_ptr<const DevicePlugin>> plugins;
  /// One for each file that could not be loaded: what, where, and what to do.
  std::vector<std::string> problems;
};

/// Loads all `*.so` in the folders, by name. Missing folders are skipped.
PluginSearch loadPlugins(const std::vector<std::filesystem::path>& folders);

/// Rates at which a plug-in may pace the servo [Hz]. Below, forces would have to live on for more than 40 ms without a
/// pose; above, the servo could not keep up, so the number is a mistake.
inline constexpr double kMinPluginRate = 100.0, kMaxPluginRate = 20'000.0;

/// Ends the texts of a description. Returns what is not valid in it, for a sentence; empty if all is.
std::string descriptionProblem(NearfitDeviceDescription& device);

/// Returns the folders searched for plug-ins: those that NEARFIT_PLUGINS lists, separated by colons; else
/// `nearfit/plugins` in XDG_DATA_HOME (~/.local/share), `plugins` beside the program, `nearfit/plugins` in the `lib`
/// beside the program's folder, in /usr/local/lib and in /usr/lib. A program that runs with more rights than its caller
/// takes nothing from the environment.
std::vector<std::filesystem::path> pluginFolders();
/// The same for a program of which it is known.
/// @param isPrivileged  It runs with more rights than its caller.
std::vector<std::filesystem::path> pluginFolders(bool isPrivileged);

/// Creates a plug-in's device; opens nothing yet.
/// @param index   Index in the latest devices().
/// @param safety  The device may lower their speeds only. It says itself whether it has a dead-man switch.
std::unique_ptr<HapticDevice> makePluginDevice(std::shared_ptr<const DevicePlugin> plugin, int index,
                                               const NearfitDeviceDescription& description,
                                               const SafetyLimits& safety = {});

}  // namespace nearfit
