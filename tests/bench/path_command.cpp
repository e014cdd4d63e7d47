#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/path/assembly_path.h"
#include "core/path/path_bodies.h"
#include "core/path/path_certifier.h"
#include "core/path/path_file.h"
#include "core/scene/part_geometry.h"
#include "core/scene/scene_file.h"
#include "tests/bench/check_report.h"
#include "tests/bench/commands.h"
#include "tests/bench/machine.h"
#include "tests/bench/path_processes.h"
#include "tests/bench/path_row.h"
#include "tests/bench/path_scenes.h"
#include "tests/bench/proven_path.h"
#include "tests/bench/selection.h"

namespace nearfit::bench {
namespace {

/// Poses of generated paths, and seconds in which one of so many is to be certified.
constexpr std::size_t kGoalPoses = 4000;
constexpr double kCertifiedGoal = 10.0;
/// Places times pairs of parts on one path: some ten seconds.
constexpr std::size_t kMaxLooks = 100'000'000;

struct PathBenchOptions {
  std::filesystem::path scene, path;
  std::vector<std::string> scenes{"all"};
  std::filesystem::path shared, csv;
  std::size_t poses = kGoalPoses;
  std::optional<double> separation;
  std::size_t random = 1'000'000;
  std::uint64_t seed = 1;
  std::vector<std::string> plain{"pipe"};
  bool hasProcesses = true;
};

std::size_t pathTriangles(const nearfit::PathBodies& bodies) {
  std::size_t triangles = 0;
  for (const PathPart& moving : bodies.moving)
    triangles += moving.part->geometry->mesh.triangles().size();
  for (const Scene::PartPtr& other : bodies.others)
    triangles += other->geometry->mesh.triangles().size();
  return triangles;
}

void buildPathHierarchies(const nearfit::PathBodies& bodies) {
  std::vector<PartGeometryPtr> geometries;
  for (const PathPart& moving : bodies.moving)
    geometries.push_back(moving.part->geometry);
  for (const Scene::PartPtr& other : bodies.others)
    geometries.push_back(other->geometry);
  prepareHierarchies(geometries);
}

/// Fewer than those asked for where many pairs of parts would each be looked at.
std::size_t placesFor(const nearfit::PathBodies& bodies, std::size_t wanted) {
  const std::size_t pairs = bodies.moving.size() * bodies.others.size();
  return std::min(wanted, kMaxLooks / std::max<std::size_t>(pairs, 1));
}

/// Certifies, verifies, and looks at random places. Throws Error where it is not proven, or the proof is refused.
PathRow measurePath(const PathBenchScene& made, const PathBenchOptions& options) {
  const nearfit::PathBodies bodies = pathBodies(made.scene, made.path);
  buildPathHierarchies(bodies);
  const double separation =
      options.separation ? *options.separation : defaultSeparation(made.scene, made.path);
  const PathProofCheck proof = proveAndVerify(made.scene, made.path, separation);
  if (!proof.isCertified || !proof.isVerified)
    throw Error(made.name, proof.problem, "take a path that is free, or a smaller separation");
  PathRow row;
  row.scene = made.name;
  row.poses = made.path.poses.size();
  row.triangles = pathTriangles(bodies);
  row.moving = bodies.moving.size();
  row.others = bodies.others.size();
  row.certified = proof.certifySeconds;
  row.verified = proof.verifySeconds;
  if (const std::filesystem::path cli = cliProgram(); options.hasProcesses && !cli.empty()) {
    const PathProcessTimes times = timePathProcesses(cli, made.scene, made.path, separation);
    row.certifyProcess = times.certify;
    row.verifyProcess = times.verify;
  }
  const std::size_t places = placesFor(bodies, options.random);
  row.looks = lookAtPlaces(made.path, bodies, places, options.seed);
  if (std::ranges::find(options.plain, made.name) != options.plain.end())
    row.plain = testPlaces(made.path, bodies, places, options.seed);
  if (row.poses == kGoalPoses) row.goal = kCertifiedGoal;
  return row;
}

std::vector<PathSceneEntry> pathScenes(const PathBenchOptions& options) {
  if (!options.scene.empty())
    return {{options.path.stem().string(), [&options] {
               return PathBenchScene{options.path.stem().string(), readSceneFile(options.scene),
                                     readPathFile(options.path)};
             }}};
  std::vector<PathSceneEntry> entries = generatedPathScenes(options.poses);
  for (PathSceneEntry& entry : sharedPathScenes(options.shared, options.poses))
    entries.push_back(std::move(entry));
  return chosen(entries, options.scenes, "--scenes");
}

void runPathBench(const PathBenchOptions& options) {
  if (options.scene.empty() != options.path.empty())
    throw UsageError("path", "a scene file needs a path file", "give both, or none for generated paths");
  const std::vector<PathSceneEntry> entries = pathScenes(options);
  const std::string machine = machineComment(options.csv) +
                              fmt::format("# {} random places, seed {}; threads: as many as processors\n",
                                          options.random, options.seed);
  fmt::print("{}\n{}", machine, pathTableHeader());
  std::fflush(stdout);
  std::string lines, meeting;
  for (const PathSceneEntry& entry : entries) {
    const PathRow row = measurePath(entry.make(), options);
    fmt::print("{}", pathTableLine(row));
    std::fflush(stdout);
    lines += pathCsvLine(row);
    for (const PlaceLooks& looks : {row.looks, row.plain})
      if (looks.meetings > 0) fmt::print("{}\n", looks.firstMeeting);
    if (row.meetings() > 0) meeting += fmt::format("{}{}", meeting.empty() ? "" : ", ", row.scene);
  }
  if (!options.csv.empty())
    atomicWrite(options.csv,
                machine + fmt::format("# load at end: {}\n", loadAverages()) + pathCsvHeader() + lines);
  if (!meeting.empty()) throw Error(meeting, "parts meet on a certified path", "see where");
}

}  // namespace

void addPathCommand(CLI::App& program) {
  const auto options = std::make_shared<PathBenchOptions>();
  CLI::App* command = program.add_subcommand(
      "path",
      "Certifies paths and verifies the certificates, with times, and looks by exact predicates at random "
      "places on them whether parts meet. Exit code 1 if they do, or a path is not proven.");
  command->add_option("scene", options->scene, "Scene file; without, generated paths")
      ->check(CLI::ExistingFile);
  command->add_option("path", options->path, "Path file of nearfit-cli path")->check(CLI::ExistingFile);
  command
      ->add_option("--scenes", options->scenes,
                   "Generated paths, with commas between: peg, rocks, pipe, among-200, group-among-200, "
                   "suggested-peg, "
                   "suggested-pipe, recorded-peg, with --shared peghole, pump; all by default")
      ->delimiter(',');
  command
      ->add_option("--shared", options->shared, "Folder of the shared models; without, generated paths alone")
      ->check(CLI::ExistingDirectory);
  command->add_option("--poses", options->poses, "Of each generated path; goals are for the default")
      ->check(CLI::Range(std::size_t{2}, kMaxPathPoses))
      ->capture_default_str();
  command->add_option("--separation", options->separation, "Distance to keep [m]");
  command
      ->add_option("--random", options->random,
                   "Number of random places on each path, or fewer where many pairs of parts are looked at")
      ->capture_default_str();
  command
      ->add_option(
          "--plain", options->plain,
          "Paths on which each place is tested once more by exact predicates alone, with commas between")
      ->delimiter(',')
      ->capture_default_str();
  command->add_flag("!--no-processes", options->hasProcesses, "Do not time nearfit-cli certify and verify");
  command->add_option("--seed", options->seed, "Of the random places")->capture_default_str();
  command->add_option("--csv", options->csv, "File for the table");
  command->callback([options] { runPathBench(*options); });
}

}  // namespace nearfit::bench
