#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "device/device_list.h"

namespace CLI {
class App;
}

namespace nearfit::cli {

/// What --calibrate does, for help texts.
inline constexpr const char* kCalibrateHelp =
    "The handle is held in its rest, or left free to find itself: devices that do not know where it is take "
    "it "
    "from there";

/// Files that some devices need: options of a command.
/// @param files  Outlives the command.
void addDeviceFileOptions(CLI::App& command, DeviceFiles& files);

/// What is plugged in now; what went wrong with plug-ins goes to stderr as warnings. Throws DeviceError.
std::vector<DeviceListing> devicesPluggedIn();

/// The file of a recorded hand that is meant as a device: "replay:FILE".
std::optional<std::filesystem::path> recordingMeant(const std::string& wanted);

/// The device that is meant (see chooseDevice, recordingMeant), not opened yet. Throws DeviceError with what
/// to do about it.
std::unique_ptr<HapticDevice> deviceMeant(const std::string& wanted, const DeviceFiles& files);

}  // namespace nearfit::cli
