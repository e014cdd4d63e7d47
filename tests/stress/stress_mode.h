#pragma once

#include <string>
#include <vector>

#include "core/haptics/haptic_settings.h"

namespace CLI {
class App;
}

namespace nearfit::stress {

/// How a run feels contact: the modes of the command line, and `grouped`, which is `spring` with one spring for each area
/// of contact.
enum class StressMode { Proxy, Spring, Printed, Grouped };

const char* nameOf(StressMode mode) noexcept;
std::vector<StressMode> allStressModes();
/// Throws UsageError for a name that is none.
std::vector<StressMode> stressModes(const std::vector<std::string>& names);
/// Adds `--mode` with names to choose from, all by default.
void addModeOption(CLI::App& command, std::vector<std::string>& names);

/// Puts settings into a mode.
/// @param stiffness  Of a spring; of the printed law its largest slope, stiffness times cutoff [N/m].
void setMode(HapticSettings& settings, StressMode mode, double stiffness);

}  // namespace nearfit::stress
