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

void run(double seconds, const std::vector<std::string>& names) {
  fmt::print("{}", bench::machineComment());
  std::fflush(stdout);
  fmt::print(
      "scene,stiffness wished N/m,stiffness N/m,period ms,rough,friction,handle rms um,force rms mN,"
      "torque rms mN m,mean force N,kept,at rest\n");
  int restless = 0;
  for (const PressScene& scene : bench::chosen(pressScenes(), names, "--scenes")) {
    for (const double stiffness : {1.0, 10.0, 100.0, 1000.0, 0.0}) {
      for (const double period : {0.2e-3, 0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3}) {
        for (const bool isRough : {false, true}) {
          const double friction = isRough ? 0.3 : 0.0;
          const PressOptions options{.stiffness = stiffness,
                                     .period = period,
                                     .isRough = isRough,
                                     .friction = friction,
                                     .seconds = std::max(seconds, kMinRestTicks * period)};
          const PressResult r = press(scene, options);
          const bool isCalm = isAtRest(r, options) && r.isKept;
          restless += isCalm ? 0 : 1;
          fmt::print("{},{},{:.4g},{:.3g},{},{},{:.4g},{:.4g},{:.4g},{:.4g},{},{}\n", scene.name,
                     stiffness > 0.0 ? fmt::format("{}", stiffness) : "limit", r.stiffness, 1e3 * period,
                     isRough ? 1 : 0, friction, 1e6 * r.handle, 1e3 * r.force, 1e3 * r.torque, r.meanForce,
                     r.isKept ? 1 : 0, isCalm ? 1 : 0);
          std::fflush(stdout);
        }
      }
    }
  }
  if (restless > 0)
    throw Error("rest", fmt::format("{} trials did not come to rest, or on the other side", restless),
                "look at their rows");
}

}  // namespace

void addRestCommand(CLI::App& program) {
  const auto seconds = std::make_shared<double>(6.0);
  CLI::App* command = program.add_subcommand(
      "rest", "A hand that presses on contact scenes at all stiffnesses and periods comes to rest; CSV");
  command->add_option("--seconds", *seconds, "Of each trial at least; the last is looked at")
      ->capture_default_str();
  const auto names = std::make_shared<std::vector<std::string>>(1, "all");
  command->add_option("--scenes", *names, "With commas between")->delimiter(',')->capture_default_str();
  command->callback([seconds, names] { run(*seconds, *names); });
}

}  // namespace nearfit::stress
