#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "tests/bench/machine.h"
#include "tests/stress/commands.h"
#include "tests/stress/stiffness_limit.h"

namespace nearfit::stress {
namespace {

int printLimits(StressMode mode) {
  int beyond = 0;
  for (const double mass : {0.05, 0.2}) {
    for (const double damping : {0.2, 0.5, 1.0, 2.0, 5.0}) {
      for (const double period : {0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3}) {
        for (const double share : {0.0, 0.2}) {
          const LeaningDevice device{mass, damping, period, share * damping, mode};
          const double simulated = simulatedLimit(device), enforced = enforcedBound(device);
          beyond += isCalm(device, enforced) ? 0 : 1;
          fmt::print("{},{},{},{:.3g},{:.4g},{},{:.5g},{:.5g},{:.5g},{:.4g}\n", nameOf(mode), mass, damping,
                     1e3 * period, 1.0 / period, share * damping, simulated, exactLimit(device), enforced,
                     simulated / enforced);
          std::fflush(stdout);
        }
      }
    }
  }
  return beyond;
}

void run(const std::vector<std::string>& modes) {
  fmt::print("{}", bench::machineComment());
  std::fflush(stdout);
  fmt::print(
      "mode,mass kg,damping N s/m,period ms,rate Hz,coupling damping N s/m,simulated N/m,exact N/m,enforced "
      "N/m,"
      "simulated by enforced\n");
  int beyond = 0;
  for (const StressMode mode : stressModes(modes))
    beyond += printLimits(mode);
  if (beyond > 0) {
    throw Error("limit", fmt::format("{} bounds are beyond what is stable", beyond),
                "look at the rows whose last column is not above one");
  }
}

}  // namespace

void addLimitCommand(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "limit", "The stiffness from which on a leaning device is shaken, beside what is enforced; CSV");
  const auto modes = std::make_shared<std::vector<std::string>>();
  addModeOption(*command, *modes);
  command->callback([modes] { run(*modes); });
}

}  // namespace nearfit::stress
