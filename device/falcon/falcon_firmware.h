#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "device/falcon/ftdi_port.h"

namespace nearfit::falcon {

/// Bounds on the size of a firmware file, which has some tens of kilobytes [bytes].
constexpr std::size_t kMinFirmware = 256, kMaxFirmware = std::size_t{1} << 20U;

/// Reads the firmware file that the device's maker supplies. Throws DeviceError (NoFirmware) if `file` is
/// empty or its size is out of bounds, FileError if it cannot be read.
/// @param where  Name of the device, for messages.
std::vector<std::byte> readFirmware(const std::filesystem::path& file, const std::string& where);

/// Sets the line as the running firmware uses it and returns true if the firmware
/// answers. Throws DeviceError.
bool isFirmwareRunning(FtdiPort& port);

/// Loads firmware into a device that was just switched on: greets its loader, sends blocks, compares what the
/// loader repeats and checks that the firmware runs. Tries up to kUploads times. Throws DeviceError that says
/// which step failed and what to do; Cancelled.
/// @param where     Name of the device, for messages.
/// @param progress  Fraction of the firmware that the device has repeated.
/// Source: the sequence as libnifalcon documents it.
void uploadFirmware(FtdiPort& port, std::span<const std::byte> firmware, const std::string& where,
                    const ProgressCallback& progress = {});

constexpr int kUploads = 5;

}  // namespace nearfit::falcon
