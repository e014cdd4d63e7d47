#pragma once

#include <optional>
#include <string>

#include "core/haptics/rate_settings.h"
#include "device/haptic_device.h"

namespace CLI {
class App;
}

namespace nearfit::cli {

/// How a space mouse drives, as far as it was said.
struct RateOptions {
  std::optional<double> deadZone, exponent, fullSpeed, fullTurn;
  std::optional<std::string> axes;  ///< See takeAxes.

  bool isGiven() const noexcept { return deadZone || exponent || fullSpeed || fullTurn || axes; }
};

/// Options of a command. @param options  Outlives the command.
void addRateOptions(CLI::App& command, RateOptions& options);

/// The usual settings with what was said. Throws UsageError that names the option.
RateSettings rateSettings(const RateOptions& options);

/// Those axes that `text` names ("x,y,-rz") are on, those with a minus reversed, all others off.
/// Throws UsageError.
void takeAxes(const std::string& text, RateSettings& settings);

/// Hands what was said to the device. Throws UsageError when it is not driven by pushing.
void applyRateOptions(const RateOptions& options, HapticDevice& device);

}  // namespace nearfit::cli
