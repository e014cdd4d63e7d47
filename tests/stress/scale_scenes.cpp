// One scene at every size, and as far from the origin as double precision bears.
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "tests/stress/stress_scene.h"

namespace nearfit::stress {
namespace {

constexpr double kSize = 0.1;
/// From the origin, in diagonals.
constexpr double kFar = 1e6;

glm::dvec3 farAway() {
  return kFar * kSize * glm::normalize(glm::dvec3(0.6, -0.5, 0.7));
}

RigidTransform farPose() {
  return {glm::angleAxis(0.7, glm::normalize(glm::dvec3(1.0, 2.0, -1.0))), farAway()};
}

}  // namespace

std::vector<StressEntry> scaleScenes() {
  constexpr double kMargin = 1e-3 * kSize;
  return {{"tiny", "the rings, 1 mm large", [] { return linkedRings(1e-3, 1e-6); }, 94.0},
          {"huge", "the rings, 1 km large",
           [] {
             StressScene scene = linkedRings(1e3, 1.0);
             // Forces of 10 N over hundreds of metres are stored, and turns count ten thousand times less
             // than the coupling's turn scale reaches.
             scene.isEnergyBound = false;
             return scene;
           },
           29.0},
          {"far", "the rings, a million diagonals from the origin",
           [] { return linkedRings(kSize, kMargin, farPose()); }, 60.0},
          {"far-mesh", "the rings, their vertices a million diagonals from their frame's origin",
           [] { return linkedRings(kSize, kMargin, {}, farAway()); }, 130.0},
          {"far-fine", "the rings as far, at a margin of some thousand roundings",
           [] {
             StressScene scene = linkedRings(kSize, 3e-8, farPose());
             scene.cutoff = 0.01 * kSize;
             return scene;
           },
           46.0}};
}

}  // namespace nearfit::stress
