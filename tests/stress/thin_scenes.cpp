// Scenes of walls so thin that a step could leap over them.
#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "tests/stress/stress_scene.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::stress {
namespace {

constexpr double kThinMargin = 1e-4;
constexpr double kBox = 0.1;  ///< Sides of every box here [m].

/// Whether the part's first vertex is still inside, or outside, of the box about the origin.
std::function<bool(const RigidTransform&)> keptBy(const TriangleMesh& part, double side, bool isInside) {
  return [vertex = part.vertices()[0], half = 0.5 * side, isInside](const RigidTransform& pose) {
    const glm::dvec3 p = pose.applyToPoint(vertex);
    return (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < half) == isInside;
  };
}

StressScene withBox(const TriangleMesh& box, const TriangleMesh& part, bool isInside) {
  const glm::dvec3 start = isInside ? glm::dvec3(0.0) : glm::dvec3(kBox, 0.01, 0.02);
  StressScene scene = stressScene({{box}}, part, {{1.0, 0.0, 0.0, 0.0}, start}, kThinMargin);
  scene.isKept = keptBy(part, kBox, isInside);
  if (isInside) scene.lure.translation = glm::dvec3(0.5 * kBox);
  return scene;
}

TriangleMesh hollowBox(double wall) {
  return test::joined(test::boxMesh(glm::dvec3(kBox)),
                      test::turned(test::boxMesh(glm::dvec3(kBox - 2.0 * wall))));
}

/// Six open squares whose rims meet and share no vertex.
TriangleMesh boxOfSheets() {
  constexpr double kQuarter = 1.5707963267948966;
  const TriangleMesh square = test::squareMesh(kBox, 2);
  TriangleMesh box;
  for (int i = 0; i < 3; ++i) {
    const glm::dquat turn = i == 0   ? glm::dquat(1.0, 0.0, 0.0, 0.0)
                            : i == 1 ? glm::angleAxis(kQuarter, glm::dvec3(1.0, 0.0, 0.0))
                                     : glm::angleAxis(kQuarter, glm::dvec3(0.0, 1.0, 0.0));
    const glm::dvec3 normal = turn * glm::dvec3(0.0, 0.0, 0.5 * kBox);
    box = test::joined(box, test::transformed(square, 1.0, {turn, normal}));
    box = test::joined(box, test::transformed(square, 1.0, {turn, -normal}));
  }
  return box;
}

TriangleMesh jaggedBall() {
  return test::starMesh(7, 0.015, 1, 0.3);
}

}  // namespace

std::vector<StressEntry> thinScenes() {
  constexpr double kThin = 1e-6, kThick = 0.02;
  return {{"thin-wall", "jagged ball outside of a box whose walls are 1 um thick",
           [] { return withBox(hollowBox(kThin), jaggedBall(), false); }, 5.0},
          {"thin-wall-inside", "the ball inside of that box",
           [] { return withBox(hollowBox(kThin), jaggedBall(), true); }, 27.0},
          {"closed-box", "block inside of a closed box with thick walls",
           [] {
             StressScene scene = withBox(hollowBox(kThick), test::boxMesh({0.02, 0.025, 0.03}), true);
             return scene;
           },
           48.0},
          {"sheet-box", "jagged ball inside of six open sheets whose rims meet and share nothing",
           [] { return withBox(boxOfSheets(), jaggedBall(), true); }, 24.0},
          {"open-sheet", "open sheet in hand against an open sheet",
           [] {
             const TriangleMesh sheet = test::squareMesh(kBox, 4);
             return stressScene({{sheet}}, test::transformed(sheet, 0.5),
                                {glm::angleAxis(0.4, glm::dvec3(1.0, 0.0, 0.0)), {0.0, 0.0, 0.05}},
                                kThinMargin);
           },
           6.0}};
}

}  // namespace nearfit::stress
