#pragma once

#include <span>
#include <string>

#include "device/device_list.h"

namespace nearfit::cli {

/// Lines for a reader, each with a line break at its end: what is plugged in, whether it can be used, and if
/// not why and what to do; then what needs no device.
std::string devicesText(std::span<const DeviceListing> devices);
/// The same as one JSON object on one line.
std::string devicesJson(std::span<const DeviceListing> devices);

/// One line (or object) on a device that has come or gone.
std::string arrivalText(const DeviceListing& device, bool hasCome);
std::string arrivalJson(const DeviceListing& device, bool hasCome);

}  // namespace nearfit::cli
