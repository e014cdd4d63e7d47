// Scenes with less room than the margin asks for.
#include <glm/gtc/quaternion.hpp>

#include "tests/stress/stress_scene.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::stress {
namespace {

constexpr double kNarrowMargin = 5e-5;

StressScene pegInBore() {
  constexpr double kPeg = 8e-3, kClearance = 2e-5;
  return stressScene({{test::tubeMesh(kPeg + kClearance, 12.5e-3, 9e-3, 64)}},
                     test::cylinderMesh(kPeg, 50e-3, 64), placedAt({0.0, 0.0, 0.0}), kNarrowMargin);
}

StressScene wedgeInGroove() {
  // Sides one degree steeper than the groove's: it jams on its edges.
  constexpr double kGroove = 10.0 * 0.017453292519943295, kWedge = 9.0 * 0.017453292519943295;
  const auto side = [](double sign) {
    return PlacedBody{test::boxMesh({0.1, 0.2, 0.2}, {0.05 * sign, 0.0, 0.1}),
                      {glm::angleAxis(sign * kGroove, glm::dvec3(0.0, 1.0, 0.0)), glm::dvec3(0.0)}};
  };
  const RigidTransform edgeDown{glm::dquat(0.0, 1.0, 0.0, 0.0), {0.0, 0.0, 0.1}};
  StressScene scene = stressScene({side(1.0), side(-1.0)}, test::transformed(test::wedgeMesh(kWedge), 0.02),
                                  edgeDown, kNarrowMargin);
  scene.lure.translation = glm::dvec3(0.0);
  return scene;
}

/// Bars of 0.5 mm with holes of 1 mm, and a needle of 0.4 mm.
StressScene needleInGrid() {
  constexpr int kBars = 3;
  constexpr double kPitch = 1.5e-3, kBar = 0.5e-3, kLength = 12e-3;
  TriangleMesh grid;
  for (int i = -kBars; i <= kBars; ++i) {
    const double place = kPitch * i;
    grid = test::joined(grid, test::boxMesh({kLength, kBar, kBar}, {0.0, place, 0.0}));
    grid = test::joined(grid, test::boxMesh({kBar, kLength, kBar}, {place, 0.0, 0.0}));
  }
  const double hole = 0.5 * kPitch;
  StressScene scene = stressScene({{grid}}, test::cylinderMesh(0.2e-3, 30e-3, 6),
                                  placedAt({hole, hole, 20e-3}), kNarrowMargin);
  scene.lure = placedAt({hole, hole, 2e-3});
  return scene;
}

/// A block between plates that leave a micrometre on either side.
StressScene blockBetweenPlates() {
  constexpr double kBlock = 10e-3, kRoom = 1e-6, kPlate = 5e-3;
  const double height = 0.5 * (kBlock + kPlate) + kRoom;
  const TriangleMesh plate = test::boxMesh({0.1, 0.1, kPlate});
  return stressScene({{plate, placedAt({0.0, 0.0, height})}, {plate, placedAt({0.0, 0.0, -height})}},
                     test::boxMesh({0.03, 0.03, kBlock}), placedAt({0.0, 0.0, 0.0}), kNarrowMargin);
}

}  // namespace

std::vector<StressEntry> narrowScenes() {
  return {{"peg-bore", "cylinder of 16 mm in a bore with 0.02 mm of clearance", pegInBore, 350.0},
          {"wedge-jam", "wedge in a groove that is one degree wider", wedgeInGroove, 85.0},
          {"needle-grid", "needle of 0.4 mm through a grid with holes of 1 mm", needleInGrid, 17.0},
          {"slot-1um", "block between two plates, 1 um on either side", blockBetweenPlates, 360.0}};
}

}  // namespace nearfit::stress
