#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "tests/bench/machine.h"
#include "tests/stress/commands.h"
#include "tests/stress/oracle_campaign.h"
#include "tests/stress/oracle_pairs.h"

namespace nearfit::stress {
namespace {

struct OracleOptions {
  OracleRange range;
  std::size_t poses = 1'000'000;
  unsigned threads = 2;
  std::vector<std::string> pairs;
};

/// Lines of progress a run.
constexpr std::size_t kProgressLines = 50;

std::vector<test::BodyPair> chosenPairs(const std::vector<std::string>& names) {
  std::vector<test::BodyPair> all = oraclePairs(), chosen;
  if (names.empty()) return all;
  for (const std::string& name : names) {
    const auto it = std::ranges::find(all, name, &test::BodyPair::name);
    if (it == all.end()) {
      std::vector<std::string> known;
      for (const test::BodyPair& pair : all)
        known.push_back(pair.name);
      throw UsageError("--pairs", fmt::format("there is no pair \"{}\"", name),
                       fmt::format("choose of {}", fmt::join(known, ", ")));
    }
    chosen.push_back(*it);
  }
  return chosen;
}

void runOracle(const OracleOptions& options) {
  fmt::print("{}", bench::machineComment());
  std::fflush(stdout);
  const std::vector<test::BodyPair> pairs = chosenPairs(options.pairs);
  OracleRange range = options.range;
  range.count = (options.poses + pairs.size() - 1) / pairs.size();
  const std::size_t every = std::max<std::size_t>(range.count * pairs.size() / kProgressLines, 1);
  std::size_t shownFaults = 0, shownAt = 0;
  const OracleTally tally = runOracleCampaign(pairs, range, options.threads, [&](const OracleTally& sofar) {
    for (; shownFaults < sofar.faults.size(); ++shownFaults)
      fmt::print("{}\n", sofar.faults[shownFaults]);
    if (sofar.poses < shownAt + every) return;
    shownAt = sofar.poses;
    fmt::print(stderr, "{} poses, {} found, {} differences\n", sofar.poses, sofar.found, sofar.faults.size());
    std::fflush(stdout);
  });
  fmt::print(
      "{} poses of {} pairs, {} to {} of each, seed {}: {} minima and regions ({} regions, {} marginal); {} "
      "poses judged exactly, {} of them because double precision did not do; {} differences\n",
      tally.poses, pairs.size(), range.first, range.first + range.count - 1, range.seed, tally.found,
      tally.regions, tally.flagged, tally.judged, tally.differing, tally.faults.size());
  if (!tally.faults.empty())
    throw Error("oracle", fmt::format("{} differences", tally.faults.size()),
                "run one again with the options that its line begins with");
}

}  // namespace

void addOracleCommand(CLI::App& program) {
  const auto options = std::make_shared<OracleOptions>();
  CLI::App* command = program.add_subcommand("oracle",
                                             "Holds the sets of minima of twenty pairs of meshes at random "
                                             "and adversarial poses against brute force "
                                             "and, where that cannot decide, exact arithmetic.");
  command->add_option("--poses", options->poses, "Of all pairs together")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--seed", options->range.seed, "Another one gives other poses")->capture_default_str();
  command->add_option("--first", options->range.first, "Number of each pair's first pose: to go on")
      ->capture_default_str();
  command->add_option("--pairs", options->pairs, "Names of pairs, separated by commas")->delimiter(',');
  command->add_option("--threads", options->threads, "To run on")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command->callback([options] { runOracle(*options); });
}

}  // namespace nearfit::stress
