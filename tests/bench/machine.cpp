#include "tests/bench/machine.h"

#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <sstream>
#include <string_view>

#include "git_revision.h"
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "tests/bench/query_method.h"
#include "tests/bench/run_rules.h"

namespace nearfit::bench {
namespace {

/// Value of a line "name : value" in a file of /proc; empty when there is none.
std::string valueIn(const char* file, std::string_view name) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || !line.starts_with(name)) continue;
    const std::size_t begin = line.find_first_not_of(" \t", colon + 1);
    return begin == std::string::npos ? std::string() : line.substr(begin);
  }
  return {};
}

/// The processor's flags that say which vector instructions it has.
std::string vectorFlags() {
  std::istringstream flags(valueIn("/proc/cpuinfo", "flags"));
  std::string chosen;
  for (std::string flag; flags >> flag;) {
    const bool isVector = flag.starts_with("sse") || flag.starts_with("avx") || flag == "fma" ||
                          flag == "ssse3" || flag == "f16c" || flag.starts_with("bmi");
    if (isVector) chosen += (chosen.empty() ? "" : " ") + flag;
  }
  return chosen;
}

std::string kernel() {
  utsname name{};
  uname(&name);
  return fmt::format("{} {} {}", name.sysname, name.release, name.machine);
}

}  // namespace

std::string loadAverages() {
  std::array<double, 3> load{};
  getloadavg(load.data(), 3);
  return fmt::format("{:.2f} {:.2f} {:.2f}", load[0], load[1], load[2]);
}

std::vector<std::pair<std::string, std::string>> machineDescription() {
  return {
      {"processor", fmt::format("{} ({} available)", valueIn("/proc/cpuinfo", "model name"),
                                sysconf(_SC_NPROCESSORS_ONLN))},
      {"vector instructions", vectorFlags()},
      {"cache", valueIn("/proc/cpuinfo", "cache size")},
      {"memory", valueIn("/proc/meminfo", "MemTotal")},
      {"kernel", kernel()},
      {"compiler", "GCC-compatible " __VERSION__},
      {"flags", NEARFIT_BENCH_FLAGS},
      {"revision", kGitRevision},
      {"peers", peerDescription()},
      {"command", runRules().command},
      {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
      {"load at start", loadAverages()},
  };
}

std::string machineComment(const std::filesystem::path& file) {
  const double atWork = othersAtWork();
  checkRepeatable(file, NEARFIT_SOURCE_DIR, kGitRevision, atWork, runRules().allowsBusy);
  std::string text;
  if (isBusy(atWork)) {
    text = fmt::format("# busy machine: other programs kept {:.1f} of {} processors at work before the run\n",
                       atWork, sysconf(_SC_NPROCESSORS_ONLN));
  }
  for (const auto& [name, value] : machineDescription())
    text += fmt::format("# {}: {}\n", name, value);
  return text;
}

}  // namespace nearfit::bench
