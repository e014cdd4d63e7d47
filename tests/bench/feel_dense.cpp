#include "tests/bench/feel_dense.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "tests/bench/feel_certified.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench {
namespace {

using std::numbers::pi;

/// Random cuts of an uneven mesh, besides the even ones.
constexpr std::size_t kUnevenCuts = 1000;
constexpr std::uint64_t kUnevenSeed = 17;

/// A peg about z, from z = 0 up, whose lower rim has a chamfer.
TriangleMesh chamferedPeg(double radius, double height, double chamfer, std::uint32_t segments) {
  std::vector<glm::dvec3> vertices;
  const auto ring = [&](double r, double z) {
    for (std::uint32_t i = 0; i < segments; ++i) {
      const double angle = 2.0 * pi * i / segments;
      vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  };
  ring(radius - chamfer, 0.0);
  ring(radius, chamfer);
  ring(radius, height);
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < segments; ++i) {
    const std::uint32_t next = (i + 1) % segments;
    for (const std::uint32_t low : {0U, segments}) {
      const std::uint32_t high = low + segments;
      triangles.push_back({low + i, low + next, high + next});
      triangles.push_back({low + i, high + next, high + i});
    }
    if (i >= 1 && next != 0) {
      triangles.push_back({0, next, i});
      triangles.push_back({2 * segments, 2 * segments + i, 2 * segments + next});
    }
  }
  return {std::move(vertices), std::move(triangles)};
}

RigidTransform placedAt(const glm::dvec3& translation, const glm::dquat& rotation = {1.0, 0.0, 0.0, 0.0}) {
  return {rotation, translation};
}

PressingMotion pressing(const RigidTransform& start, const glm::dvec3& axis, const glm::dvec3& towards,
                        double press) {
  PressingMotion motion;
  motion.start = start;
  motion.axis = axis;
  motion.towards = towards;
  motion.press = press;
  return motion;
}

DenseScene blockOnPlate() {
  DenseScene scene{"block-plate",
                   "a block of 50 x 40 x 30 mm on a plate of 200 mm",
                   test::boxMesh({0.2, 0.2, 0.02}, {0.0, 0.0, -0.01}),
                   test::boxMesh({0.05, 0.04, 0.03}),
                   {}};
  scene.motion = pressing(placedAt({0.0, 0.0, 0.0155}), {0.8, 0.6, 0.0}, {0.0, 0.0, -1.0}, 2.5e-3);
  scene.motion.slide = 0.02;
  scene.motion.turn = 0.01;
  scene.motion.tilt = 0.01;
  return scene;
}

DenseScene edgeOnFlat() {
  DenseScene scene = blockOnPlate();
  scene.name = "edge-flat";
  scene.description = "the same block standing on an edge";
  const glm::dquat aslant = glm::angleAxis(0.25 * pi, glm::dvec3(1.0, 0.0, 0.0));
  // The lower edge is half the diagonal of the block's end below its middle.
  const double height = 0.5 * std::sqrt(0.5) * (0.04 + 0.03);
  scene.motion =
      pressing(placedAt({0.0, 0.0, height + 5e-4}, aslant), {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, 2.5e-3);
  scene.motion.slide = 0.02;
  return scene;
}

DenseScene inBore(const char* name, const char* description, const TriangleMesh& part) {
  return {name, description, test::tubeMesh(0.02, 0.03, 0.04, 32), part, {}, 16};
}

DenseScene pegInBore() {
  DenseScene scene = inBore("peg-bore", "a peg of 32 sides in a bore with 0.5 mm of play",
                            test::cylinderMesh(0.0195, 0.06, 32));
  scene.motion = pressing(placedAt({}), {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, 2e-3);
  scene.motion.swing = 1.0;
  scene.motion.slide = 5e-3;
  scene.motion.tilt = 0.02;
  return scene;
}

DenseScene chamferedPegIntoHole() {
  DenseScene scene = inBore("chamfered-peg", "a chamfered peg of 32 sides led into its hole, 0.5 mm of play",
                            chamferedPeg(0.0195, 0.06, 2e-3, 32));
  // Off by a millimetre: it slips in along its chamfer.
  scene.motion = pressing(placedAt({1e-3, 0.0, 0.0215}), {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, 0.03);
  scene.motion.tilt = 0.01;
  return scene;
}

TriangleMesh cutFinely(const TriangleMesh& mesh, std::uint32_t pieces, bool isUneven) {
  const TriangleMesh even = test::subdivided(mesh, static_cast<std::uint32_t>(std::countr_zero(pieces)));
  return isUneven ? test::cutUnevenly(even, kUnevenCuts, kUnevenSeed) : even;
}

}  // namespace

std::vector<DenseScene> denseScenes() {
  return {blockOnPlate(), edgeOnFlat(), pegInBore(), chamferedPegIntoHole()};
}

PressedWalk walkDense(const DenseScene& scene, std::uint32_t pieces, bool isUneven, std::size_t ticks) {
  return walkPressed({.scene = cutFinely(scene.scene, pieces, isUneven),
                      .part = cutFinely(scene.part, pieces, isUneven),
                      .motion = scene.motion},
                     ticks);
}

std::vector<FeelRow> denseRows(const DenseScene& scene, std::size_t ticks) {
  std::vector<FeelRow> rows;
  const PressedWalk coarse = walkDense(scene, 1, false, ticks);
  const auto add = [&](const PressedWalk& run, const std::string& label) {
    const std::string name = fmt::format("{} ({} triangles)", label, run.triangles);
    const auto row = [&](const char* quantity, const std::vector<double>& samples, double scale = 1.0) {
      rows.push_back(feelRow("dense", scene.name, name, quantity, samples, scale));
    };
    std::vector<double> off, forceOff;
    double strongest = 0.0;
    for (const Wrench& w : coarse.wrenches)
      strongest = std::max(strongest, glm::length(w.force));
    for (std::size_t i = 0; i < ticks; ++i) {
      off.push_back(glm::distance(run.poses[i].translation, coarse.poses[i].translation));
      forceOff.push_back(glm::distance(run.wrenches[i].force, coarse.wrenches[i].force) / strongest);
    }
    row("tick [us]", run.times, 1e6);
    row("p99 over that of x1", {p99(run) / p99(coarse)});
    row("off the pose of x1 [um]", off, 1e6);
    row("off the force of x1, of the strongest [%]", forceOff, 1e2);
    row("in contact", {static_cast<double>(run.held) / static_cast<double>(ticks)});
    row("ticks truncated", {static_cast<double>(run.truncated)});
    rows.push_back(certifiedRow("dense", scene.name, name, *run.bodies, run.poses));
  };
  add(coarse, "x1");
  for (std::uint32_t pieces = 4; pieces <= scene.finest; pieces *= 4)
    add(walkDense(scene, pieces, false, ticks), fmt::format("x{}", pieces));
  add(walkDense(scene, 4, true, ticks), "x4 uneven");
  return rows;
}

}  // namespace nearfit::bench
