#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/path/assembly_path.h"
#include "core/path/certificate.h"
#include "core/path/path_bodies.h"
#include "core/path/path_certifier.h"
#include "core/path/path_file.h"
#include "core/path/path_verifier.h"
#include "core/scene/part_geometry.h"
#include "core/scene/scene_file.h"
#include "tests/bench/bench_clock.h"
#include "tests/bench/commands.h"
#include "tests/bench/machine.h"
#include "tests/bench/path_row.h"
#include "tests/bench/path_scenes.h"
#include "tests/bench/selection.h"
#include "tests/exact/pose_certifier.h"
#include "tests/support/portable_random.h"

namespace nearfit::bench {
namespace {

/// Poses of generated paths, and seconds in which one of so many is to be certified.
constexpr std::size_t kGoalPoses = 4000;
constexpr double kCertifiedGoal = 10.0;

struct PathBenchOptions {
  std::filesystem::path scene, path;
  std::vector<std::string> scenes{"all"};
  std::filesystem::path shared, csv;
  std::size_t poses = kGoalPoses;
  std::optional<double> separation;
  std::size_t random = 1'000'000;
  std::uint64_t seed = 1;
};

/// Random places on a path, in order: poses that follow each other nearer than bodies are apart cost little.
std::vector<double> randomPlaces(const AssemblyPath& path, const PathBenchOptions& options) {
  std::mt19937_64 engine(options.seed);
  std::vector<double> places;
  places.reserve(options.random);
  for (std::size_t i = 0; i < options.random; ++i)
    places.push_back(path.end() * test::uniform(engine));
  std::ranges::sort(places);
  return places;
}

/// Looks by exact predicates whether parts meet at random places; returns at how many they do.
std::size_t meetingsAt(const std::vector<double>& places, const AssemblyPath& path,
                       const PathBodies& bodies) {
  std::size_t meetings = 0;
  for (const PathPart& moving : bodies.moving) {
    for (const Scene::PartPtr& other : bodies.others) {
      std::vector<RigidTransform> poses;
      poses.reserve(places.size());
      for (const double place : places)
        poses.push_back(otherFromPart(*other, poseAt(path, place), moving));
      const std::vector<char> met =
          test::PoseCertifier(other->geometry->mesh, moving.part->geometry->mesh).meetings(poses);
      const auto count = static_cast<std::size_t>(std::ranges::count(met, 1));
      if (count > 0) fmt::print("{} meets {} at {} random places\n", moving.part->name, other->name, count);
      meetings += count;
    }
  }
  return meetings;
}

std::size_t pathTriangles(const PathBodies& bodies) {
  std::size_t triangles = 0;
  for (const PathPart& moving : bodies.moving)
    triangles += moving.part->geometry->mesh.triangles().size();
  for (const Scene::PartPtr& other : bodies.others)
    triangles += other->geometry->mesh.triangles().size();
  return triangles;
}

void buildPathHierarchies(const PathBodies& bodies) {
  std::vector<PartGeometryPtr> geometries;
  for (const PathPart& moving : bodies.moving)
    geometries.push_back(moving.part->geometry);
  for (const Scene::PartPtr& other : bodies.others)
    geometries.push_back(other->geometry);
  prepareHierarchies(geometries);
}

/// Certifies, verifies, and looks at random places. Throws Error where it is not proven, or the proof is refused.
PathRow measurePath(const PathBenchScene& made, const PathBenchOptions& options) {
  const PathBodies bodies = pathBodies(made.scene, made.path);
  buildPathHierarchies(bodies);
  const double separation =
      options.separation ? *options.separation : defaultSeparation(made.scene, made.path);
  const double begin = secondsBy(BenchClock::Wall);
  const PathProof proof = PathCertifier(made.scene, made.path, separation).prove(made.path);
  PathRow row;
  row.certified = secondsBy(BenchClock::Wall) - begin;
  if (!proof.isFree())
    throw Error(made.name, fmt::format("it is not proven free at {} s", proof.unproven->time),
                "take a path that is, or a smaller separation");
  const Certificate certificate = certificateOf(made.scene, made.path, proof, {});
  const double start = secondsBy(BenchClock::Wall);
  const Verification verification = verifyCertificate(certificate, made.scene, {});
  row.verified = secondsBy(BenchClock::Wall) - start;
  if (!verification.isProven())
    throw Error(made.name, "its certificate is refused: " + verification.problem, "see why");
  row.scene = made.name;
  row.poses = made.path.poses.size();
  row.triangles = pathTriangles(bodies);
  row.places = options.random;
  row.meetings = meetingsAt(randomPlaces(made.path, options), made.path, bodies);
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
    if (row.meetings > 0) meeting += fmt::format("{}{}", meeting.empty() ? "" : ", ", row.scene);
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
      ->add_option(
          "--scenes", options->scenes,
          "Generated paths, with commas between: peg, rocks, pipe, with --shared peghole, pump; all by "
          "default")
      ->delimiter(',');
  command
      ->add_option("--shared", options->shared, "Folder of the shared models; without, generated paths alone")
      ->check(CLI::ExistingDirectory);
  command->add_option("--poses", options->poses, "Of each generated path; goals are for the default")
      ->check(CLI::Range(std::size_t{2}, kMaxPathPoses))
      ->capture_default_str();
  command->add_option("--separation", options->separation, "Distance to keep [m]");
  command->add_option("--random", options->random, "Number of random places on each path")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Of the random places")->capture_default_str();
  command->add_option("--csv", options->csv, "File for the table");
  command->callback([options] { runPathBench(*options); });
}

}  // namespace nearfit::bench
