#pragma once

#include <optional>
#include <string>

#include "core/haptics/haptic_settings.h"

namespace CLI {
class App;
}

namespace nearfit::cli {

/// Haptic settings from a command line; those not given stay unchanged.
struct HapticOptions {
  std::optional<std::string> mode, gravity, orientation, locks;
  std::optional<double> cutoff, stiffness, damping, margin, friction, scale;
  std::optional<double> couplingStiffness, couplingDamping, rotationalStiffness, rotationalDamping;
  std::optional<bool> onePerArea, hasWeight, hasInertia;
};

/// Adds the options to a command, in their own group.
/// @param options   Must outlive the command.
/// @param defaults  Shown in the help as default values; null: none are shown.
void addHapticOptions(CLI::App& command, HapticOptions& options, const HapticSettings* defaults = nullptr);

/// Returns `settings` with the options applied. Any value for the coupling turns its automatic choice off.
/// Throws UsageError, naming the option, for invalid text or a value that checkHaptics() refuses.
HapticSettings withOptions(HapticSettings settings, const HapticOptions& options);

}  // namespace nearfit::cli
