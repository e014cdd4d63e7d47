#include "tests/bench/run_rules.h"

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <unistd.h>

#include "core/base/error.h"

namespace nearfit::bench {
namespace {

/// A build or a test keeps a whole processor at work, what a quiet machine does besides far less.
constexpr double kBusyProcessors = 0.25;
/// Long enough that /proc/stat, which counts hundredths of a second, resolves a fiftieth of a processor.
constexpr std::chrono::milliseconds kWatch{500};

ProcessorTimes processorTimesNow() {
  std::ifstream stat("/proc/stat");
  return readProcessorTimes(stat);
}

}  // namespace

RunRules& runRules() {
  static RunRules rules;
  return rules;
}

ProcessorTimes readProcessorTimes(std::istream& stat) {
  std::string line, name;
  std::getline(stat, line);
  std::istringstream fields(line);
  double user = 0.0, nice = 0.0, system = 0.0, idle = 0.0, wait = 0.0, irq = 0.0, softIrq = 0.0, stolen = 0.0;
  fields >> name >> user >> nice >> system >> idle >> wait >> irq >> softIrq >> stolen;
  if (name != "cpu" || fields.fail()) return {};
  const double busy = user + nice + system + irq + softIrq + stolen;
  return {busy, busy + idle + wait};
}

double processorsAtWork(const ProcessorTimes& before, const ProcessorTimes& after, double processors) {
  const double all = after.all - before.all;
  return all > 0.0 ? processors * (after.busy - before.busy) / all : 0.0;
}

double othersAtWork() {
  const ProcessorTimes before = processorTimesNow();
  std::this_thread::sleep_for(kWatch);
  return processorsAtWork(before, processorTimesNow(), static_cast<double>(sysconf(_SC_NPROCESSORS_ONLN)));
}

bool isBusy(double processorsAtWork) {
  return processorsAtWork >= kBusyProcessors;
}

bool isForCommit(const std::filesystem::path& file, const std::filesystem::path& sources) {
  const auto whole = [](const std::filesystem::path& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path));
  };
  const std::filesystem::path within = whole(file).lexically_relative(whole(sources));
  return !within.empty() && *within.begin() != ".." && *within.begin() != "build";
}

void checkRepeatable(const std::filesystem::path& file, const std::filesystem::path& sources,
                     std::string_view revision, double atWork, bool allowsBusy) {
  if (file.empty() || !isForCommit(file, sources)) return;
  if (revision.ends_with("-dirty") || revision == "unknown") {
    throw Error(file.string(), fmt::format("results of revision {} cannot be repeated", revision),
                "commit, build anew and run again, or write to a folder outside the sources");
  }
  if (isBusy(atWork) && !allowsBusy) {
    throw Error(file.string(), fmt::format("other programs keep {:.1f} processors at work", atWork),
                "wait until they are done, or allow it with --allow-busy");
  }
}

}  // namespace nearfit::bench
