#include "tests/bench/far_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/math/aabb.h"
#include "tests/bench/bench_shapes.h"
#include "tests/bench/portable_random.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::bench {
namespace {

/// Kept free beyond the ball for rounding, as a fraction of the lengths involved.
constexpr double kPadding = 1e-9;

void addBall(Aabb& box, const glm::dvec3& centre, double radius) {
  box.add(centre - glm::dvec3(radius));
  box.add(centre + glm::dvec3(radius));
}

glm::dquat randomRotation(std::mt19937_64& random) {
  const glm::dvec3 axis = randomDirection(random);
  return glm::angleAxis(2.0 * std::numbers::pi * uniform(random), axis);
}

/// Radius of the ball that has room around `inner` for `count` cubes.
double outerRadius(double inner, double cube, std::size_t count) {
  const double volume = static_cast<double>(count) * cube * cube * cube;
  return std::cbrt(inner * inner * inner + volume * 3.0 / (4.0 * std::numbers::pi));
}

}  // namespace

Ball ballAround(const PathBodies& bodies, std::span<const RigidTransform> path) {
  Aabb box;
  addBall(box, bodies.sceneCentre, bodies.sceneRadius);
  for (const RigidTransform& pose : path)
    addBall(box, pose.applyToPoint(bodies.partCentre), bodies.partRadius);
  Ball ball{box.centre(), glm::distance(box.centre(), bodies.sceneCentre) + bodies.sceneRadius};
  for (const RigidTransform& pose : path) {
    const double away = glm::distance(ball.centre, pose.applyToPoint(bodies.partCentre));
    ball.radius = std::max(ball.radius, away + bodies.partRadius);
  }
  return ball;
}

std::vector<PartGeometryPtr> farGeometries(double size) {
  const std::vector<TriangleMesh> meshes{gearMesh(9),        springMesh(120, 8),
                                         crankshaftMesh(12), organicMesh(12, 11),
                                         teapotMesh(),       test::cylinderMesh(1.0, 0.4, 96)};
  constexpr double kSizes[] = {0.1, 0.5};
  std::vector<PartGeometryPtr> geometries;
  for (const TriangleMesh& mesh : meshes) {
    for (const double fraction : kSizes) {
      const double scale = fraction * size / mesh.bounds().diagonal();
      geometries.push_back(test::freshGeometryOf(test::transformed(mesh, scale)));
    }
  }
  return geometries;
}

std::vector<Part> farParts(const FarField& field, std::span<const PartGeometryPtr> geometries,
                           std::size_t count) {
  std::mt19937_64 random(field.seed);
  std::vector<Part> parts;
  parts.reserve(count);
  double largest = 0.0;
  for (const PartGeometryPtr& geometry : geometries)
    largest = std::max(largest, geometry->mesh.bounds().diagonal());
  // The largest find room even where only one is asked for.
  const double outer = outerRadius(field.keepOut.radius, field.spacing, count) + largest;
  while (parts.size() < count) {
    const PartGeometryPtr& geometry = geometries[parts.size() % geometries.size()];
    const Aabb& box = geometry->mesh.bounds();
    const glm::dvec3 offset = outer * std::cbrt(uniform(random)) * randomDirection(random);
    const double least = (field.keepOut.radius + 0.5 * box.diagonal()) * (1.0 + kPadding);
    RigidTransform pose{randomRotation(random), glm::dvec3(0.0)};
    if (glm::length(offset) < least) continue;
    pose.translation = field.keepOut.centre + offset - pose.applyToVector(box.centre());
    parts.push_back(test::partOf(geometry, fmt::format("far {}", parts.size() + 1).c_str(), pose));
  }
  return parts;
}

}  // namespace nearfit::bench
