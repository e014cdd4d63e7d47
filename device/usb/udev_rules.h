#pragma once

#include <string>

namespace nearfit {

/// Returns the path of the udev rules that let users open devices, installed or in the source tree. Throws
/// FileError if there are none.
std::string udevRulesFile();

/// Returns a one-line shell command that lets the user open devices. Throws as udevRulesFile() does.
std::string udevCommand();

}  // namespace nearfit
