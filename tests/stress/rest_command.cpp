#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "tests/bench/machine.h"
#include "tests/bench/selection.h"
#include "tests/stress/commands.h"
#include "tests/stress/press_trial.h"

namespace nearfit::stress {
namespace {

/// A trial has so many ticks at least: until then the servo may still learn what its longest periods are, and
/// let the stiffness down for them. At 10 ms and lost ticks it did so for eleven seconds.
constexpr double kMinRestTicks = 3000.0;

struct RestOptions {
  double seconds = 6.0;
  std::vector<std::string> scenes{"all"}, modes;
  std::vector<double> rates;  ///< [Hz]; none: the usual periods.
};

/// A stiffness, and the device that it is tried on.
struct RestStiffness {
  double wished;   ///< [N/m]; 0: as stiff as the bound allows.
  double damping;  ///< Of the device [N s/m].
};

/// A device that bears so much at 1 kHz, with some to spare: 2 b / T.
RestStiffness borneAt1kHz(double stiffness) {
  constexpr double kSpare = 1.25, kPeriod = 1e-3;
  return {stiffness, kSpare * 0.5 * stiffness * kPeriod};
}

std::vector<RestStiffness> stiffnessesOf(StressMode mode) {
  constexpr double kUsual = DeviceLimits{}.damping;
  if (mode == StressMode::Proxy) {
    return {{1.0, kUsual}, {10.0, kUsual},      {100.0, kUsual},     {1000.0, kUsual},
            {0.0, kUsual}, borneAt1kHz(3000.0), borneAt1kHz(5000.0), borneAt1kHz(10000.0)};
  }
  return {{40.0, kUsual}, {200.0, kUsual}, {1000.0, kUsual}, {0.0, kUsual}};
}

std::vector<double> periodsOf(const RestOptions& options) {
  if (options.rates.empty()) return {0.2e-3, 0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3};
  std::vector<double> periods;
  for (const double rate : options.rates)
    periods.push_back(1.0 / rate);
  return periods;
}

struct RestCounts {
  int restless = 0, shaken = 0;
};

void tryOne(const PressScene& scene, const PressOptions& options, RestCounts& counts) {
  const PressResult r = press(scene, options);
  const bool isProxy = options.mode == StressMode::Proxy;
  const bool isCalm = isAtRest(r, options) && (r.isKept || !isProxy);
  counts.restless += isProxy && !isCalm ? 1 : 0;
  counts.shaken += isShaken(r) ? 1 : 0;
  fmt::print(
      "{},{},{},{:.4g},{:.4g},{:.3g},{:.4g},{},{},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.3g},{:.3g},{:."
      "3g},"
      "{},{},{}\n",
      nameOf(options.mode), scene.name,
      options.stiffness > 0.0 ? fmt::format("{}", options.stiffness) : "limit", r.stiffness, options.damping,
      1e3 * options.period, 1.0 / options.period, options.isRough ? 1 : 0, options.friction, 1e6 * r.handle,
      1e6 * r.shake, 1e3 * r.force, 1e3 * r.torque, r.meanForce, r.forceStep, r.energyGain, 1e6 * r.lag,
      r.springShare, r.isKept ? 1 : 0, isCalm ? 1 : 0, isShaken(r) ? 1 : 0);
  std::fflush(stdout);
}

void run(const RestOptions& options) {
  fmt::print("{}", bench::machineComment());
  std::fflush(stdout);
  const std::vector<StressMode> modes = stressModes(options.modes);
  fmt::print(
      "mode,scene,stiffness wished N/m,stiffness N/m,device damping N s/m,period ms,rate Hz,rough,friction,"
      "handle rms um,shake rms um,force rms mN,torque rms mN m,mean force N,largest force step N,energy gain "
      "J,lag um,"
      "spring share,kept,at rest,shaken\n");
  RestCounts counts;
  for (const StressMode mode : modes) {
    for (const PressScene& scene : bench::chosen(pressScenes(), options.scenes, "--scenes")) {
      for (const RestStiffness& stiffness : stiffnessesOf(mode)) {
        for (const double period : periodsOf(options)) {
          for (const bool isRough : {false, true}) {
            tryOne(scene,
                   {.stiffness = stiffness.wished,
                    .mode = mode,
                    .damping = stiffness.damping,
                    .period = period,
                    .isRough = isRough,
                    .friction = isRough ? 0.3 : 0.0,
                    .seconds = std::max(options.seconds, kMinRestTicks * period)},
                   counts);
          }
        }
      }
    }
  }
  if (counts.restless + counts.shaken > 0) {
    throw Error(
        "rest",
        fmt::format("{} trials of the proxy did not come to rest, or on the other side; {} hands were shaken",
                    counts.restless, counts.shaken),
        "look at their rows");
  }
}

}  // namespace

void addRestCommand(CLI::App& program) {
  const auto options = std::make_shared<RestOptions>();
  CLI::App* command = program.add_subcommand(
      "rest", "A hand that presses on contact scenes at all stiffnesses and periods comes to rest; CSV");
  command->add_option("--seconds", options->seconds, "Of each trial at least; the last is looked at")
      ->capture_default_str();
  command->add_option("--scenes", options->scenes, "With commas between")
      ->delimiter(',')
      ->capture_default_str();
  addModeOption(*command, options->modes);
  command
      ->add_option("--rates", options->rates,
                   "Of the servo [Hz], with commas between, instead of the usual periods")
      ->delimiter(',')
      ->check(CLI::Range(20.0, 10000.0));
  command->callback([options] { run(*options); });
}

}  // namespace nearfit::stress
