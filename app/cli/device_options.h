#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "device/registry/device_list.h"

namespace CLI {
class App;
}

namespace nearfit::cli {

/// Help text on what --calibrate does.
inline constexpr const char* kCalibrateHelp =
    "Find the position of the handle: hold it in its rest, or let go of it if the device calibrates itself";

/// Adds the options for files that some devices need.
/// @param files  Must outlive the command.
void addDeviceFileOptions(CLI::App& command, DeviceFiles& files);

/// Returns the devices that are plugged in now; prints problems of plug-ins to stderr as
/// warnings. Throws DeviceError.
/// @param missing  As for listPluginDevices().
std::vector<DeviceListing> devicesPluggedIn(const PluginSearch& plugins,
                                            std::vector<MissingDriver>* missing = nullptr);

/// Returns the file of a recorded hand that is named as a device, "replay:FILE"; else std::nullopt.
std::optional<std::filesystem::path> recordingMeant(const std::string& wanted);

/// Creates the device that `wanted` names (see chooseDevice, recordingMeant); opens nothing yet. Throws
/// DeviceError with the remedy.
std::unique_ptr<HapticDevice> deviceMeant(const std::string& wanted, const DeviceFiles& files);

}  // namespace nearfit::cli
