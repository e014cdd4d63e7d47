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
#include "tests/bench/feel_certified.h"
#include "tests/bench/feel_cost.h"
#include "tests/bench/feel_curved.h"
#include "tests/bench/feel_dense.h"
#include "tests/bench/feel_sliding.h"
#include "tests/bench/feel_smoothness.h"
#include "tests/bench/feel_tessellation.h"
#include "tests/bench/machine.h"
#include "tests/bench/selection.h"

namespace nearfit::bench {
namespace {

struct FeelOptions {
  std::filesystem::path shared, csv;
  std::vector<std::string> groups{"smoothness",   "pairs", "conforming", "sliding",
                                  "tessellation", "dense", "curved"};
  std::vector<std::string> scenes{"all"}, pairs{"all"};
  SmoothnessOptions smoothness;
  SlidingOptions sliding;
  CostOptions cost;
  SeekingPathOptions seeking;
  double marginOfCutoff = 0.01, pressOfCutoff = 0.2;
  std::vector<std::uint32_t> finenesses{1, 2, 4, 8};
  std::vector<double> speeds{0.1, 1.0}, slidingSpeeds{0.1, 0.5, 1.0};
};

std::vector<FeelEntry> feelScenes(const FeelOptions& options) {
  std::vector<FeelEntry> entries = generatedFeelScenes();
  for (FeelEntry& entry : sharedFeelScenes(options.shared))
    entries.push_back(std::move(entry));
  return chosen(entries, options.scenes, "--scenes");
}

/// Pairs of the paper's meshes where they are; else pairs of generated meshes like them.
std::vector<SceneEntry> pairScenes(const FeelOptions& options) {
  const bool isShared = !options.shared.empty();
  std::vector<SceneEntry> entries = isShared ? sharedScenes(options.shared) : generatedScenes();
  const char* const prefix = isShared ? "paper-" : "";
  if (options.pairs == std::vector<std::string>{"all"}) {
    // The bodies of tens of thousands of triangles are none of the paper's.
    std::erase_if(entries, [&](const SceneEntry& entry) {
      return !entry.name.starts_with(prefix) || entry.name.starts_with("organic-70k") ||
             entry.name.starts_with("organic-1m");
    });
  }
  return chosen(entries, options.pairs, "--pairs");
}

void say(std::vector<FeelRow>& all, const std::vector<FeelRow>& rows) {
  fmt::print("{}", feelTable(rows));
  std::fflush(stdout);
  all.insert(all.end(), rows.begin(), rows.end());
}

void measureSmoothness(const FeelOptions& options, std::vector<FeelRow>& all) {
  for (const FeelEntry& entry : feelScenes(options)) {
    fmt::print("\nSmoothness, {}: {}\n", entry.name, entry.description);
    say(all, smoothnessRows(entry.name, entry.make(), options.smoothness));
  }
}

void measurePairs(const FeelOptions& options, std::vector<FeelRow>& all) {
  for (const SceneEntry& entry : pairScenes(options)) {
    const PreparedScene bodies(entry.make(), kUsualCutoffFraction);
    for (const double speed : options.speeds) {
      SeekingPathOptions seeking = options.seeking;
      seeking.speed = speed;
      seeking.press = options.pressOfCutoff * bodies.cutoff;
      CostCase scene{entry.name,    fmt::format("{} m/s", speed),
                     nullptr,       seekingPath(bodies, seeking),
                     bodies.cutoff, options.marginOfCutoff * bodies.cutoff};
      scene.servoScene = solidScene(bodies.meshes.scene, bodies.meshes.part, scene.path.front());
      fmt::print("\nCost of ticks, {}: {}\n", entry.name, entry.description);
      say(all, costRows(scene, runCost(scene, options.cost)));
    }
  }
}

void measureConforming(const FeelOptions& options, std::vector<FeelRow>& all) {
  constexpr double kTick = 1e-3;  // [s]
  for (const FeelEntry& entry : feelScenes(options)) {
    const FeelScene feel = entry.make();
    CostCase scene{entry.name,
                   "conforming",
                   feel.scene,
                   {},
                   kUsualCutoffFraction * feel.size,
                   feel.margin.value_or(options.smoothness.margin)};
    for (std::size_t i = 0; i < options.seeking.ticks; ++i)
      scene.path.push_back(handAt(feel.motion, kTick * static_cast<double>(i)));
    fmt::print("\nCost of ticks, {}: {}\n", entry.name, entry.description);
    say(all, costRows(scene, runCost(scene, options.cost)));
  }
}

void measureTessellation(const FeelOptions& options, std::vector<FeelRow>& all) {
  for (const RestScene& scene : restScenes()) {
    fmt::print("\nTessellation, {}: {}\n", scene.name, scene.description);
    say(all, tessellationRows(scene, options.finenesses));
  }
}

void measureDense(const FeelOptions& options, std::vector<FeelRow>& all) {
  for (const DenseScene& scene : denseScenes()) {
    fmt::print("\nDense flats, {}: {}\n", scene.name, scene.description);
    say(all, denseRows(scene, options.seeking.ticks));
  }
}

void measureCurved(const FeelOptions& options, std::vector<FeelRow>& all) {
  for (const CurvedScene& scene : curvedScenes()) {
    fmt::print("\nCurved faces, {}: {}\n", scene.name, scene.description);
    say(all, curvedRows(scene, options.seeking.ticks));
  }
}

std::string settingsComment(const FeelOptions& o) {
  return fmt::format("# smoothness: {} s after the approach, x1 and x{}, margin {} m, cutoff {} m\n",
                     o.smoothness.seconds, o.smoothness.refinement, o.smoothness.margin,
                     o.smoothness.cutoff) +
         fmt::format(
             "# cost: {} ticks, seed {}, margin {} and press {} of the cutoff of the pairs, {} clock for "
             "ticks, turns of {} of which {} warm up\n",
             o.seeking.ticks, o.seeking.seed, o.marginOfCutoff, o.pressOfCutoff,
             o.cost.clock == BenchClock::Wall ? "wall" : "thread", o.cost.block, o.cost.warmUp) +
         fmt::format("# sliding: margin {} m, pressed {} m\n", o.sliding.margin, o.sliding.press);
}

void checkAll(const std::vector<FeelRow>& rows) {
  for (const FeelRow& row : rows) {
    if (row.quantity != kMeetings || row.max == 0.0) continue;
    throw Error(row.scene, fmt::format("in \"{}\" the part meets a body", row.run),
                "find the tick, for the proxy must never go through");
  }
}

void runFeel(const FeelOptions& options) {
  if (options.cost.warmUp >= options.cost.block)
    throw UsageError("--warm-up", "no tick of a block would be timed", "give less than --block");
  const std::string machine = machineComment(options.csv) + settingsComment(options);
  fmt::print("{}", machine);
  std::vector<FeelRow> rows;
  for (const std::string& group : options.groups) {
    if (group == "smoothness") measureSmoothness(options, rows);
    if (group == "pairs") measurePairs(options, rows);
    if (group == "conforming") measureConforming(options, rows);
    if (group == "sliding") {
      fmt::print("\nSliding and free motion\n");
      say(rows, slidingRows(options.slidingSpeeds, options.sliding));
    }
    if (group == "tessellation") measureTessellation(options, rows);
    if (group == "dense") measureDense(options, rows);
    if (group == "curved") measureCurved(options, rows);
  }
  std::string lines;
  for (const FeelRow& row : rows)
    lines += feelCsvLine(row);
  if (!options.csv.empty()) {
    atomicWrite(options.csv,
                machine + fmt::format("# load at end: {}\n", loadAverages()) + feelCsvHeader() + lines);
  }
  checkAll(rows);
}

void addWhat(CLI::App& command, FeelOptions& o) {
  command.add_option("--shared", o.shared, "Folder of the shared models; without, generated ones alone");
  command.add_option("--groups", o.groups, "What to measure, with commas between")
      ->delimiter(',')
      ->check(
          CLI::IsMember({"smoothness", "pairs", "conforming", "sliding", "tessellation", "dense", "curved"}))
      ->capture_default_str();
  command.add_option("--scenes", o.scenes, "Scenes of conforming contact, with commas between")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--pairs", o.pairs, "Pairs of parts whose ticks are timed, with commas between")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--csv", o.csv, "File for the table");
}

void addHow(CLI::App& command, FeelOptions& o) {
  const auto positive = [&](const char* name, auto& value, const char* help) {
    command.add_option(name, value, help)->check(CLI::PositiveNumber)->capture_default_str();
  };
  positive("--seconds", o.smoothness.seconds, "Of the hand's motion where smoothness is measured");
  positive("--refine", o.smoothness.refinement, "Ticks of the refined path to each of the plain one");
  positive("--margin", o.smoothness.margin, "Of the proxy in conforming contact [m]");
  positive("--cutoff", o.smoothness.cutoff, "Of minima in conforming contact [m]");
  positive("--count", o.seeking.ticks, "Ticks of the paths that are timed");
  positive("--seed", o.seeking.seed, "Of those of the pairs");
  positive("--margin-of-cutoff", o.marginOfCutoff, "Of the proxy at the pairs");
  positive("--press-of-cutoff", o.pressOfCutoff, "How far the hand presses beyond contact at the pairs");
  positive("--block", o.cost.block, "Ticks in a mode before the other has its turn");
  positive("--slide-seconds", o.sliding.seconds, "At full speed along the wall");
  command
      .add_option("--fineness", o.finenesses, "Of the meshes of tessellation, edges so many times shorter")
      ->delimiter(',')
      ->check(CLI::Range(1U, 64U))
      ->capture_default_str();
  command.add_option("--warm-up", o.cost.warmUp, "First ticks of each block, which are not timed")
      ->capture_default_str();
  command.add_option("--speeds", o.speeds, "Of the hand at the pairs, whose larger part is 1 m [m/s]")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--slide-speeds", o.slidingSpeeds, "Of the hand along the wall [m/s]")
      ->delimiter(',')
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      .add_option("--clock", o.cost.clock, "wall, or thread: time on the processor alone, for whole ticks")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, BenchClock>{{"wall", BenchClock::Wall}, {"thread", BenchClock::Thread}}));
}

}  // namespace

void addFeelCommand(CLI::App& program) {
  const auto options = std::make_shared<FeelOptions>();
  CLI::App* command = program.add_subcommand(
      "feel",
      "Measures what the hand feels: smoothness of the wrench, cost of a tick, sliding, free motion.");
  addWhat(*command, *options);
  addHow(*command, *options);
  command->callback([options] { runFeel(*options); });
}

}  // namespace nearfit::bench
