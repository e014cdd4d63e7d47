#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <numeric>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "tests/bench/bench_clock.h"
#include "tests/bench/machine.h"
#include "tests/stress/commands.h"
#include "tests/stress/hand_run.h"
#include "tests/stress/stress_scene.h"
#include "tests/stress/tick_shares.h"
#include "tests/support/places.h"

namespace nearfit::stress {
namespace {

struct HandOptions {
  std::vector<std::string> scenes, modes;
  std::uint64_t ticks = 200000, seed = 1;
  std::uint64_t certifyEvery = 1;  ///< Each so many-th pose; 0: none.
  unsigned threads = 1;
};

constexpr const char* kColumns =
    "mode,scene,ticks,certified,meetings,in contact,starved,waiting,shortened,refused,most work,quaternion "
    "error,"
    "energy gain J,ledger error,largest force step N,lag m,springs held,us a tick,failure\n";

/// A scene's row of the table.
struct Row {
  HandRunResult result;
  double seconds = 0.0;  ///< Of a processor.
  bool isDone = false;
};

void print(StressMode mode, const std::string& name, const Row& row) {
  const HandRunResult& r = row.result;
  const TickExtremes& e = r.extremes;
  const auto ticks = static_cast<double>(std::max<std::uint64_t>(r.ticks, 1));
  fmt::print("{},{},{},{},{},{:.3f},{},{},{},{},{},{:.2g},{:.3g},{:.2g},{:.3g},{:.3g},{},{:.1f},{}\n",
             nameOf(mode), name, r.ticks, r.certified, r.meetings, static_cast<double>(e.inContact) / ticks,
             e.starved, e.waiting, e.shortened, e.refused, e.work, e.quaternionError, r.energyGain,
             r.ledgerError, e.forceStep, e.lag, e.heldTicks, 1e6 * row.seconds / ticks,
             r.failure.value_or(""));
  std::fflush(stdout);
}

Row runScene(const StressEntry& entry, const HandRunOptions& options) {
  const StressScene scene = entry.make();
  const double start = bench::secondsBy(bench::BenchClock::Thread);
  Row row{runHand(scene, options), 0.0, true};
  row.seconds = bench::secondsBy(bench::BenchClock::Thread) - start;
  return row;
}

std::vector<std::uint64_t> ticksOf(const std::vector<StressEntry>& scenes, std::uint64_t total) {
  std::vector<double> costs;
  for (const StressEntry& entry : scenes)
    costs.push_back(entry.cost);
  return shareTicks(costs, total);
}

/// Indices of the scenes, those first that take longest: none of them is left to one thread at the end.
std::vector<std::size_t> longestFirst(const std::vector<StressEntry>& scenes,
                                      const std::vector<std::uint64_t>& ticks) {
  const auto timeOf = [&](std::size_t i) { return scenes[i].cost * static_cast<double>(ticks[i]); };
  std::vector<std::size_t> order(scenes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), timeOf);
  return order;
}

/// Rows are printed in the order of the scenes, each as soon as those before it are.
std::vector<Row> runScenes(const std::vector<StressEntry>& scenes, const HandOptions& options,
                           StressMode mode) {
  const std::vector<std::uint64_t> ticks = ticksOf(scenes, options.ticks);
  const std::vector<std::size_t> order = longestFirst(scenes, ticks);
  std::vector<Row> rows(scenes.size());
  std::atomic<std::size_t> next{0};
  std::size_t printed = 0;
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t k = next++; k < scenes.size(); k = next++) {
      const std::size_t i = order[k];
      Row row = runScene(scenes[i], {ticks[i], options.seed, options.certifyEvery, mode});
      const std::lock_guard lock(mutex);
      rows[i] = std::move(row);
      for (; printed < rows.size() && rows[printed].isDone; ++printed)
        print(mode, scenes[printed].name, rows[printed]);
    }
  };
  std::vector<std::jthread> others;
  for (unsigned i = 1; i < options.threads; ++i)
    others.emplace_back(work);
  work();
  others.clear();
  return rows;
}

void run(const HandOptions& options) {
  fmt::print("{}", bench::machineComment());
  std::fflush(stdout);
  const std::vector<StressEntry> scenes = chosenScenes(stressScenes(test::sharedFolder()), options.scenes);
  const std::vector<StressMode> modes = stressModes(options.modes);
  fmt::print("{}", kColumns);
  std::ptrdiff_t failures = 0;
  for (const StressMode mode : modes) {
    const std::vector<Row> rows = runScenes(scenes, options, mode);
    failures += std::ranges::count_if(rows, [](const Row& row) { return row.result.failure.has_value(); });
  }
  if (failures > 0) {
    throw Error("hand", fmt::format("{} of {} scenes failed", failures, modes.size() * scenes.size()),
                "run each again by its name with the same seed and its number of ticks");
  }
}

}  // namespace

void addHandCommand(CLI::App& program) {
  const auto options = std::make_shared<HandOptions>();
  CLI::App* command =
      program.add_subcommand("hand", "An adversarial hand, and exact checks of where the part goes");
  command->add_option("--scenes", options->scenes, "Names, with commas; all by default")->delimiter(',');
  command->add_option("--ticks", options->ticks, "Of all scenes together, in each mode")
      ->capture_default_str();
  addModeOption(*command, options->modes);
  command->add_option("--threads", options->threads, "Scenes at a time; results are the same")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--seed", options->seed)->capture_default_str();
  command
      ->add_option("--certify", options->certifyEvery, "Poses that are certified: every, none, or each N-th")
      ->transform(CLI::Transformer(std::map<std::string, std::string>{{"every", "1"}, {"none", "0"}}))
      ->default_str("every");
  command->callback([options] { run(*options); });
}

}  // namespace nearfit::stress
