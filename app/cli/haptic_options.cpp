#include "app/cli/haptic_options.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/cli/arguments.h"
#include "core/base/error.h"
#include "core/scene/haptic_limits.h"

namespace nearfit::cli {
namespace {

constexpr const char* kGroup = "Feel";
/// In the order of WorkspaceMapping, translation first.
constexpr std::array<std::string_view, 6> kLocks{"tx", "ty", "tz", "rx", "ry", "rz"};

/// Maps checkHaptics()'s names of values to options.
constexpr std::array<std::pair<std::string_view, const char*>, 12> kOptionOfValue{
    {{"springs.cutoff", "--cutoff"},
     {"springs.stiffness", "--stiffness"},
     {"springs.damping", "--damping"},
     {"proxy.margin", "--margin"},
     {"proxy.friction", "--friction"},
     {"coupling.stiffness", "--coupling-stiffness"},
     {"coupling.damping", "--coupling-damping"},
     {"coupling.rotationalStiffness", "--rotational-stiffness"},
     {"coupling.rotationalDamping", "--rotational-damping"},
     {"weight.gravity", "--gravity"},
     {"mapping.scale", "--scale"},
     {"mapping.orientation", "--orientation"}}};

class OptionAdder {
 public:
  OptionAdder(CLI::App& command, bool tellsDefaults) : command_(command), tellsDefaults_(tellsDefaults) {}

  template <typename T, typename Default>
  CLI::Option* add(const char* name, std::optional<T>& value, const char* type, const Default& byDefault,
                   const char* help) {
    CLI::Option* option = command_.add_option(name, value, help)->type_name(type)->group(kGroup);
    if (tellsDefaults_) option->default_str(fmt::format("{}", byDefault));
    return option;
  }
  void addFlag(const char* names, std::optional<bool>& value, const char* help) {
    command_.add_flag_function(
                names, [&value](std::int64_t count) { value = count > 0; }, help)
        ->group(kGroup);
  }

