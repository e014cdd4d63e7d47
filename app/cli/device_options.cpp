#include "app/cli/device_options.h"

#include <CLI/CLI.hpp>

#include "app/cli/output.h"
#include "device/simulated/replay_device.h"

namespace nearfit::cli {

void addDeviceFileOptions(CLI::App& command, DeviceFiles& files) {
  constexpr const char* kGroup = "Devices";
  command
      .add_option("--falcon-firmware", files.falconFirmware,
                  "Firmware of a Novint Falcon, from its maker's software")
      ->type_name("FILE")
      ->group(kGroup);
  command
      .add_option("--polhem-calibration", files.polhemCalibration,
                  "Calibration of a WoodenHaptics or Polhem: lengths, counts and currents (examples: "
                  "resources/devices)")
      ->type_name("FILE")
      ->group(kGroup);
}

std::vector<DeviceListing> devicesPluggedIn(const PluginSearch& plugins,
                                            std::vector<MissingDriver>* missing) {
  std::vector<std::string> problems;
  std::vector<DeviceListing> devices;
  try {
    devices = listDevices(UsbBus(), plugins, problems, missing);
  } catch (const DeviceError& error) {
    // A machine without USB may still have devices that their makers' software finds.
    devices = listPluginDevices(plugins, problems, missing);
    if (devices.empty()) throw;
    problems.emplace_back(error.what());
  }
  for (const std::string& problem : problems)
    printError("warning: " + problem);
  return devices;
}

std::optional<std::filesystem::path> recordingMeant(const std::string& wanted) {
  const std::string_view prefix = ReplayDevice::kPrefix;
  if (!wanted.starts_with(prefix)) return std::nullopt;
  return std::filesystem::path(wanted.substr(prefix.size()));
}

std::unique_ptr<HapticDevice> deviceMeant(const std::string& wanted, const DeviceFiles& files) {
  if (const auto file = recordingMeant(wanted)) return std::make_unique<ReplayDevice>(*file);
  const std::vector<DeviceListing> devices = devicesPluggedIn(loadPlugins(pluginFolders()));
  return makeDevice(chooseDevice(devices, wanted), files);
}

}  // namespace nearfit::cli
