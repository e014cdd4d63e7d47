#pragma once

#include <optional>
#include <string>

#include "core/haptics/rate_settings.h"
#include "device/interface/haptic_device.h"

namespace CLI {
class App;
}

namespace nearfit::cli {

/// Options of a space mouse from a command line.
struct RateOptions {
  std::optional<double> deadZone, exponent, fullSpeed, fullTurn;
  std::optional<std::string> axes;  ///< See takeAxes().

  bool isGiven() const noexcept { return deadZone || exponent || fullSpeed || fullTurn || axes; }
};

/// Adds the options to a command.
/// @param options  Must outlive the command.
void addRateOptions(CLI::App& command, RateOptions& options);

/// Returns the default settings with the options applied. Throws UsageError that names the option.
RateSettings rateSettings(const RateOptions& options);

/// Enables the axes that `text` names ("x,y,-rz"), reversed with a minus, and disables all
/// others. Throws UsageError.
void takeAxes(const std::string& text, RateSettings& settings);

/// Applies the settings to a device. Throws UsageError if options are given and the device is not
/// driven by pushing.
void applyRateOptions(const RateOptions& options, HapticDevice& device);

}  // namespace nearfit::cli
