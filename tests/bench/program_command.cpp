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
#include "tests/bench/machine.h"
#include "tests/bench/step_run.h"

namespace nearfit::bench {
namespace {

/// Up to which the program's answers may differ from exact ones, as a fraction of the lengths in play.
constexpr double kAgreement = 1e-9;

struct ProgramOptions {
  StepRunOptions run;
  std::filesystem::path csv;
};

std::string settingsComment(const StepRunOptions& o) {
  return fmt::format(
      "# problems: {} of each kind, seed {}; reach {} margins; times: {} clock, all of {} rounds\n",
      o.problems, o.seed, o.reachMargins, o.clock == BenchClock::Wall ? "wall" : "thread", o.rounds);
}

void checkAll(const std::vector<StepRunRow>& rows) {
  for (const StepRunRow& row : rows) {
    // Those may end before they have settled.
    if (row.method == "gauss-seidel" || row.method == "nearfit-friction" ||
        (row.differs <= kAgreement && row.settled == 1.0))
      continue;
    throw Error(fmt::format("{}, {} rows", row.kind, row.rows),
                fmt::format("\"{}\" and the program of the step differ, or one is not solved", row.method),
                "find the problem, for its exactness is lost");
  }
}

void runProgram(const ProgramOptions& options) {
  const std::string machine = machineComment(options.csv) + settingsComment(options.run);
  fmt::print("{}", machine);
  const std::vector<StepRunRow> rows = runSteps(options.run);
  fmt::print("Times in us.\n{}", stepRunTable(rows));
  if (!options.csv.empty())
    atomicWrite(options.csv, machine + fmt::format("# load at end: {}\n", loadAverages()) + stepRunCsv(rows));
  checkAll(rows);
}

}  // namespace

void addProgramCommand(CLI::App& program) {
  const auto options = std::make_shared<ProgramOptions>();
  StepRunOptions& run = options->run;
  CLI::App* command = program.add_subcommand(
      "program", "Times the quadratic program of the proxy's step on generated contacts.");
  command->add_option("--rows", run.rows, "Numbers of rows, with commas between")
      ->delimiter(',')
      ->check(CLI::Range(std::size_t{0}, StepRows::kDefaultCapacity))
      ->capture_default_str();
  command->add_option("--count", run.problems, "Problems of each kind and number of rows")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--reach", run.reachMargins, "Farthest that a point may move, in margins")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--seed", run.seed, "Of the problems")->capture_default_str();
  command->add_option("--repeat", run.rounds, "Times to solve each")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--clock", run.clock, "wall, or thread: time on the processor alone")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, BenchClock>{{"wall", BenchClock::Wall}, {"thread", BenchClock::Thread}}));
  command->add_option("--csv", options->csv, "File for the table");
  command->callback([options] { runProgram(*options); });
}

}  // namespace nearfit::bench
