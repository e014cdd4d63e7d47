#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "tests/bench/machine.h"
#include "tests/stress/commands.h"
#include "tests/stress/long_run.h"

namespace nearfit::stress {
namespace {

void run(double hours, const std::vector<std::string>& modes) {
  fmt::print("{}", bench::machineComment());
  std::fflush(stdout);
  constexpr double kHour = 3600.0;
  fmt::print(
      "mode,ticks,cycles,free drift m,contact drift m,late drift m,force drift N,energy drift J,growth "
      "bytes\n");
  int drifting = 0;
  for (const StressMode mode : stressModes(modes)) {
    const LongRunResult r = runLong(kHour * hours, mode);
    fmt::print("{},{},{},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{}\n", nameOf(mode), r.ticks, r.cycles,
               r.freeDrift, r.contactDrift, r.lateDrift, r.forceDrift, r.energyDrift, r.memoryGrowth);
    const bool isSpring = mode != StressMode::Proxy;
    drifting += r.freeDrift > 0.0 || r.contactDrift > kMaxDrift || r.memoryGrowth > kMaxGrowth ||
                        (isSpring && r.forceDrift > kMaxForceDrift)
                    ? 1
                    : 0;
  }
  if (drifting > 0) throw Error("hours", "the servo drifts or grows", "compare with a shorter run");
}

}  // namespace

void addHoursCommand(CLI::App& program) {
  const auto hours = std::make_shared<double>(8.0);
  CLI::App* command =
      program.add_subcommand("hours", "Simulated hours of servo: no drift, no growth of memory; CSV");
  command->add_option("--hours", *hours, "Simulated")->capture_default_str();
  const auto modes = std::make_shared<std::vector<std::string>>();
  addModeOption(*command, *modes);
  command->callback([hours, modes] { run(*hours, *modes); });
}

}  // namespace nearfit::stress
