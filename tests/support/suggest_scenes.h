#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"
#include "core/mesh/triangle_mesh.h"
#include "core/path/path_search.h"
#include "core/scene/scene.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::test {

/// A square plate about z with a round hole along it; 8 * segments faces.
/// @param side  More than three times the hole's radius.   @param segments  A multiple of 8.
inline TriangleMesh plateWithHoleMesh(double side, double thickness, double holeRadius,
                                      std::uint32_t segments) {
  const TriangleMesh tube = tubeMesh(holeRadius, 1.5 * holeRadius, thickness, segments);
  std::vector<glm::dvec3> vertices(tube.vertices().begin(), tube.vertices().end());
  for (glm::dvec3& v : vertices) {
    if (std::hypot(v.x, v.y) < 1.25 * holeRadius) continue;
    // Along its ray to the square; every eighth of a turn is at a corner.
    const double scale = 0.5 * side / std::max(std::abs(v.x), std::abs(v.y));
    v = {scale * v.x, scale * v.y, v.z};
  }
  return TriangleMesh(std::move(vertices), {tube.triangles().begin(), tube.triangles().end()});
}

/// Lengths of a pipe with a collar and a bend [m].
struct BentPipe {
  double radius = 5e-3, collarRadius = 12e-3, collarHeight = 4e-3;
  double leg = 40e-3;         ///< From the collar's end to the bend, and from there to the pipe's end.
  double bendRadius = 20e-3;  ///< Of the middle line.
};

/// A solid pipe: from the collar at the origin along z, then a quarter turn toward x, then along x. Flat ends.
inline TriangleMesh bentPipeMesh(const BentPipe& pipe, std::uint32_t segments, std::uint32_t bendSteps) {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  const auto addRing = [&](const glm::dvec3& middle, double angle, double radius) {
    const glm::dvec3 across(std::cos(angle), 0.0, -std::sin(angle)), up(0.0, 1.0, 0.0);
    for (std::uint32_t k = 0; k < segments; ++k) {
      const double a = 2.0 * std::numbers::pi * k / segments;
      vertices.push_back(middle + radius * (std::cos(a) * across + std::sin(a) * up));
    }
  };
  std::uint32_t rings = 0;
  const auto ring = [&](const glm::dvec3& middle, double angle, double radius) {
    addRing(middle, angle, radius);
    if (++rings == 1) return;
    const std::uint32_t before = (rings - 2) * segments, here = (rings - 1) * segments;
    for (std::uint32_t k = 0; k < segments; ++k) {
      const std::uint32_t next = (k + 1) % segments;
      triangles.push_back({before + k, before + next, here + next});
      triangles.push_back({before + k, here + next, here + k});
    }
  };
  ring({0, 0, 0}, 0.0, pipe.collarRadius);
  ring({0, 0, pipe.collarHeight}, 0.0, pipe.collarRadius);
  ring({0, 0, pipe.collarHeight}, 0.0, pipe.radius);
  for (std::uint32_t i = 0; i <= bendSteps; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / bendSteps, r = pipe.bendRadius;
    ring({r * (1.0 - std::cos(angle)), 0.0, pipe.leg + r * std::sin(angle)}, angle, pipe.radius);
  }
  const glm::dvec3 end(pipe.bendRadius + pipe.leg, 0.0, pipe.leg + pipe.bendRadius);
  ring(end, 0.5 * std::numbers::pi, pipe.radius);
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.emplace_back(0.0);
  vertices.push_back(end);
  const std::uint32_t last = (rings - 1) * segments;
  for (std::uint32_t k = 0; k < segments; ++k) {
    const std::uint32_t next = (k + 1) % segments;
    triangles.push_back({first, next, k});
    triangles.push_back({first + 1, last + k, last + next});
  }
  return TriangleMesh(std::move(vertices), std::move(triangles));
}

/// A scene with something in hand, and where it is to go.
struct SuggestScene {
  const char* name;
  Scene scene;
  PathGoal goal;
};

/// A peg of 40 mm with a play of some 0.1 mm in a hole as deep: out of it.
inline SuggestScene pegInHole() {
  SuggestScene made{"peg out", {}, {}};
  made.scene.add(partOf(geometryOf(plateWithHoleMesh(60e-3, 40e-3, 10e-3, 48)), "Block"));
  made.scene.setMovingPart(made.scene.add(partOf(geometryOf(cylinderMesh(9.9e-3, 40e-3, 48)), "Peg")));
  return made;
}

/// The peg lies beside the block, turned by a right angle: into the hole.
inline SuggestScene pegBesideHole() {
  SuggestScene made = pegInHole();
  made.name = "peg in";
  made.goal.pose = RigidTransform{};
  Part peg = *made.scene.findByName("Peg");
  peg.worldFromPart = {rotationOf({0.5 * std::numbers::pi, 0.0, 0.0}), {55e-3, 0.0, 30e-3}};
  made.scene.replace(peg);
  return made;
}

/// Pose of the pipe with its collar before the plate and its bend behind it.
inline RigidTransform pipeInPlate() {
  return {rotationOf({std::numbers::pi, 0.0, 0.0}), {0.0, 0.0, 25e-3}};
}

/// A bent pipe through a plate's hole, of 1.5 times its radius: the collar does not fit through, so that the pipe comes
/// out only round its bend.
inline SuggestScene pipeOut() {
  SuggestScene made{"pipe out", {}, {}};
  made.scene.add(partOf(geometryOf(plateWithHoleMesh(200e-3, 4e-3, 7.5e-3, 32)), "Plate"));
  made.scene.setMovingPart(
      made.scene.add(partOf(solidGeometryOf(bentPipeMesh({}, 20, 10)), "Pipe", pipeInPlate())));
  return made;
}

/// The pipe lies before the plate: into it.
inline SuggestScene pipeIn() {
  SuggestScene made = pipeOut();
  made.name = "pipe in";
  made.goal.pose = pipeInPlate();
  Part pipe = *made.scene.findByName("Pipe");
  pipe.worldFromPart = {glm::dquat(1.0, 0.0, 0.0, 0.0), {-20e-3, 10e-3, 80e-3}};
  made.scene.replace(pipe);
  return made;
}

/// A ball in a closed box: nothing leads out.
inline SuggestScene ballInBox() {
  SuggestScene made{"ball in box", {}, {}};
  made.scene.add(
      partOf(geometryOf(joined(boxMesh({0.1, 0.1, 0.1}), turned(boxMesh({0.08, 0.08, 0.08})))), "Box"));
  made.scene.setMovingPart(made.scene.add(partOf(geometryOf(icosphereMesh(0.02, 2)), "Ball")));
  return made;
}

}  // namespace nearfit::test
