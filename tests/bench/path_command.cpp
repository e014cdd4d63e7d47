#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/path/certificate.h"
#include "core/path/path_bodies.h"
#include "core/path/path_certifier.h"
#include "core/path/path_file.h"
#include "core/path/path_verifier.h"
#include "core/scene/scene_file.h"
#include "tests/bench/bench_clock.h"
#include "tests/bench/commands.h"
#include "tests/exact/pose_certifier.h"
#include "tests/support/portable_random.h"

namespace nearfit::bench {
namespace {

struct PathBenchOptions {
  std::filesystem::path scene, path;
  std::optional<double> separation;
  std::size_t random = 100'000;
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

void runPathBench(const PathBenchOptions& options) {
  const Scene scene = readSceneFile(options.scene);
  const AssemblyPath path = readPathFile(options.path);
  const double separation = options.separation ? *options.separation : defaultSeparation(scene, path);
  const PathCertifier certifier(scene, path, separation);
  const double begin = secondsBy(BenchClock::Wall);
  const PathProof proof = certifier.prove(path);
  const double certified = secondsBy(BenchClock::Wall) - begin;
  if (!proof.isFree())
    throw Error(options.path.string(), fmt::format("it is not proven free at {} s", proof.unproven->time),
                "take a path that is, or a smaller separation");
  const Certificate certificate = certificateOf(scene, path, proof, {});
  const double start = secondsBy(BenchClock::Wall);
  const Verification verification = verifyCertificate(certificate, scene, {});
  const double verified = secondsBy(BenchClock::Wall) - start;
  fmt::print("{} poses, {} pairs, {} stretches, separation {} m\n", path.poses.size(), proof.pairs.size(),
             verification.stretches, separation);
  fmt::print("certified in {:.3f} s, verified in {:.3f} s\n", certified, verified);
  std::fflush(stdout);
  if (!verification.isProven())
    throw Error(options.path.string(), "its certificate is refused: " + verification.problem, "see why");
  const std::size_t meetings = meetingsAt(randomPlaces(path, options), path, pathBodies(scene, path));
  fmt::print("{} of {} random places meet\n", meetings, options.random);
  if (meetings > 0) throw Error(options.path.string(), "parts meet on a certified path", "see where");
}

}  // namespace

void addPathCommand(CLI::App& program) {
  const auto options = std::make_shared<PathBenchOptions>();
  CLI::App* command =
      program.add_subcommand("path",
                             "Certifies a path and verifies the certificate, with times, and looks by exact "
                             "predicates at random places "
                             "on it whether parts meet. Exit code 1 if they do, or it is not proven.");
  command->add_option("scene", options->scene, "Scene file")->required();
  command->add_option("path", options->path, "Path file of nearfit-cli path")->required();
  command->add_option("--separation", options->separation, "Distance to keep [m]");
  command->add_option("--random", options->random, "Number of random places")->capture_default_str();
  command->add_option("--seed", options->seed, "Of the random places")->capture_default_str();
  command->callback([options] { runPathBench(*options); });
}

}  // namespace nearfit::bench
