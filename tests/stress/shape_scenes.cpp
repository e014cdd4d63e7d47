// Scenes whose shapes are hard: saddles, components that overlap, many bodies, meshes that are no solids.
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "tests/stress/stress_scene.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::stress {
namespace {

constexpr double kMargin = 1e-4;
constexpr double kRing = 0.4, kTube = 0.1;  ///< Of a ring, in sizes.

/// How often a circle of radius `radius` about the frame's z axis goes through the disc of the same radius of
/// another frame: once for rings that are linked, as many times either way for others.
int linkage(const RigidTransform& discFromRing, double radius) {
  constexpr int kPoints = 96;
  int through = 0;
  const auto point = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kPoints;
    return discFromRing.applyToPoint({radius * std::cos(angle), radius * std::sin(angle), 0.0});
  };
  for (int i = 0; i < kPoints; ++i) {
    const glm::dvec3 a = point(i), b = point(i + 1);
    if ((a.z < 0.0) == (b.z < 0.0)) continue;
    const glm::dvec3 crossing = a + (b - a) * (a.z / (a.z - b.z));
    if (std::hypot(crossing.x, crossing.y) < radius) through += a.z < 0.0 ? 1 : -1;
  }
  return through;
}

/// Three bars through each other in one mesh, and a cross of two cylinders in another.
StressScene overlappingComponents() {
  TriangleMesh bars = test::boxMesh({0.1, 0.02, 0.02});
  bars = test::joined(bars, test::boxMesh({0.02, 0.1, 0.02}, {0.01, 0.0, 0.005}));
  bars = test::joined(bars, test::boxMesh({0.02, 0.02, 0.1}, {0.0, 0.01, 0.0}));
  const TriangleMesh bar = test::cylinderMesh(0.006, 0.06, 12);
  const RigidTransform across{glm::angleAxis(1.5, glm::dvec3(1.0, 0.0, 0.0)), {0.001, 0.0, 0.0}};
  return stressScene({{bars}}, test::joined(bar, test::transformed(bar, 1.0, across)),
                     {{1.0, 0.0, 0.0, 0.0}, {0.06, 0.06, 0.06}}, kMargin);
}

/// Bodies of all kinds on a lattice, with hardly room for the part between them.
StressScene crowd() {
  constexpr double kPitch = 0.045;
  std::vector<PlacedBody> bodies;
  for (int i = 0; i < 27; ++i) {
    const glm::dvec3 place = kPitch * glm::dvec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (i == 13) continue;
    const glm::dquat turn = glm::angleAxis(0.3 * i, glm::normalize(glm::dvec3(1.0, i, 2.0)));
    bodies.push_back({i % 3 == 0   ? test::boxMesh({0.02, 0.02, 0.02})
                      : i % 3 == 1 ? test::icosphereMesh(0.015, 1)
                                   : test::coneMesh(0.012, 0.02, 8),
                      {turn, place}});
  }
  return stressScene(bodies, test::starMesh(3, 0.016, 1, 0.25), {}, kMargin);
}

/// A ball of slivers with faces given twice, which has no inside, and a cone.
StressScene slivers() {
  const TriangleMesh ball = test::withDuplicates(
      test::withFacesWithoutArea(test::withSlivers(test::icosphereMesh(0.03, 1), 1e5, 0.0)));
  return stressScene({{ball}}, test::coneMesh(0.01, 0.03, 9), {{1.0, 0.0, 0.0, 0.0}, {0.05, 0.01, 0.0}},
                     kMargin);
}

}  // namespace

StressScene linkedRings(double size, double margin, const RigidTransform& worldFromScene,
                        const glm::dvec3& offset) {
  const TriangleMesh ring = test::torusMesh(kRing * size, kTube * size, 20, 10);
  const RigidTransform place{{1.0, 0.0, 0.0, 0.0}, offset};
  const TriangleMesh mesh = test::transformed(ring, 1.0, place);
  const RigidTransform linked{glm::angleAxis(0.5 * std::numbers::pi, glm::dvec3(1.0, 0.0, 0.0)),
                              {kRing * size, 0.0, 0.0}};
  // Turned about the ring's own middle, wherever that is in the part's frame.
  const RigidTransform start = worldFromScene * place * linked * place.inverse();
  StressScene scene = stressScene({{mesh, worldFromScene}}, mesh, start.normalized(), margin);
  scene.lure = start;
  scene.size = 2.0 * size;
  const RigidTransform discFromWorld = (worldFromScene * place).inverse();
  const double radius = kRing * size;
  const int before = linkage(linked, radius);
  scene.isKept = [=](const RigidTransform& pose) {
    return linkage(discFromWorld * (pose * place), radius) == before;
  };
  return scene;
}

std::vector<StressEntry> shapeScenes() {
  return {
      {"rings", "two linked rings, saddle against saddle", [] { return linkedRings(0.1, kMargin); }, 85.0},
      {"overlapping", "components that overlap within either mesh", overlappingComponents, 6.0},
      {"crowd", "jagged ball among 26 bodies", crowd, 36.0},
      {"slivers", "cone against a ball of slivers and double faces, which is no solid", slivers, 85.0}};
}

}  // namespace nearfit::stress
