#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/path/path_search.h"
#include "tests/bench/commands.h"
#include "tests/bench/machine.h"
#include "tests/bench/suggest_row.h"
#include "tests/support/suggest_scenes.h"

namespace nearfit::bench {
namespace {

struct SuggestBenchOptions {
  std::filesystem::path csv;
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

/// Searches with each seed. A path that is found after the limit does not count.
SuggestRow measureScene(const test::SuggestScene& made, const SuggestBenchOptions& options) {
  SuggestRow row{.scene = made.name, .limit = options.seconds, .share = options.share};
  for (std::uint64_t seed = 1; seed <= options.seeds; ++seed) {
    PathSearchOptions search;
    search.seconds = options.seconds;
    search.seed = seed;
    const PathSearchResult result = searchPath(made.scene, made.goal, search);
    const bool isFound = result.end == PathSearchEnd::Found;
    row.add(isFound, result.seconds);
    fmt::print("{},{},{},{:.3f},{},{},{},{}\n", made.name, seed, isFound ? 1 : 0, result.seconds,
               isFound ? wordOf(result.method) : "-", result.path.poses.size(), result.motions, result.poses);
    std::fflush(stdout);
  }
  fmt::print("# {}: {} of {} found within {} s, median {:.2f} s, max {:.2f} s\n", made.name, row.found,
             row.seeds(), row.limit, row.median(), row.max());
  return row;
}

void runSuggestBench(const SuggestBenchOptions& options) {
  if (options.seeds == 0) throw UsageError("--seeds", "0 seeds measure nothing", "give at least 1");
  const std::string machine =
      machineComment(options.csv) +
      fmt::format("# searches of {} s; threads: as many as processors\n", options.seconds);
  fmt::print("{}\nscene,seed,found,seconds,method,poses,motions,tree_poses\n", machine);
  std::string lines, missed;
  for (const test::SuggestScene& made :
       {test::pegInHole(), test::pegBesideHole(), test::pipeOut(), test::pipeIn()}) {
    const SuggestRow row = measureScene(made, options);
    lines += suggestCsvLine(row);
    if (!row.isMet()) missed += fmt::format("{}{}", missed.empty() ? "" : ", ", made.name);
  }
  if (!options.csv.empty())
    atomicWrite(options.csv,
                machine + fmt::format("# load at end: {}\n", loadAverages()) + suggestCsvHeader() + lines);
  if (!missed.empty())
    throw Error(
        missed,
        fmt::format("less than {} of the seeds found a path within {} s", options.share, options.seconds),
        "see the rows above");
}

}  // namespace

void addSuggestCommand(CLI::App& program) {
  const auto options = std::make_shared<SuggestBenchOptions>();
  CLI::App* command = program.add_subcommand(
      "suggest",
      "Searches paths of a peg out of and into its hole, and of a bent pipe out of and "
      "into a plate, with one seed after another. Times are of the whole search on all "
      "processors. Exit code 1 if fewer seeds than --share find one in time.");
  command->add_option("--seeds", options->seeds, "Number of seeds, from 1")->capture_default_str();
  command->add_option("--seconds", options->seconds, "Time of each search [s]")->capture_default_str();
  command->add_option("--share", options->share, "Share of the seeds that have to find a path")
      ->capture_default_str();
  command->add_option("--csv", options->csv, "File for the table: a row for each puzzle");
  command->callback([options] { runSuggestBench(*options); });
}

}  // namespace nearfit::bench
