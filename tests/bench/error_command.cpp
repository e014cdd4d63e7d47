#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "tests/bench/commands.h"
#include "tests/bench/error_run.h"
#include "tests/bench/machine.h"
#include "tests/bench/selection.h"

namespace nearfit::bench {
namespace {

struct ErrorOptions {
  ErrorRunOptions run;
  std::vector<std::string> pairs{"all"}, methods{"all"};
  std::filesystem::path csv;
  bool isList = false;
};

void printLists(const std::vector<ErrorPair>& pairs, const std::vector<ErrorMethodEntry>& methods) {
  fmt::print("pairs:\n");
  for (const ErrorPair& pair : pairs)
    fmt::print("  {:<22}{}\n", pair.name, pair.description);
  fmt::print("methods:\n");
  for (const ErrorMethodEntry& method : methods)
    fmt::print("  {:<22}{}\n", method.name, method.description);
}

std::string settingsComment(const ErrorRunOptions& o) {
  return fmt::format(
      "# poses: {} of each pair, seed {}; times: {} clock, turns of {} poses; springs push with 1 N when "
      "pressed all "
      "the way; peers: {}\n",
      o.poses, o.seed, o.clock == BenchClock::Wall ? "wall" : "thread", o.block, peerDescription());
}

void checkExactOnes(const std::vector<ErrorRow>& rows) {
  for (const ErrorRow& row : rows) {
    if (row.differing == 0) continue;
    throw Error(fmt::format("{}, edges of {:.4g} m", row.pair, row.edge),
                fmt::format("\"{}\" has other minima than the first exact method at {} of {} poses",
                            row.method, row.differing, row.poses),
                "find the pose, for its exactness is lost");
  }
}

void runError(const ErrorOptions& options) {
  if (options.isList) return printLists(errorPairs(), allErrorMethods());
  const std::vector<ErrorMethodEntry> methods = chosen(allErrorMethods(), options.methods, "--methods");
  const std::vector<ErrorPair> pairs = chosen(errorPairs(), options.pairs, "--pairs");
  const std::string machine = machineComment(options.csv) + settingsComment(options.run);
  fmt::print("{}Times in us, lengths in m, errors root mean square.\n{}", machine, errorTableHeader());
  std::vector<ErrorRow> rows;
  std::string csv;
  for (const ErrorPair& pair : pairs) {
    const std::vector<ErrorRow> more = runErrors(pair, methods, options.run, [](const ErrorRow& row) {
      fmt::print("{}", errorTableLine(row));
      std::fflush(stdout);
    });
    rows.insert(rows.end(), more.begin(), more.end());
  }
  for (const ErrorRow& row : rows)
    csv += errorCsvLine(row);
  if (!options.csv.empty()) {
    atomicWrite(options.csv,
                machine + fmt::format("# load at end: {}\n", loadAverages()) + errorCsvHeader() + csv);
  }
  checkExactOnes(rows);
}

}  // namespace

void addErrorCommand(CLI::App& program) {
  const auto options = std::make_shared<ErrorOptions>();
  ErrorRunOptions& run = options->run;
  CLI::App* command = program.add_subcommand(
      "error", "Measures run time against error on tessellated solids whose minima are known from formulas.");
  command->add_flag("--list", options->isList, "Say which pairs and methods there are, and measure nothing");
  command->add_option("--pairs", options->pairs, "Pairs of solids, with commas between")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--methods", options->methods, "Methods, with commas between")
      ->delimiter(',')
      ->capture_default_str();
  command
      ->add_option("--fineness", run.finenesses, "How many times finer than the coarsest mesh, each in turn")
      ->delimiter(',')
      ->check(CLI::Range(1U, 256U))
      ->capture_default_str();
  command->add_option("--poses", run.poses, "Poses of each pair")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--seed", run.seed, "Of the poses")->capture_default_str();
  command->add_option("--block", run.block, "Poses that a method answers before the next has its turn")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--clock", run.clock, "wall, or thread: time on the processor alone (the default)")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, BenchClock>{{"wall", BenchClock::Wall}, {"thread", BenchClock::Thread}}));
  command->add_option("--csv", options->csv, "File for the table");
  command->callback([options] { runError(*options); });
}

}  // namespace nearfit::bench
