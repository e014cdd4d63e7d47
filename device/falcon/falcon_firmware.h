#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "device/falcon/ftdi_port.h"

namespace nearfit::falcon {

/// Firmware is some tens of kilobytes [bytes].
constexpr std::size_t kLeastFirmware = 256, kMostFirmware = std::size_t{1} << 20U;

/// The file that the user has from the maker of the device. Throws DeviceError (NoFirmware) when there is no
/// path or the size is none that firmware has, FileError when it cannot be read.
/// @param where  The device, for messages.
std::vector<std::byte> readFirmware(const std::filesystem::path& file, const std::string& where);

/// Makes the port what the running firmware talks over, and asks whether it runs. Throws DeviceError.
bool isFirmwareRunning(FtdiPort& port);

/// Loads firmware into a device that has just been switched on: greets its loader, sends blocks and compares
/// what comes back, and asks whether it runs; up to kUploads times. Throws DeviceError that says which step
/// failed and what to do; Cancelled.
/// @param progress  By blocks that the device has repeated.
/// Source: the sequence as libnifalcon documents it.
void uploadFirmware(FtdiPort& port, std::span<const std::byte> firmware, const std::string& where,
                    const ProgressCallback& progress = {});

constexpr int kUploads = 5;

}  // namespace nearfit::falcon
