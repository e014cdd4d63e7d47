#pragma once

#include <span>
#include <string>

#include "device/registry/device_list.h"

namespace nearfit::cli {

/// Returns text for a reader, one line each with a line break: the devices that are plugged in, whether they
/// can be used and, if not, why and what to do; then the makers whose driver is missing; then the hands that need no
/// device.
std::string devicesText(std::span<const DeviceListing> devices, std::span<const MissingDriver> missing = {});
/// Returns the same as one JSON object on one line.
std::string devicesJson(std::span<const DeviceListing> devices, std::span<const MissingDriver> missing = {});

/// Return one line, or one JSON object on a line, about a device that has come (`hasCome`) or gone.
std::string arrivalText(const DeviceListing& device, bool hasCome);
std::string arrivalJson(const DeviceListing& device, bool hasCome);

}  // namespace nearfit::cli
