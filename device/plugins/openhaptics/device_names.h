#pragma once

#include <string>
#include <vector>

namespace nearfit::openhaptics {

/// Names of the devices that 3D Systems' Touch_Setup has set up: HDAPI opens a device by its name and cannot list
/// them. They are those of the files `NAME.config` in `config` of GTDD_HOME, of ~/.3dsystems and of
/// /usr/share/3DSystems (first found, each name once, sorted). Such a device need not be plugged in.
std::vector<std::string> deviceNames();

}  // namespace nearfit::openhaptics
