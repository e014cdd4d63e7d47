#include "app/cli/rate_options.h"

#include <algorithm>
#include <sstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "device/common/rate_control.h"

namespace nearfit::cli {
namespace {

constexpr const char* kAxes = "--axes";

void takeAxis(const std::string& word, RateSettings& settings) {
  const bool isInverted = !word.empty() && word[0] == '-';
  const std::string name = word.substr(isInverted ? 1 : 0);
  const auto found = std::find(kRateAxes.begin(), kRateAxes.end(), name);
  if (found == kRateAxes.end()) {
    throw UsageError(
        kAxes, "\"" + word + "\" is not an axis",
        "name some of x, y, z, rx, ry, rz separated by commas, with a minus before those to reverse");
  }
  const auto axis = static_cast<std::size_t>(found - kRateAxes.begin());
  if (settings.isEnabled[axis]) throw UsageError(kAxes, "\"" + name + "\" is named twice", "name it once");
  settings.isEnabled[axis] = true;
  settings.isInverted[axis] = isInverted;
}

}  // namespace

void takeAxes(const std::string& text, RateSettings& settings) {
  settings.isEnabled = settings.isInverted = {};
  std::istringstream words(text + ',');
  for (std::string word; std::getline(words, word, ',');)
    takeAxis(word, settings);
}

void addRateOptions(CLI::App& command, RateOptions& options) {
  constexpr const char* kGroup = "Space mice";
  const RateSettings usual;
  const auto add = [&](const char* name, std::optional<double>& value, const std::string& text,
                       const char* type) {
    command.add_option(name, value, text)->type_name(type)->group(kGroup);
  };
  add("--dead-zone", options.deadZone,
      fmt::format("Deflection below which nothing moves, as a share of the full one; default: {}",
                  usual.deadZone),
      "SHARE");
  add("--curve", options.exponent,
      fmt::format("Exponent beyond the dead zone: 1 is linear, more is finer near the middle; default: {}",
                  usual.exponent),
      "NUMBER");
  add("--speed", options.fullSpeed,
      fmt::format("Speed at full deflection [m/s], before the scale; default: {}", usual.fullSpeed), "SPEED");
  add("--turn-speed", options.fullTurn,
      fmt::format("Rotation speed at full deflection [rad/s]; default: {}", usual.fullTurn), "SPEED");
  command
      .add_option(kAxes, options.axes,
                  "Only these axes of x,y,z,rx,ry,rz drive; a minus reverses one: x,y,-rz (if a minus comes "
                  "first, with an equals sign: --axes=-x,y)")
      ->type_name("LIST")
      ->group(kGroup);
}

RateSettings rateSettings(const RateOptions& options) {
  RateSettings settings;
  settings.deadZone = options.deadZone.value_or(settings.deadZone);
  settings.exponent = options.exponent.value_or(settings.exponent);
  settings.fullSpeed = options.fullSpeed.value_or(settings.fullSpeed);
  settings.fullTurn = options.fullTurn.value_or(settings.fullTurn);
  if (options.axes) takeAxes(*options.axes, settings);
  checkRateSettings(settings);
  return settings;
}

void applyRateOptions(const RateOptions& options, HapticDevice& device) {
  const RateSettings settings = rateSettings(options);
  if (auto* driven = dynamic_cast<RateDriven*>(&device)) return driven->setRate(settings);
  if (!options.isGiven()) return;
  throw UsageError(device.info().name, "it is not a space mouse, but options of space mice are given",
                   "leave out --dead-zone, --curve, --speed, --turn-speed and --axes");
}

}  // namespace nearfit::cli
