#pragma once

#include <string>

namespace nearfit {

/// The udev rules that let users open devices, as installed or in the source tree. Throws FileError when they
/// are in neither.
std::string udevRulesFile();

/// What gives the user permission to use devices: one line for a shell. Throws as udevRulesFile does.
std::string udevCommand();

}  // namespace nearfit
