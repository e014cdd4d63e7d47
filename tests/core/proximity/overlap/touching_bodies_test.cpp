#include "core/proximity/overlap/touching_bodies.h"

#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/overlap/interference.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::touching_bodies_test {
namespace {

constexpr double kTolerance = 1e-7;

RigidTransform at(double x, double y, double z) {
  return {{1, 0, 0, 0}, {x, y, z}};
}

/// A cube of side 1 about the origin, and a part.
bool doesTouchCube(const TriangleMesh& part, const RigidTransform& pose) {
  const NormalConeTree cube(test::boxMesh(glm::dvec3(1.0))), tree(part);
  const bool doesTouch = doOnlyTouch(cube, tree, pose, kTolerance);
  EXPECT_EQ(doOnlyTouch(cube, tree, pose, kTolerance, findInterference(cube, tree, pose)), doesTouch);
  return doesTouch;
}

TEST(TouchingBodies, FlushFacesTouchAndPenetrationByAMicrometreDoesNot) {
  const TriangleMesh small = test::boxMesh(glm::dvec3(0.5));
  EXPECT_TRUE(doesTouchCube(small, at(0.1, 0.05, 0.75)));
  EXPECT_TRUE(doesTouchCube(small, at(-0.75, 0.0, 0.0)));
  EXPECT_TRUE(doesTouchCube(small, at(0.0, 0.0, 0.75 - 0.5 * kTolerance))) << "within the tolerance";
  EXPECT_FALSE(doesTouchCube(small, at(0.1, 0.05, 0.75 - 1e-6)));
  EXPECT_FALSE(doesTouchCube(small, at(0.1, 0.05, 0.75 + 1e-6))) << "they are apart";
  EXPECT_FALSE(doesTouchCube(small, at(0.0, 0.0, 0.0))) << "one is inside the other";
}

TEST(TouchingBodies, EqualBoxesOnEachOtherTouch) {
  const TriangleMesh equal = test::boxMesh(glm::dvec3(1.0));
  EXPECT_TRUE(doesTouchCube(equal, at(0.0, 0.0, 1.0)));
  EXPECT_TRUE(doesTouchCube(equal, at(0.0, -1.0, 0.0)));
  EXPECT_TRUE(doesTouchCube(equal, at(1.0, 1.0, 0.0))) << "along an edge";
  EXPECT_FALSE(doesTouchCube(equal, at(0.0, 0.0, 0.999)));
}

TEST(TouchingBodies, APartInACornerTouchesBothWalls) {
  constexpr double kHalfHole = 0.5, kEighth = 0.78539816339744831;
  const TriangleMesh hole = test::transformed(test::tubeMesh(std::sqrt(2.0) * kHalfHole, 1.2, 1.0, 4), 1.0,
                                              {glm::angleAxis(kEighth, glm::dvec3(0, 0, 1)), {}});
  const NormalConeTree walls(hole), cube(test::boxMesh(glm::dvec3(0.25)));
  const double corner = kHalfHole - 0.125 + 0.25 * kTolerance;
  EXPECT_TRUE(doOnlyTouch(walls, cube, at(corner, corner, 0.0), kTolerance));
  EXPECT_FALSE(doOnlyTouch(walls, cube, at(corner, corner + 1e-3, 0.0), kTolerance));
}

TEST(TouchingBodies, ATurnedCubeTouchesWithItsEdge) {
  constexpr double kQuarter = 0.78539816339744831;
  const TriangleMesh cube = test::boxMesh(glm::dvec3(0.5));
  RigidTransform pose{glm::angleAxis(kQuarter, glm::dvec3(0, 1, 0)), {0.0, 0.0, 0.5 + std::sqrt(0.125)}};
  pose.translation.z -= 0.25 * kTolerance;
  EXPECT_TRUE(doesTouchCube(cube, pose));
  pose.translation.z -= 1e-5;
  EXPECT_FALSE(doesTouchCube(cube, pose));
}

}  // namespace
}  // namespace nearfit::touching_bodies_test
