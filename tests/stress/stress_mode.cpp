#include "tests/stress/stress_mode.h"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"

namespace nearfit::stress {

const char* nameOf(StressMode mode) noexcept {
  switch (mode) {
    case StressMode::Proxy:
      return "proxy";
    case StressMode::Spring:
      return "spring";
    case StressMode::Printed:
      return "printed";
    case StressMode::Grouped:
      break;
  }
  return "grouped";
}

std::vector<StressMode> allStressModes() {
  return {StressMode::Proxy, StressMode::Spring, StressMode::Printed, StressMode::Grouped};
}

std::vector<StressMode> stressModes(const std::vector<std::string>& names) {
  const std::vector<StressMode> all = allStressModes();
  if (names.empty()) return all;
  std::vector<StressMode> chosen;
  for (const std::string& name : names) {
    const auto found = std::ranges::find_if(all, [&](StressMode mode) { return name == nameOf(mode); });
    if (found == all.end()) {
      throw UsageError("--mode", fmt::format("\"{}\" is not a mode", name),
                       "give some of proxy, spring, printed and grouped, with commas between");
    }
    chosen.push_back(*found);
  }
  return chosen;
}

void addModeOption(CLI::App& command, std::vector<std::string>& names) {
  command
      .add_option("--mode", names,
                  "proxy, spring, printed or grouped (spring with one for each area of contact), with commas "
                  "between; "
                  "all by default")
      ->delimiter(',');
}

void setMode(HapticSettings& settings, StressMode mode, double stiffness) {
  settings.mode = mode == StressMode::Proxy ? HapticMode::Proxy : HapticMode::Springs;
  settings.springs.law = mode == StressMode::Printed ? SpringLaw::Printed : SpringLaw::Linear;
  settings.springs.onePerArea = mode == StressMode::Grouped;
  settings.springs.stiffness = mode == StressMode::Printed ? stiffness / settings.springs.cutoff : stiffness;
}

}  // namespace nearfit::stress
