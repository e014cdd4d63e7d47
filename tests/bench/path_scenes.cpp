#include "tests/bench/path_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/import/mesh_import.h"
#include "tests/bench/bench_shapes.h"
#include "tests/exact/pose_certifier.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/suggest_scenes.h"

namespace nearfit::bench {
namespace {

namespace fs = std::filesystem;

constexpr double kPoseSeconds = 1e-3;
constexpr double kPathMillimetre = 1e-3;

/// A path of what is in hand, by the share of the way.
template <class PoseOf>
AssemblyPath pathOf(const Scene& scene, std::size_t poses, PoseOf&& poseOf) {
  AssemblyPath path = pathFrame(scene);
  for (std::size_t i = 0; i < poses; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(poses - 1);
    path.poses.push_back({kPoseSeconds * static_cast<double>(i), poseOf(share).normalized()});
  }
  return path;
}

/// Let down along z from `above` to `below` while it turns about z.
RigidTransform screwed(double share, double above, double below, double turns) {
  const double angle = 2.0 * std::numbers::pi * turns * share;
  return {glm::angleAxis(angle, glm::dvec3(0.0, 0.0, 1.0)), {0.0, 0.0, above + share * (below - above)}};
}

PathBenchScene pegPath(std::size_t poses) {
  constexpr double kAbove = 50e-3, kTurns = 4.0;
  Scene scene = test::pegInHole().scene;
  AssemblyPath path = pathOf(scene, poses, [](double share) { return screwed(share, kAbove, 0.0, kTurns); });
  return {"peg", std::move(scene), std::move(path)};
}

/// Pose of the bent pipe with the point of its middle line at that length in the middle of the hole, and the line along
/// the hole.
RigidTransform pipeAt(const test::BentPipe& pipe, double length) {
  const double bend = std::clamp((length - pipe.leg) / pipe.bendRadius, 0.0, 0.5 * std::numbers::pi);
  const double before = std::min(length, pipe.leg),
               behind = std::max(0.0, length - pipe.leg - 0.5 * std::numbers::pi * pipe.bendRadius);
  const glm::dvec3 point(pipe.bendRadius * (1.0 - std::cos(bend)) + behind, 0.0,
                         before + pipe.bendRadius * std::sin(bend));
  const glm::dquat turn = test::pipeInPlate().rotation * glm::angleAxis(-bend, glm::dvec3(0.0, 1.0, 0.0));
  return {turn, -(turn * point)};
}

PathBenchScene pipePath(std::size_t poses) {
  const test::BentPipe pipe;
  // From where it is drawn until its end is well out of the plate.
  constexpr double kBeyond = 20e-3;
  const double begin = test::pipeInPlate().translation.z,
               end = 2.0 * pipe.leg + 0.5 * std::numbers::pi * pipe.bendRadius + kBeyond;
  Scene scene = test::pipeOut().scene;
  AssemblyPath path =
      pathOf(scene, poses, [&](double share) { return pipeAt(pipe, begin + share * (end - begin)); });
  return {"pipe", std::move(scene), std::move(path)};
}

/// Past the origin along x, turned on the way.
RigidTransform passing(double share, double aside) {
  constexpr double kFrom = -3.0, kTo = 3.0, kTurn = 1.0;
  return {glm::angleAxis(kTurn * share, glm::normalize(glm::dvec3(1.0, 2.0, 3.0))),
          {kFrom + share * (kTo - kFrom), aside, 0.0}};
}

/// The least distance aside at which a rock passes the other one with a gap, by places close to each other.
double asideFor(const TriangleMesh& fixed, const TriangleMesh& moving, double gap) {
  constexpr int kPlaces = 200, kHalvings = 10;
  const test::PoseCertifier certifier(fixed, moving);
  const auto isFree = [&](double aside) {
    for (int i = 0; i <= kPlaces; ++i) {
      const RigidTransform pose = passing(static_cast<double>(i) / kPlaces, aside);
      if (certifier.surfacesApart(pose, gap) < 0.99 * gap) return false;
    }
    return true;
  };
  double meets = 0.0, free = fixed.bounds().diagonal() + moving.bounds().diagonal();
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (meets + free);
    (isFree(middle) ? free : meets) = middle;
  }
  return free;
}

PathBenchScene rockPath(std::size_t poses) {
  constexpr std::uint32_t kFrequency = 32;
  // More than what the rock moves between two of the places.
  constexpr double kGap = 0.05;
  const TriangleMesh fixed = organicMesh(kFrequency, 1), moving = organicMesh(kFrequency, 2);
  const double aside = asideFor(fixed, moving, kGap);
  Scene scene;
  scene.add(test::partOf(test::freshGeometryOf(fixed), "Fixed rock"));
  scene.setMovingPart(scene.add(test::partOf(test::freshGeometryOf(moving), "Rock", passing(0.0, aside))));
  AssemblyPath path = pathOf(scene, poses, [&](double share) { return passing(share, aside); });
  return {"rocks", std::move(scene), std::move(path)};
}

PartGeometryPtr importedGeometry(const fs::path& file, double unit) {
  return loadPartGeometry(file, unit);
}

PathBenchScene pegholePath(const fs::path& folder, std::size_t poses) {
  // The hole is 9 mm high; the peg stands on z = 0.
  constexpr double kAbove = 20e-3, kBelow = -20e-3, kTurns = 2.0;
  Scene scene;
  scene.add(test::partOf(importedGeometry(folder / "factory_round_hole_16mm_subdiv_3x.obj", 1.0), "Hole"));
  scene.setMovingPart(
      scene.add(test::partOf(importedGeometry(folder / "factory_round_peg_16mm_loose.obj", 1.0), "Peg")));
  AssemblyPath path =
      pathOf(scene, poses, [](double share) { return screwed(share, kAbove, kBelow, kTurns); });
  return {"peghole", std::move(scene), std::move(path)};
}

PathBenchScene pumpPath(const fs::path& folder, std::size_t poses) {
  constexpr double kAbove = 0.15;
  Scene scene;
  scene.add(test::partOf(importedGeometry(folder / "Bottom.stl", kPathMillimetre), "Bottom"));
  const PartGeometryPtr axis = importedGeometry(folder / "Axis_of_bearing.stl", kPathMillimetre);
  scene.setMovingPart(scene.add(test::partOf(axis, "Axis")));
  // About its own line, which is along y.
  const glm::dvec3 middle = axis->mesh.bounds().centre();
  AssemblyPath path = pathOf(scene, poses, [&](double share) {
    const glm::dquat turn = glm::angleAxis(2.0 * std::numbers::pi * (1.0 - share), glm::dvec3(0.0, 1.0, 0.0));
    return RigidTransform{turn, middle - turn * middle + glm::dvec3(0.0, kAbove * (1.0 - share), 0.0)};
  });
  return {"pump", std::move(scene), std::move(path)};
}

}  // namespace

std::vector<PathSceneEntry> generatedPathScenes(std::size_t poses) {
  return {{"peg", [=] { return pegPath(poses); }},
          {"rocks", [=] { return rockPath(poses); }},
          {"pipe", [=] { return pipePath(poses); }}};
}

std::vector<PathSceneEntry> sharedPathScenes(const fs::path& shared, std::size_t poses) {
  const fs::path models = shared / "models" / "public";
  if (shared.empty() || !fs::is_directory(models)) return {};
  return {{"peghole", [=] { return pegholePath(models / "peghole", poses); }},
          {"pump", [=] { return pumpPath(models / "pump", poses); }}};
}

}  // namespace nearfit::bench
