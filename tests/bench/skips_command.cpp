#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/files/atomic_write.h"
#include "tests/bench/commands.h"
#include "tests/bench/machine.h"
#include "tests/bench/selection.h"
#include "tests/bench/skips.h"

namespace nearfit::bench {
namespace {

struct CommandOptions {
  std::vector<std::string> without{"all"};
  SkipOptions skips;
  std::filesystem::path csv;
};

std::string settingsComment(const SkipOptions& o) {
  return fmt::format("# path: {} poses, seed {}; {} rounds, turns of {} of which {} warm up, {} clock\n",
                     o.path.poses, o.path.seed, o.run.rounds, o.run.block, o.run.warmUp,
                     o.run.clock == BenchClock::Wall ? "wall" : "thread") +
         fmt::format("# built, loaded and opened {} times each, by the wall clock\n", o.repeats);
}

void runSkips(const CommandOptions& options) {
  const std::vector<SkipEntry> skips = chosen(allSkips(), options.without, "--without");
  if (options.skips.run.cpu) pinTo(*options.skips.run.cpu);
  const std::string machine = machineComment(options.csv) + settingsComment(options.skips);
  fmt::print("{}\n{}", machine, skipTableHeader());
  std::vector<SkipRow> rows;
  std::string lines;
  for (const SkipEntry& skip : skips) {
    for (const SkipRow& row : skip.measure(options.skips)) {
      fmt::print("{}", skipTableLine(row));
      std::fflush(stdout);
      lines += skipCsvLine(row);
      rows.push_back(row);
    }
  }
  if (!options.csv.empty()) {
    atomicWrite(options.csv,
                machine + fmt::format("# load at end: {}\n", loadAverages()) + skipCsvHeader() + lines);
  }
  checkSame(rows);
}

void addPathOptions(CLI::App& command, SkipOptions& o) {
  command.add_option("--count", o.path.poses, "Poses of the path, for queries and ticks")
      ->check(CLI::Range(20, 1'000'000))
      ->capture_default_str();
  command.add_option("--seed", o.path.seed, "Of the path")->capture_default_str();
  command.add_option("--block", o.run.block, "Questions with a skip before those without have their turn")
      ->check(CLI::Range(10, 1'000'000))
      ->capture_default_str();
  command.add_option("--repeat", o.run.rounds, "Times to walk the path")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--clock", o.run.clock, "wall, or thread: time on the processor alone")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, BenchClock>{{"wall", BenchClock::Wall}, {"thread", BenchClock::Thread}}));
}

void addSceneOptions(CLI::App& command, SkipOptions& o) {
  command.add_option("--builds", o.repeats, "Times to build, load or open")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--far", o.farParts, "Parts out of reach")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--instances", o.instances, "Parts that share a mesh")
      ->check(CLI::Range(2, 10'000))
      ->capture_default_str();
  command.add_option("--parts", o.sceneParts, "Of the scene of which few parts are shown")
      ->check(CLI::Range(4, 10'000))
      ->capture_default_str();
}

std::string footer() {
  std::string out = "Skips:\n";
  for (const SkipEntry& skip : allSkips())
    out += fmt::format("  {:<14}{}\n", skip.name, skip.description);
  return out + "Exit code 1 when answers differ with and without one.";
}

}  // namespace

void addSkipsCommand(CLI::App& program) {
  const auto options = std::make_shared<CommandOptions>();
  options->skips.path.poses = 1000;
  CLI::App* command = program.add_subcommand(
      "skips", "Times what is not computed: each skip as it is and turned off, in turns, answers compared.");
  command->add_option("--without", options->without, "Skips to turn off, with commas between; all by default")
      ->delimiter(',');
  addPathOptions(*command, options->skips);
  addSceneOptions(*command, options->skips);
  command->add_option("--csv", options->csv, "File for the table");
  command->footer(footer());
  command->callback([options] { runSkips(*options); });
}

}  // namespace nearfit::bench
