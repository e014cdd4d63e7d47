#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"
#include "core/path/assembly_path.h"
#include "core/path/path_certifier.h"
#include "core/scene/scene.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::test {

/// A part that moves among others, and its path.
struct PathScene {
  Scene scene;
  AssemblyPath path;

  const Part& part(const char* name) const { return *scene.findByName(name); }
};

/// Pose without a turn.
inline RigidTransform at(double x, double y, double z) {
  return {glm::dquat(1.0, 0.0, 0.0, 0.0), glm::dvec3(x, y, z)};
}

/// A path of one part with a pose each second.
inline AssemblyPath pathThrough(const char* part, const std::vector<RigidTransform>& poses) {
  AssemblyPath path;
  path.parts = {part};
  for (const RigidTransform& pose : poses)
    path.poses.push_back({static_cast<double>(path.poses.size()), pose});
  return path;
}

/// A unit cube that goes straight along x from -3 to 3 m, past another one with a gap between their sides, in two poses.
/// The distance at x is the gap where they overlap along x, and otherwise that of two edges.
inline PathScene cubePastCube(double gap) {
  PathScene made;
  made.scene.add(partOf(geometryOf(boxMesh({1, 1, 1})), "Post"));
  made.scene.add(partOf(geometryOf(boxMesh({1, 1, 1})), "Cube", at(-3.0, 1.0 + gap, 0.0)));
  made.path = pathThrough("Cube", {at(-3.0, 1.0 + gap, 0.0), at(3.0, 1.0 + gap, 0.0)});
  return made;
}
/// Distance of those cubes at a time [m].
inline double cubeDistance(double gap, double time) {
  const double x = std::abs(-3.0 + 6.0 * time);
  return std::hypot(std::max(0.0, x - 1.0), gap);
}

/// Segments of ring and bore below.
constexpr std::uint32_t kRingSegments = 48;

/// A bar that makes a full turn about z in four steps within a ring of inner radius 1 m: its long edges are `radius` from
/// the axis. The ring's inner wall is a polygon, so the gap is between (cos(pi / n) - radius) and (1 - radius).
inline PathScene barInRing(double radius) {
  constexpr double kWidth = 0.2;
  const double length = 2.0 * std::sqrt(radius * radius - 0.25 * kWidth * kWidth);
  PathScene made;
  made.scene.add(partOf(geometryOf(tubeMesh(1.0, 1.5, 1.0, kRingSegments)), "Ring"));
  made.scene.add(partOf(geometryOf(boxMesh({length, kWidth, 0.4})), "Bar"));
  std::vector<RigidTransform> poses;
  for (int quarter = 0; quarter <= 4; ++quarter)
    poses.push_back({rotationOf({0.0, 0.0, 0.5 * std::numbers::pi * quarter}), glm::dvec3(0.0)});
  made.path = pathThrough("Bar", poses);
  return made;
}

/// A rectangular peg that is screwed down a bore of radius 1 m, half a turn and 0.5 m in each of four steps of two: its
/// long edges are `radius` from the axis all the way. The gap is as in barInRing().
inline PathScene pegScrewedIn(double radius) {
  const double side = std::sqrt(2.0) * radius;
  PathScene made;
  made.scene.add(partOf(geometryOf(tubeMesh(1.0, 1.5, 6.0, kRingSegments)), "Bore"));
  made.scene.add(partOf(geometryOf(boxMesh({side, side, 0.5})), "Peg"));
  std::vector<RigidTransform> poses;
  for (int step = 0; step <= 8; ++step)
    poses.push_back(
        {rotationOf({0.0, 0.0, 0.5 * std::numbers::pi * step}), glm::dvec3(0.0, 0.0, 1.0 - 0.25 * step)});
  made.path = pathThrough("Peg", poses);
  return made;
}

/// Least gap that the polygon of a ring of radius 1 m leaves, anywhere on the way; it is reached if an edge passes the
/// middle of a side [m].
inline double leastRingGap(double radius) {
  return std::cos(std::numbers::pi / kRingSegments) - radius;
}

}  // namespace nearfit::test