 private:
  CLI::App& command_;
  bool tellsDefaults_;
};

void addModeOptions(OptionAdder& adder, HapticOptions& options, const HapticSettings& defaults) {
  adder
      .add("--mode", options.mode, "MODE", "proxy",
           "proxy: the part stops at contact. spring: the part is where the hand is, and each minimum pushes "
           "as a spring. printed: the same, with the spring law as printed in the paper")
      ->check(CLI::IsMember({"proxy", "spring", "printed"}));
  adder.add("--cutoff", options.cutoff, "METRES", defaults.springs.cutoff,
            "Range of the search for minima, and rest length of the springs [m]");
  adder.add("--stiffness", options.stiffness, "K", defaults.springs.stiffness,
            "Stiffness of each spring [N/m], or [N/m^2] in the printed mode");
  adder.add("--damping", options.damping, "B", defaults.springs.damping, "Damping of each spring [N s/m]");
  adder.addFlag(
      "--one-per-area,!--no-one-per-area", options.onePerArea,
      "Springs: one for each area of contact, at its nearest minimum, instead of one for each minimum");
  adder.add("--margin", options.margin, "METRES", "1 % of the cutoff",
            "Proxy: gap that the part keeps in contact [m]");
  adder.add("--friction", options.friction, "MU", defaults.proxy.friction,
            "Proxy: coefficient of Coulomb friction");
}

void addCouplingOptions(OptionAdder& adder, HapticOptions& options) {
  constexpr const char* kAutomatic = "automatic";
  adder.add("--coupling-stiffness", options.couplingStiffness, "K", kAutomatic,
            "Proxy: stiffness of the coupling between hand and part [N/m]");
  adder.add("--coupling-damping", options.couplingDamping, "B", kAutomatic,
            "Proxy: damping of the coupling [N s/m]");
  adder.add("--rotational-stiffness", options.rotationalStiffness, "K", kAutomatic,
            "Proxy: rotational stiffness of the coupling [N m/rad]");
  adder.add("--rotational-damping", options.rotationalDamping, "B", kAutomatic,
            "Proxy: rotational damping of the coupling [N m s/rad]");
}

void addWeightOptions(OptionAdder& adder, HapticOptions& options) {
  adder.addFlag("--weight,!--no-weight", options.hasWeight, "The part's weight is felt");
  adder.addFlag("--inertia,!--no-inertia", options.hasInertia, "Proxy: the part resists acceleration");
  adder.add("--gravity", options.gravity, "X,Y,Z", "0,0,-9.80665", "Gravity in the world frame [m/s^2]");
}

void addMappingOptions(OptionAdder& adder, HapticOptions& options, const HapticSettings& defaults) {
  adder.add("--scale", options.scale, "S", defaults.mapping.scale,
            "Metres in the scene per metre of the device");
  adder.add("--orientation", options.orientation, "QW,QX,QY,QZ", "1,0,0,0",
            "Rotation from the device's frame to the world frame; unit quaternion");
  adder.add("--lock", options.locks, "LIST", "none",
            "World axes along (tx,ty,tz) or about (rx,ry,rz) which the part cannot move, separated by "
            "commas, or none");
}

void take(const std::optional<double>& from, double& to) {
  if (from) to = *from;
}

void applyMode(const std::string& mode, HapticSettings& settings) {
  settings.mode = mode == "proxy" ? HapticMode::Proxy : HapticMode::Springs;
  if (mode == "spring") settings.springs.law = SpringLaw::Linear;
  if (mode == "printed") settings.springs.law = SpringLaw::Printed;
}

void applyCoupling(const HapticOptions& options, CouplingSettings& coupling) {
  take(options.couplingStiffness, coupling.stiffness);
  take(options.couplingDamping, coupling.damping);
  take(options.rotationalStiffness, coupling.rotationalStiffness);
  take(options.rotationalDamping, coupling.rotationalDamping);
  if (options.couplingStiffness || options.couplingDamping || options.rotationalStiffness ||
      options.rotationalDamping) {
    coupling.isAutomatic = false;
  }
}

void applyLocks(const std::string& text, WorkspaceMapping& mapping) {
  mapping.translationLocks = mapping.rotationLocks = {};
  if (text == "none") return;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view name = rest.substr(0, rest.find(','));
    const auto* const lock = std::find(kLocks.begin(), kLocks.end(), name);
    // A comma may not end the list either.
    if (lock == kLocks.end() || name.size() + 1 == rest.size()) break;
    const auto index = static_cast<std::size_t>(lock - kLocks.begin());
    (index < 3 ? mapping.translationLocks : mapping.rotationLocks)[index % 3] = true;
    if (name.size() == rest.size()) return;
    rest.remove_prefix(name.size() + 1);
  }
  throw UsageError("--lock", fmt::format("\"{}\" is not a list of axes", text),
                   "give some of tx, ty, tz, rx, ry and rz separated by commas, or none");
}

void applyTexts(const HapticOptions& options, HapticSettings& settings) {
  if (options.mode) applyMode(*options.mode, settings);
  if (options.locks) applyLocks(*options.locks, settings.mapping);
  if (options.gravity) {
    const auto [x, y, z] = parseNumbers<3>("--gravity", *options.gravity);
    settings.weight.gravity = {x, y, z};
  }
  if (options.orientation) {
    const auto [w, x, y, z] = parseNumbers<4>("--orientation", *options.orientation);
    settings.mapping.orientationOffset = {w, x, y, z};
  }
}

/// Same as checkHaptics(), but names the option.
void checkByOption(const HapticSettings& settings) {
  try {
    checkHaptics(settings);
  } catch (const UsageError& e) {
    for (const auto& [value, option] : kOptionOfValue) {
      if (value == e.where()) throw UsageError(option, e.problem(), e.remedy());
    }
    throw;
  }
}

}  // namespace

void addHapticOptions(CLI::App& command, HapticOptions& options, const HapticSettings* defaults) {
  OptionAdder adder(command, defaults != nullptr);
  const HapticSettings told = defaults != nullptr ? *defaults : HapticSettings{};
  addModeOptions(adder, options, told);
  addCouplingOptions(adder, options);
  addWeightOptions(adder, options);
  addMappingOptions(adder, options, told);
}

HapticSettings withOptions(HapticSettings settings, const HapticOptions& options) {
  applyTexts(options, settings);
  take(options.cutoff, settings.springs.cutoff);
  take(options.stiffness, settings.springs.stiffness);
  take(options.damping, settings.springs.damping);
  settings.springs.onePerArea = options.onePerArea.value_or(settings.springs.onePerArea);
  take(options.margin, settings.proxy.margin);
  take(options.friction, settings.proxy.friction);
  take(options.scale, settings.mapping.scale);
  applyCoupling(options, settings.coupling);
  settings.weight.hasWeight = options.hasWeight.value_or(settings.weight.hasWeight);
  settings.weight.hasInertia = options.hasInertia.value_or(settings.weight.hasInertia);
  checkByOption(settings);
  return settings;
}

}  // namespace nearfit::cli
