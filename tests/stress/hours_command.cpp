#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "tests/bench/machine.h"
#include "tests/stress/commands.h"
#include "tests/stress/long_run.h"

namespace nearfit::stress {
namespace {

void run(double hours) {
  fmt::print("{}", bench::machineComment());
  std::fflush(stdout);
  constexpr double kHour = 3600.0;
  const LongRunResult r = runLong(kHour * hours);
  fmt::print(
      "ticks,cycles,free drift m,contact drift m,late drift m,force drift N,energy drift J,growth bytes\n");
  fmt::print("{},{},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{}\n", r.ticks, r.cycles, r.freeDrift, r.contactDrift,
             r.lateDrift, r.forceDrift, r.energyDrift, r.memoryGrowth);
  if (r.freeDrift > 0.0 || r.contactDrift > kMaxDrift || r.memoryGrowth > kMaxGrowth)
    throw Error("hours", "the servo drifts or grows", "compare with a shorter run");
}

}  // namespace

void addHoursCommand(CLI::App& program) {
  const auto hours = std::make_shared<double>(8.0);
  CLI::App* command =
      program.add_subcommand("hours", "Simulated hours of servo: no drift, no growth of memory; CSV");
  command->add_option("--hours", *hours, "Simulated")->capture_default_str();
  command->callback([hours] { run(*hours); });
}

}  // namespace nearfit::stress
