#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/path/path_bodies.h"
#include "core/path/path_search.h"
#include "tests/bench/commands.h"
#include "tests/bench/machine.h"
#include "tests/bench/proven_path.h"
#include "tests/bench/selection.h"
#include "tests/bench/suggest_row.h"
#include "tests/support/suggest_scenes.h"

namespace nearfit::bench {
namespace {

struct SuggestBenchOptions {
  std::filesystem::path csv;
  std::vector<std::string> scenes{"all"};
  std::uint64_t seeds = 10;
  double seconds = 30.0;
  /// Share of the seeds of each scene that have to find a path.
  double share = 0.9;
  /// Random places on each path that are looked at.
  std::size_t places = 20'000;
};

struct SuggestEntry {
  std::string name;
  std::function<test::SuggestScene()> make;
};

std::vector<SuggestEntry> suggestEntries() {
  return {{"peg out", test::pegInHole},
          {"peg in", test::pegBesideHole},
          {"pipe out", test::pipeOut},
          {"pipe in", test::pipeIn}};
}

/// Seed of the random places.
constexpr std::uint64_t kPlaceSeed = 1;

SuggestedPath searchAndCheck(const test::SuggestScene& made, const SuggestBenchOptions& options,
                             std::uint64_t seed) {
  PathSearchOptions search;
  search.seconds = options.seconds;
  search.seed = seed;
  const PathSearchResult result = searchPath(made.scene, made.goal, search);
  SuggestedPath path{
      .isSaidFound = result.end == PathSearchEnd::Found, .seconds = result.seconds, .method = result.method};
  if (path.isSaidFound) {
    path.proof = proveAndVerify(made.scene, result.path, result.separation);
    path.looks = testPlaces(result.path, pathBodies(made.scene, result.path), options.places, kPlaceSeed);
  }
  fmt::print("{},{},{},{:.3f},{},{},{},{},{},{},{},{},{}\n", made.name, seed, path.isSaidFound ? 1 : 0,
             path.seconds, path.isSaidFound ? wordOf(path.method) : "-", result.path.poses.size(),
             result.motions, result.poses, path.proof.isCertified ? 1 : 0, path.proof.isVerified ? 1 : 0,
             path.looks.looks, path.looks.tested, path.looks.meetings);
  if (path.isSaidFound && !path.isConfirmed())
    fmt::print("# {}, seed {}: {} {}\n", made.name, seed, path.proof.problem, path.looks.firstMeeting);
  std::fflush(stdout);
  return path;
}

/// Searches with each seed. A path that is found after the limit, or is not confirmed, does not count.
SuggestRow measureScene(const test::SuggestScene& made, const SuggestBenchOptions& options) {
  SuggestRow row{.scene = made.name, .limit = options.seconds, .share = options.share};
  for (std::uint64_t seed = 1; seed <= options.seeds; ++seed)
    row.add(searchAndCheck(made, options, seed));
  fmt::print("# {}: {} of {} found within {} s, median {:.2f} s, max {:.2f} s\n", made.name, row.found,
             row.seeds(), row.limit, row.median(), row.max());
  return row;
}

void runSuggestBench(const SuggestBenchOptions& options) {
  if (options.seeds == 0) throw UsageError("--seeds", "0 seeds measure nothing", "give at least 1");
  if (options.places == 0) throw UsageError("--random", "without places no path counts", "give at least 1");
  const std::string machine =
      machineComment(options.csv) +
      fmt::format(
          "# searches of {} s; {} random places on each path, seed {}; threads: as many as processors\n",
          options.seconds, options.places, kPlaceSeed);
  fmt::print(
      "{}\nscene,seed,found,seconds,method,poses,motions,tree_poses,certified,verified,looks,tested,"
      "meetings\n",
      machine);
  std::string lines, missed;
  for (const SuggestEntry& entry : chosen(suggestEntries(), options.scenes, "--scenes")) {
    const SuggestRow row = measureScene(entry.make(), options);
    lines += suggestCsvLine(row);
    if (!row.isMet()) missed += fmt::format("{}{}", missed.empty() ? "" : ", ", entry.name);
  }
  if (!options.csv.empty())
    atomicWrite(options.csv,
                machine + fmt::format("# load at end: {}\n", loadAverages()) + suggestCsvHeader() + lines);
  if (!missed.empty())
    throw Error(missed,
                fmt::format("less than {} of the seeds found a path within {} s, or a path is not confirmed",
                            options.share, options.seconds),
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
  command
      ->add_option("--scenes", options->scenes,
                   "Puzzles, with commas between: peg out, peg in, pipe out, pipe in")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--seeds", options->seeds, "Number of seeds, from 1")->capture_default_str();
  command->add_option("--seconds", options->seconds, "Time of each search [s]")->capture_default_str();
  command->add_option("--share", options->share, "Share of the seeds that have to find a path")
      ->capture_default_str();
  command->add_option("--random", options->places, "Number of random places on each path")
      ->capture_default_str();
  command->add_option("--csv", options->csv, "File for the table: a row for each puzzle");
  command->callback([options] { runSuggestBench(*options); });
}

}  // namespace nearfit::bench
