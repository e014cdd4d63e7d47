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
      .add(
          "--mode", options.mode, "MODE", "proxy",
          "proxy: the part stops where it touches. spring: it goes where the hand is, each minimum pushes as "
          "a spring. printed: the same with the law as the paper prints it")
      ->check(CLI::IsMember({"proxy", "spring", "printed"}));
  adder.add("--cutoff", options.cutoff, "METRES", defaults.springs.cutoff,
            "How far minima are looked for, and rest length of the springs [m]");
  adder.add("--stiffness", options.stiffness, "K", defaults.springs.stiffness,
            "Of each spring [N/m], or [N/m^2] in the printed mode");
  adder.add("--damping", options.damping, "B", defaults.springs.damping, "Of each spring [N s/m]");
  adder.add("--margin", options.margin, "METRES", "1 % of the cutoff",
            "Proxy: the distance at which contact holds [m]");
  adder.add("--friction", options.friction, "MU", defaults.proxy.friction, "Proxy: Coulomb's coefficient");
}

void addCouplingOptions(OptionAdder& adder, HapticOptions& options) {
  constexpr const char* kAutomatic = "automatic";
  adder.add("--coupling-stiffness", options.couplingStiffness, "K", kAutomatic,
            "Proxy: of the spring between hand and part [N/m]");
  adder.add("--coupling-damping", options.couplingDamping, "B", kAutomatic, "Proxy: its damping [N s/m]");
  adder.add("--rotational-stiffness", options.rotationalStiffness, "K", kAutomatic,
            "Proxy: of the same for rotation [N m/rad]");
  adder.add("--rotational-damping", options.rotationalDamping, "B", kAutomatic,
            "Proxy: its damping [N m s/rad]");
}

void addWeightOptions(OptionAdder& adder, HapticOptions& options) {
  adder.addFlag("--weight,!--no-weight", options.hasWeight, "The part hangs in the hand");
  adder.addFlag("--inertia,!--no-inertia", options.hasInertia, "Proxy: the part resists being accelerated");
  adder.add("--gravity", options.gravity, "X,Y,Z", "0,0,-9.80665", "In the world frame [m/s^2]");
}

void addMappingOptions(OptionAdder& adder, HapticOptions& options, const HapticSettings& defaults) {
  adder.add("--scale", options.scale, "S", defaults.mapping.scale,
            "Metres in the scene to a metre of the device");
  adder.add("--orientation", options.orientation, "QW,QX,QY,QZ", "1,0,0,0",
            "Turns the device's frame into the world's; unit quaternion");
  adder.add("--lock", options.locks, "LIST", "none",
            "World axes along (tx,ty,tz) and about (rx,ry,rz) which the part stays, with commas between, or "
            "none");
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
  throw UsageError("--lock", fmt::format("\"{}\" is no list of axes", text),
                   "give some of tx, ty, tz, rx, ry and rz with commas between, or none");
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
