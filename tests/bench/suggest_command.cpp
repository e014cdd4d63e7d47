#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/path/path_search.h"
#include "tests/bench/commands.h"
#include "tests/support/suggest_scenes.h"

namespace nearfit::bench {
namespace {

struct SuggestBenchOptions {
  std::uint64_t seeds = 10;
  double seconds = 30.0;
  /// Share of the seeds of each scene that have to find a path.
  double share = 0.9;
};

const char* wordOf(PathSearchMethod method) {
  switch (method) {
    case PathSearchMethod::Straight:
      return "straight";
    case PathSearchMethod::Sliding:
      return "sliding";
    case PathSearchMethod::SlidingTrees:
      return "sliding_trees";
    case PathSearchMethod::ConnectedTrees:
      break;
  }
  return "connected_trees";
}

/// Searches with each seed; returns how many found a path.
std::uint64_t measureScene(const test::SuggestScene& made, const SuggestBenchOptions& options) {
  std::vector<double> times;
  std::uint64_t found = 0;
  for (std::uint64_t seed = 1; seed <= options.seeds; ++seed) {
    PathSearchOptions search;
    search.seconds = options.seconds;
    search.seed = seed;
    const PathSearchResult result = searchPath(made.scene, made.goal, search);
    const bool isFound = result.end == PathSearchEnd::Found;
    found += isFound ? 1 : 0;
    times.push_back(result.seconds);
    fmt::print("{},{},{},{:.3f},{},{},{},{}\n", made.name, seed, isFound ? 1 : 0, result.seconds,
               isFound ? wordOf(result.method) : "-", result.path.poses.size(), result.motions, result.poses);
    std::fflush(stdout);
  }
  std::ranges::sort(times);
  fmt::print("# {}: {} of {} found, median {:.2f} s, max {:.2f} s\n", made.name, found, options.seeds,
             times[times.size() / 2], times.back());
  return found;
}

void runSuggestBench(const SuggestBenchOptions& options) {
  if (options.seeds == 0) throw UsageError("--seeds", "0 seeds measure nothing", "give at least 1");
  fmt::print("scene,seed,found,seconds,method,poses,motions,tree_poses\n");
  std::string missed;
  for (const test::SuggestScene& made :
       {test::pegInHole(), test::pegBesideHole(), test::pipeOut(), test::pipeIn()}) {
    const std::uint64_t found = measureScene(made, options);
    if (static_cast<double>(found) < options.share * static_cast<double>(options.seeds))
      missed += fmt::format("{}{}", missed.empty() ? "" : ", ", made.name);
  }
  if (!missed.empty())
    throw Error(missed, fmt::format("less than {} of the seeds found a path", options.share),
                "see the rows above");
}

}  // namespace

void addSuggestCommand(CLI::App& program) {
  const auto options = std::make_shared<SuggestBenchOptions>();
  CLI::App* command = program.add_subcommand(
      "suggest",
      "Searches paths of a peg out of and into its hole, and of a bent pipe out of and "
      "into a plate, with one seed after another. Times are of the whole search on all "
      "processors. Exit code 1 if fewer seeds than --share find one.");
  command->add_option("--seeds", options->seeds, "Number of seeds, from 1")->capture_default_str();
  command->add_option("--seconds", options->seconds, "Time of each search [s]")->capture_default_str();
  command->add_option("--share", options->share, "Share of the seeds that have to find a path")
      ->capture_default_str();
  command->callback([options] { runSuggestBench(*options); });
}

}  // namespace nearfit::bench
