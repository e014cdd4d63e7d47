#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "device/simulated/simulated_device.h"
#include "tests/bench/commands.h"
#include "tests/bench/machine.h"
#include "tests/bench/query_report.h"
#include "tests/bench/scene_path.h"
#include "tests/bench/selection.h"

namespace nearfit::bench {
namespace {

namespace fs = std::filesystem;

struct QueryOptions {
  std::vector<std::string> scenes{"all"}, methods;
  fs::path sharedFolder, sceneFile, partFile, poses, writePoses, csv, samples;
  double metresPerUnit = 1.0, cutoffFraction = kUsualCutoffFraction, turnDegrees = 0.2, tickMicros = 0.0;
  HandPathOptions path;
  RunOptions run;
  std::string baseline = "fcl-seeded";
  bool isBest = false, isList = false;
};

std::vector<SceneEntry> scenesOf(const QueryOptions& options) {
  if (!options.sceneFile.empty()) {
    const auto make = [&options] {
      return sceneFromFiles(options.sceneFile, options.partFile, options.metresPerUnit);
    };
    return {{"files", "the two files", make}};
  }
  std::vector<SceneEntry> all = generatedScenes();
  if (!options.sharedFolder.empty()) {
    const std::vector<SceneEntry> shared = sharedScenes(options.sharedFolder);
    all.insert(all.end(), shared.begin(), shared.end());
  }
  return chosen(all, options.scenes, "--scenes");
}

/// Without a choice: all but the slow ones.
std::vector<MethodEntry> methodsOf(const QueryOptions& options) {
  std::vector<MethodEntry> all = allMethods();
  if (!options.methods.empty()) return chosen(all, options.methods, "--methods");
  std::erase_if(all, [](const MethodEntry& method) { return isSlow(method.kind); });
  return all;
}

void printLists(const QueryOptions& options) {
  fmt::print("Scenes:\n");
  for (const SceneEntry& scene : scenesOf(options))
    fmt::print("  {:<24}{}\n", scene.name, scene.description);
  fmt::print("Methods ({}):\n", peerDescription());
  for (const MethodEntry& method : allMethods())
    fmt::print("  {:<24}{}\n", method.name, method.description);
}

std::vector<RigidTransform> pathOf(const PreparedScene& scene, const QueryOptions& options) {
  const auto fileIn = [&](const fs::path& place) {
    return fs::is_directory(place) ? place / (scene.meshes.name + ".csv") : place;
  };
  if (!options.poses.empty()) return readPosePath(fileIn(options.poses));
  std::vector<RigidTransform> path = makePath(scene, options.path);
  if (!options.writePoses.empty()) writePath(fileIn(options.writePoses), path);
  return path;
}

/// How the figures came about, as comment lines.
std::string settingsComment(const QueryOptions& o) {
  const std::string path = o.poses.empty()
                               ? fmt::format("{} poses, seed {}, step {} of the diagonal, turn {} degrees",
                                             o.path.poses, o.path.seed, o.path.step, o.turnDegrees)
                               : "read from files";
  return fmt::format("# path: {}; cutoff {} of the diagonal\n", path, o.cutoffFraction) +
         fmt::format(
             "# times: {} clock, {} of {} rounds, turns of {} poses after {} to warm up, tick {} us, {}\n",
             o.run.clock == BenchClock::Wall ? "wall" : "thread", o.isBest ? "least" : "all", o.run.rounds,
             o.run.block, o.run.warmUp, o.tickMicros,
             o.run.cpu ? fmt::format("on processor {}", *o.run.cpu) : "not pinned") +
         fmt::format("# ratios: to {}\n", o.baseline);
}

/// What a run over all scenes has gathered so far.
struct Results {
  std::string csv, samples;
  std::vector<std::string> problems;
};

void measureScene(const SceneEntry& entry, const std::vector<MethodEntry>& methods,
                  const QueryOptions& options, Results& results) {
  const PreparedScene scene(entry.make(), options.cutoffFraction);
  const std::vector<RigidTransform> path = pathOf(scene, options);
  const std::vector<MethodRun> runs = runInterleaved(methods, scene, path, options.run);
  const std::vector<ReportRow> rows = reportRows(scene, runs, options.baseline, options.isBest);
  fmt::print("{}{}", tableOf(scene, rows, options.baseline), describePath(scene, runs));
  for (const MethodRun& run : runs) {
    if (!run.remark.empty()) fmt::print("{}: {}.\n", run.method->name, run.remark);
  }
  std::fflush(stdout);
  for (const ReportRow& row : rows)
    results.csv += csvLine(row);
  if (!options.samples.empty()) results.samples += samplesCsv(scene, runs);
  const std::vector<std::string> problems = disagreements(rows);
  results.problems.insert(results.problems.end(), problems.begin(), problems.end());
}

void runQuery(const QueryOptions& options) {
  if (options.isList) return printLists(options);
  const std::vector<MethodEntry> methods = methodsOf(options);
  const std::string machine = machineComment(options.csv) + settingsComment(options);
  fmt::print("{}", machine);
  Results results;
  for (const SceneEntry& scene : scenesOf(options))
    measureScene(scene, methods, options, results);
  const std::string header = machine + fmt::format("# load at end: {}\n", loadAverages());
  if (!options.csv.empty()) atomicWrite(options.csv, header + csvHeader() + results.csv);
  if (!options.samples.empty()) {
    atomicWrite(options.samples, header + "scene,method,round,pose,us\n" + results.samples);
  }
  if (results.problems.empty()) return;
  std::string all;
  for (const std::string& problem : results.problems)
    all += (all.empty() ? "" : "; ") + problem;
  throw Error("the comparison", "methods disagree, so the figures are void: " + all,
              "replay the pose with --poses");
}

void addSceneOptions(CLI::App& command, QueryOptions& o) {
  command.add_flag("--list", o.isList, "Say which scenes and methods there are, and measure nothing");
  command.add_option("--scenes", o.scenes, "Built-in scenes, with commas between; all of them by default")
      ->delimiter(',');
  command
      .add_option("--shared", o.sharedFolder, "Folder of shared models: adds the paper's pairs and others")
      ->check(CLI::ExistingDirectory);
  CLI::Option* scene =
      command.add_option("--scene", o.sceneFile, "Mesh that stays, instead of built-in scenes");
  CLI::Option* part = command.add_option("--part", o.partFile, "Mesh that moves");
  scene->needs(part);
  part->needs(scene);
  command.add_option("--unit", o.metresPerUnit, "Of the two files: m, cm, mm, um, in, ft or metres")
      ->transform(CLI::Transformer(std::map<std::string, double>{
          {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"um", 1e-6}, {"in", 0.0254}, {"ft", 0.3048}}))
      ->check(CLI::PositiveNumber);
  command.add_option("--cutoff", o.cutoffFraction, "As a fraction of the larger body's diagonal")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

void addPathOptions(CLI::App& command, QueryOptions& o) {
  command
      .add_option("--poses", o.poses,
                  "CSV file of poses (tx,ty,tz,qw,qx,qy,qz), or a folder with one named as each scene; "
                  "otherwise a hand's path is made")
      ->check(CLI::ExistingPath);
  command.add_option("--write-poses", o.writePoses,
                     "Where to write the path made: a file, or an existing folder");
  command.add_option("--count", o.path.poses, "Poses of the path")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      .add_option("--step", o.path.step, "Translation a pose, as a fraction of the larger body's diagonal")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--turn", o.turnDegrees, "Rotation a pose [degrees]")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_option("--seed", o.path.seed, "Of the path")->capture_default_str();
}

void addRunOptions(CLI::App& command, QueryOptions& o) {
  command
      .add_option("--methods", o.methods,
                  "With commas between, or all; by default all but those of pairs and of the paper")
      ->delimiter(',');
  command.add_option("--baseline", o.baseline, "Method that ratios refer to")->capture_default_str();
  command.add_option("--block", o.run.block, "Poses a method answers before the next has its turn")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_option("--warm-up", o.run.warmUp, "Poses before each block that are not timed")
      ->capture_default_str();
  command.add_option("--repeat", o.run.rounds, "Times to walk the path")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.add_flag("--best", o.isBest,
                   "Take each pose's least time of all rounds (on a machine that others use)");
  command
      .add_option("--pairs-stride", o.run.pairsStride,
                  "Methods of pairs and of the paper answer each so-many-th pose only")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command
      .add_option("--clock", o.run.clock, "wall, or thread: time on the processor alone, whatever others do")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, BenchClock>{{"wall", BenchClock::Wall}, {"thread", BenchClock::Thread}}));
  command
      .add_option("--tick", o.tickMicros,
                  "Time from one query to the next [us], as a servo has it; 0: back to back")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_option("--pin", o.run.cpu, "Processor to stay on");
  command.add_option("--csv", o.csv, "File for the table");
  command.add_option("--samples", o.samples, "File for every time measured");
}

}  // namespace

void addQueryCommand(CLI::App& program) {
  const auto options = std::make_shared<QueryOptions>();
  CLI::App* command = program.add_subcommand(
      "query", "Times queries along a path near contact, and compares the answers of all methods.");
  addSceneOptions(*command, *options);
  addPathOptions(*command, *options);
  addRunOptions(*command, *options);
  command->callback([options] {
    options->path.turn = options->turnDegrees * std::numbers::pi / 180.0;
    options->run.period = 1e-6 * options->tickMicros;
    runQuery(*options);
  });
}

}  // namespace nearfit::bench
