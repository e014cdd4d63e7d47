#include "tests/bench/path_scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/base/error.h"
#include "core/import/mesh_import.h"
#include "core/path/path_certifier.h"
#include "core/path/path_search.h"
#include "core/path/path_thinning.h"
#include "core/servo/motion_recording.h"
#include "device/servo/servo_loop.h"
#include "tests/bench/bench_shapes.h"
#include "tests/bench/many_parts.h"
#include "tests/bench/pressed_walk.h"
#include "tests/bench/scene_files.h"
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

/// Around the origin, with no point farther from it than the radius.
TriangleMesh roundedTo(const TriangleMesh& mesh, double radius) {
  double most = 0.0;
  for (const glm::dvec3& p : mesh.vertices())
    most = std::max(most, glm::length(p));
  return test::transformed(mesh, radius / most);
}

/// Way of a long body along x through all channels between the pegs, there and back, with turns between two channels
/// outside the assembly.
std::vector<glm::dvec3> channelWay(const ChannelGrid& grid, double beyond) {
  std::vector<glm::dvec3> way;
  for (std::size_t layer = 0; layer < grid.layers; ++layer) {
    for (std::size_t row = 0; row < grid.rows; ++row) {
      const glm::dvec3 near = grid.first + glm::dvec3(-beyond, static_cast<double>(row) * grid.pitch,
                                                      static_cast<double>(layer) * grid.rise);
      const glm::dvec3 far = near + glm::dvec3(grid.length + 2.0 * beyond, 0.0, 0.0);
      const bool isBack = way.size() % 4 != 0;
      way.push_back(isBack ? far : near);
      way.push_back(isBack ? near : far);
    }
  }
  return way;
}

/// Point of a polyline at a share of its length.
glm::dvec3 pointAt(const std::vector<glm::dvec3>& way, double share) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i)
    length += glm::distance(way[i - 1], way[i]);
  double left = share * length;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const double piece = glm::distance(way[i - 1], way[i]);
    if (left <= piece) return way[i - 1] + left / piece * (way[i] - way[i - 1]);
    left -= piece;
  }
  return way.back();
}

/// @param offsets  Of scans that move as one, along x [m].
PathBenchScene amongParts(const char* name, std::size_t poses, std::span<const double> offsets) {
  constexpr std::uint32_t kFrequency = 16;
  // The channels are wider than twice this by a twentieth.
  constexpr double kRadius = 0.72, kBeyond = 1.0, kTurns = 24.0;
  Scene scene = sceneOf(fittedParts("fitted200", {}));
  std::vector<Part> scans;
  std::uint64_t seed = 0;
  for (const double offset : offsets)
    scans.push_back(test::partOf(test::freshGeometryOf(roundedTo(organicMesh(kFrequency, ++seed), kRadius)),
                                 fmt::format("Scan {}", seed).c_str(),
                                 {glm::dquat(1.0, 0.0, 0.0, 0.0), {offset, 0.0, 0.0}}));
  const double beyond = kBeyond + kRadius + offsets.back() - offsets.front();
  const std::vector<glm::dvec3> way = channelWay(channelsOf({}), beyond);
  for (Part& scan : scans)
    scan.worldFromPart.translation += way.front();
  if (scans.size() == 1) {
    scene.setMovingPart(scene.add(std::move(scans.front())));
  } else {
    const GroupId group = scene.addGroup({{}, "Scans", {}, false});
    for (Part& scan : scans) {
      scan.group = group;
      scene.add(std::move(scan));
    }
    scene.setMovingGroup(group);
  }
  AssemblyPath path = pathOf(scene, poses, [&](double share) {
    const glm::dquat turn =
        glm::angleAxis(2.0 * std::numbers::pi * kTurns * share, glm::dvec3(1.0, 0.0, 0.0));
    return RigidTransform{turn, pointAt(way, share) + glm::dvec3(offsets.front(), 0.0, 0.0)};
  });
  return {name, std::move(scene), std::move(path)};
}

PathBenchScene suggestedPath(const char* name, test::SuggestScene made) {
  constexpr std::uint64_t kMaxSeeds = 5;
  for (std::uint64_t seed = 1; seed <= kMaxSeeds; ++seed) {
    PathSearchResult result = searchPath(made.scene, made.goal, {.seed = seed});
    if (result.end == PathSearchEnd::Found) return {name, std::move(made.scene), std::move(result.path)};
  }
  throw Error(name, fmt::format("none of {} searches found a path", kMaxSeeds), "see nearfit-bench suggest");
}

PathBenchScene recordedPath(std::size_t poses) {
  constexpr double kTolerance = 20e-6;
  PressedParts parts{.scene = test::plateWithHoleMesh(60e-3, 40e-3, 10e-3, 48),
                     .part = test::cylinderMesh(9.9e-3, 40e-3, 48),
                     .motion = {},
                     .margin = 20e-6};
  parts.motion.press = 1e-3;
  parts.motion.swing = 3.0;
  parts.motion.slide = 20e-3;
  parts.motion.turn = 1.0;
  parts.motion.tilt = 0.01;
  const PressedWalk walk = walkPressed(parts, poses);
  std::vector<MotionRow> rows(walk.poses.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].time = ServoLoop::kPeriod * static_cast<double>(i);
    rows[i].proxy = walk.poses[i];
  }
  Scene scene;
  scene.add(test::partOf(test::freshGeometryOf(parts.scene), "Block"));
  scene.setMovingPart(scene.add(test::partOf(test::freshGeometryOf(parts.part), "Peg", walk.poses.front())));
  const AssemblyPath recorded = pathOfMotion(rows, scene);
  const PathCertifier certifier(scene, recorded, defaultSeparation(scene, recorded));
  return {"recorded-peg", std::move(scene), thinned(recorded, certifier, kTolerance).path};
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
  return {
      {"peg", [=] { return pegPath(poses); }},
      {"rocks", [=] { return rockPath(poses); }},
      {"pipe", [=] { return pipePath(poses); }},
      {"among-200", [=] { return amongParts("among-200", poses, std::array{0.0}); }},
      {"group-among-200", [=] { return amongParts("group-among-200", poses, std::array{0.0, 1.3, 2.6}); }},
      {"suggested-peg", [] { return suggestedPath("suggested-peg", test::pegBesideHole()); }},
      {"suggested-pipe", [] { return suggestedPath("suggested-pipe", test::pipeIn()); }},
      {"recorded-peg", [=] { return recordedPath(poses); }}};
}

std::vector<PathSceneEntry> sharedPathScenes(const fs::path& shared, std::size_t poses) {
  const fs::path models = shared / "models" / "public";
  if (shared.empty() || !fs::is_directory(models)) return {};
  return {{"peghole", [=] { return pegholePath(models / "peghole", poses); }},
          {"pump", [=] { return pumpPath(models / "pump", poses); }}};
}

}  // namespace nearfit::bench
