#pragma once

#include <optional>
#include <string>

#include "core/haptics/haptic_settings.h"

namespace CLI {
class App;
}

namespace nearfit::cli {

/// What a command line says about feeling; what it does not say stays as it is.
struct HapticOptions {
  std::optional<std::string> mode, gravity, orientation, locks;
  std::optional<double> cutoff, stiffness, damping, margin, friction, scale;
  std::optional<double> couplingStiffness, couplingDamping, rotationalStiffness, rotationalDamping;
  std::optional<bool> hasWeight, hasInertia;
};

/// Adds the options, in a group of their own, to a command.
/// @param options   Outlives the command.
/// @param defaults  Told in the help as what counts otherwise; null: nothing is told.
void addHapticOptions(CLI::App& command, HapticOptions& options, const HapticSettings* defaults = nullptr);

/// The settings with what the options say. Any number for the coupling turns its automatic choice off. Throws
/// UsageError naming the option: text that is none of what it takes, or a value that checkHaptics refuses.
HapticSettings withOptions(HapticSettings settings, const HapticOptions& options);

}  // namespace nearfit::cli
