#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/scene/scene_file.h"
#include "tests/bench/commands.h"
#include "tests/bench/instances.h"
#include "tests/bench/machine.h"
#include "tests/bench/near_pair.h"
#include "tests/bench/scene_path.h"
#include "tests/bench/selection.h"
#include "tests/bench/tick_report.h"

namespace nearfit::bench {
namespace {

struct SceneOptions {
  std::vector<std::string> scenes{"gear-disc", "crankshaft-gear"};
  std::vector<std::size_t> farParts{1000, 10'000};
  HandPathOptions path;
  RunOptions run;
  double gapFraction = 0.0;
  std::uint64_t seed = 1;
  bool isBest = false;
  std::size_t instances = 10'000;
  std::string mesh = "organic-70k";
  std::filesystem::path csv, instancesCsv;
};

TickScene sceneOf(const NearPair& pair, std::size_t farCount) {
  return {farCount == 0 ? "alone" : fmt::format("+{} far", farCount), pair.sceneWith(farCount)};
}

std::vector<TickRow> measureTicks(const SceneEntry& entry, const SceneOptions& options) {
  const PreparedScene pairOfMeshes(entry.make(), kUsualCutoffFraction);
  const std::vector<RigidTransform> path = makePath(pairOfMeshes, options.path);
  NearPair pair(pairOfMeshes, path);
  pair.field.keepOut.radius += options.gapFraction * pairOfMeshes.size;
  pair.field.seed = options.seed;

  std::vector<TickScene> scenes{sceneOf(pair, 0)};
  for (const std::size_t count : options.farParts)
    scenes.push_back(sceneOf(pair, count));
  const std::vector<TickRun> runs = runTicks(scenes, path, pairOfMeshes.cutoff, options.run);
  std::vector<TickRow> rows = tickRows(entry.name, runs, options.run.rounds, options.isBest);
  const TickRun& alone = runs.front();
  fmt::print("\n{}: {}; cutoff {:.4g} m; times in us, ratios to the first line\n{}", entry.name,
             entry.description, pairOfMeshes.cutoff, tickTable(rows));
  fmt::print("{:.1f} % of the ticks have minima.\n",
             100.0 * static_cast<double>(alone.ticksWithMinima) / static_cast<double>(alone.digests.size()));
  std::fflush(stdout);
  return rows;
}

std::vector<InstancesRow> measureInstances(const SceneOptions& options) {
  const TriangleMesh mesh = chosen(generatedMeshes(), {options.mesh}, "--mesh").front().make();
  std::vector<InstancesRow> rows;
  for (const std::size_t parts : {std::size_t{2}, options.instances})
    rows.push_back(measureInstancesInMemory(mesh, parts));
  for (const std::size_t parts : {std::size_t{2}, options.instances})
    rows.push_back(measureInstancesFromFile(mesh, parts));
  fmt::print("\nParts that share one mesh ({}, {} triangles)\n{}", options.mesh, mesh.triangles().size(),
             instancesTable(rows));
  return rows;
}

std::string settingsComment(const SceneOptions& o) {
  return fmt::format(
             "# path: {} poses, seed {}; cutoff {} of the diagonal; far parts: seed {}, {} of the "
             "diagonal beyond the cutoff\n",
             o.path.poses, o.path.seed, kUsualCutoffFraction, o.seed, o.gapFraction) +
         fmt::format("# times: {} clock, {} of {} rounds, turns of {} poses of which {} warm up, {}\n",
                     o.run.clock == BenchClock::Wall ? "wall" : "thread", o.isBest ? "least" : "all",
                     o.run.rounds, o.run.block, o.run.warmUp,
                     o.run.cpu ? fmt::format("on processor {}", *o.run.cpu) : "not pinned");
}

void checkAll(const std::vector<TickRow>& ticks, const std::vector<InstancesRow>& instances) {
  for (const TickRow& row : ticks) {
    if (row.isSame) continue;
    throw Error(row.scene, fmt::format("\"{}\" gives other forces or minima than the parts alone", row.name),
                "find the tick where they part, for its exactness is lost");
  }
  for (const InstancesRow& row : instances) {
    if (row.geometries == 1) continue;
    throw Error("instances",
                fmt::format("{} parts of one mesh have {} geometries", row.parts, row.geometries),
                "find out who loads it again");
  }
}

void runScene(const SceneOptions& options) {
  if (options.run.warmUp >= options.run.block) {
    throw UsageError("--warm-up", "no tick of a block would be timed", "give less than --block");
  }
  const std::string machine = machineComment(options.csv) + settingsComment(options);
  fmt::print("{}", machine);
  // Before the ticks, whose scenes would leave holes in the memory.
  std::vector<InstancesRow> instances;
  if (options.instances > 0) instances = measureInstances(options);
  std::vector<TickRow> ticks;
  for (const SceneEntry& entry : chosen(generatedScenes(), options.scenes, "--scenes")) {
    const std::vector<TickRow> rows = measureTicks(entry, options);
    ticks.insert(ticks.end(), rows.begin(), rows.end());
  }
  const std::string header = machine + fmt::format("# load at end: {}\n", loadAverages());
  std::string lines;
  for (const TickRow& row : ticks)
    lines += tickCsvLine(row);
  if (!options.csv.empty()) atomicWrite(options.csv, header + tickCsvHeader() + lines);
  if (!options.instancesCsv.empty()) atomicWrite(options.instancesCsv, header + instancesCsv(instances));
  checkAll(ticks, instances);
}

void addTickOptions(CLI::App& command, SceneOptions& o) {
  command.add_option("--scenes", o.scenes, "Built-in scenes of a part in hand and one near it")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--far", o.farParts, "Numbers of parts far away, with commas between")
      ->delimiter(',')
      ->capture_default_str();
  command
      .add_option("--gap", o.gapFraction,
                  "Farther than the cutoff that they are from all that the part in hand comes to, as a "
                  "fraction of the diagonal")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_option("--far-seed", o.seed, "Of their poses")->capture_default_str();
  command.add_option("--count", o.path.poses, "Poses of the path")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--seed", o.path.seed, "Of the path")->capture_default_str();
}

void addRunOptions(CLI::App& command, SceneOptions& o) {
  command.add_option("--block", o.run.block, "Ticks in a scene before the next has its turn")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--warm-up", o.run.warmUp, "First ticks of each block, which are not timed")
      ->capture_default_str();
  command.add_option("--repeat", o.run.rounds, "Times to walk the path")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_flag("--best", o.isBest,
                   "Take each tick's least time of all rounds (on a machine that others use)");
  command.add_option("--clock", o.run.clock, "wall, or thread: time on the processor alone")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, BenchClock>{{"wall", BenchClock::Wall}, {"thread", BenchClock::Thread}}));
  command.add_option("--pin", o.run.cpu, "Processor to stay on");
}

}  // namespace

void addSceneCommand(CLI::App& program) {
  const auto options = std::make_shared<SceneOptions>();
  CLI::App* command = program.add_subcommand(
      "scene",
      "Times servo ticks with and without parts far away, and weighs scenes of parts that share a mesh.");
  addTickOptions(*command, *options);
  addRunOptions(*command, *options);
  command->add_option("--instances", options->instances, "Parts that share a mesh; 0: leave that out")
      ->check(CLI::IsMember({0}) | CLI::Range(std::size_t{2}, kMaxSceneFileParts))
      ->capture_default_str();
  command->add_option("--mesh", options->mesh, "Generated mesh that they share")->capture_default_str();
  command->add_option("--csv", options->csv, "File for the table of ticks");
  command->add_option("--instances-csv", options->instancesCsv,
                      "File for the table of parts that share a mesh");
  command->callback([options] { runScene(*options); });
}

}  // namespace nearfit::bench
