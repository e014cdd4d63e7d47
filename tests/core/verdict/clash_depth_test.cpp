#include "core/verdict/clash_depth.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/overlap/interference.h"
#include "tests/core/verdict/cell_solids.h"
#include "tests/exact/exact_meeting.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/random_values.h"

namespace nearfit::clash_depth_test {
namespace {

std::optional<ClashDepth> depthOf(const TriangleMesh& scene, const TriangleMesh& part,
                                  const RigidTransform& pose) {
  const NormalConeTree sceneTree(scene), partTree(part);
  const auto sceneConvex = convexBodyOf(sceneTree.mesh()), partConvex = convexBodyOf(partTree.mesh());
  LmdScratch scratch(1024);
  const auto found = findClashDepth({sceneTree, sceneConvex ? &*sceneConvex : nullptr},
                                    {partTree, partConvex ? &*partConvex : nullptr}, pose, scratch);
  if (!found) return found;
  EXPECT_NEAR(glm::length(found->translation.direction), 1.0, 1e-12);
  // Beyond it, by a little more than rounding, they are apart.
  RigidTransform moved = pose;
  moved.translation += (found->translation.length * (1.0 + 1e-6) + 1e-9) * found->translation.direction;
  EXPECT_EQ(findInterference(sceneTree, partTree, moved).kind, InterferenceKind::Disjoint);
  return found;
}

RigidTransform at(const glm::dvec3& place) {
  return {glm::dquat(1, 0, 0, 0), place};
}

TEST(ClashDepth, BoxesAreFreedAlongTheirLeastOverlap) {
  const TriangleMesh box = test::boxMesh(glm::dvec3(1.0));
  const auto found = depthOf(box, box, at({0.7, 0.1, 0.05}));
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->isExact);
  EXPECT_NEAR(found->translation.length, 0.3, 1e-12);
  EXPECT_NEAR(found->translation.direction.x, 1.0, 1e-12);
}

TEST(ClashDepth, ATiltedBoxIsFreedByTheFaceThatItsEdgePasses) {
  const TriangleMesh box = test::boxMesh(glm::dvec3(1.0));
  const RigidTransform pose{glm::angleAxis(std::numbers::pi / 4, glm::dvec3(0, 0, 1)), {1.0, 0.0, 0.0}};
  const auto found = depthOf(box, box, pose);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->isExact);
  EXPECT_NEAR(found->translation.length, std::numbers::sqrt2 / 2 - 0.5, 1e-12);
  EXPECT_NEAR(found->translation.direction.x, 1.0, 1e-12);
}

TEST(ClashDepth, BarsThatCrossEdgeToEdgeAreFreedAcrossBothEdges) {
  // Square bars on their edges, along x below and along y above, each 0.1 into the other.
  const TriangleMesh bar = test::boxMesh({4.0, 1.0, 1.0});
  const glm::dquat onEdge = glm::angleAxis(std::numbers::pi / 4, glm::dvec3(1, 0, 0));
  const TriangleMesh lower = test::transformed(bar, 1.0, {onEdge, {}});
  const RigidTransform pose{glm::angleAxis(std::numbers::pi / 2, glm::dvec3(0, 0, 1)) * onEdge,
                            {0.0, 0.0, std::numbers::sqrt2 - 0.1}};
  const auto found = depthOf(lower, bar, pose);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->isExact);
  EXPECT_NEAR(found->translation.length, 0.1, 1e-12);
  EXPECT_NEAR(found->translation.direction.z, 1.0, 1e-9);
}

/// How far the part must move along a direction to pass the scene, by their extents.
double widthAlong(const TriangleMesh& scene, const TriangleMesh& part, const RigidTransform& pose,
                  const glm::dvec3& direction) {
  double highest = -std::numeric_limits<double>::infinity(), lowest = -highest;
  for (const glm::dvec3& p : scene.vertices())
    highest = std::max(highest, glm::dot(direction, p));
  for (const glm::dvec3& p : part.vertices())
    lowest = std::min(lowest, glm::dot(direction, pose.applyToPoint(p)));
  return highest - lowest;
}

TEST(ClashDepth, NoDirectionFreesConvexBodiesByLess) {
  test::RandomValues random(5);
  const TriangleMesh ball = test::icosphereMesh(0.5, 2), rod = test::boxMesh({0.3, 0.4, 1.5});
  for (int round = 0; round < 12; ++round) {
    const TriangleMesh& part = round % 2 == 0 ? ball : rod;
    RigidTransform pose = random.pose().normalized();
    pose.translation = random.vector(0.3);
    const auto found = depthOf(ball, part, pose);
    ASSERT_TRUE(found) << round;
    EXPECT_TRUE(found->isExact);
    EXPECT_NEAR(widthAlong(ball, part, pose, found->translation.direction), found->translation.length, 1e-12);
    for (int i = 0; i < 4000; ++i) {
      // Near the one found, and everywhere.
      const glm::dvec3 any = random.vector(1.0);
      const glm::dvec3 direction =
          glm::normalize(i % 2 == 0 ? any : found->translation.direction + 0.1 * any);
      ASSERT_GE(widthAlong(ball, part, pose, direction), found->translation.length - 1e-12);
    }
  }
}

TEST(ClashDepth, ABoxInACornerIsFreedFromAllThreeWallsAtOnce) {
  const glm::dvec3 into(0.03, 0.02, 0.01);
  const auto found =
      depthOf(test::cornerSolid(), test::boxMesh(glm::dvec3(0.5)), at(glm::dvec3(0.25) - into));
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->isExact);
  EXPECT_GE(found->translation.length, glm::length(into) - 1e-9);
  EXPECT_LE(found->translation.length, glm::length(into) * (1.0 + 1e-5));
}

TEST(ClashDepth, ABoxOnAFloorIsFreedFromTheWallAlthoughItStaysOnTheFloor) {
  const auto found =
      depthOf(test::floorAndWall(), test::boxMesh(glm::dvec3(0.5)), at({0.25 - 0.01, 0.0, 0.25}));
  ASSERT_TRUE(found);
  EXPECT_GE(found->translation.length, 0.01 - 1e-9);
  EXPECT_LE(found->translation.length, 0.01 * (1.0 + 1e-5));
}

TEST(ClashDepth, APegInABoreThatIsTooNarrowIsFreedAlongTheAxisOrAcrossIt) {
  constexpr std::uint32_t kSegments = 32;
  const TriangleMesh tube = test::tubeMesh(0.3, 0.5, 1.0, kSegments);
  const auto shallow = depthOf(tube, test::cylinderMesh(0.35, 1.0, kSegments), at({0.0, 0.0, 0.9}));
  ASSERT_TRUE(shallow);
  EXPECT_NEAR(shallow->translation.length, 0.1, 1e-8);
  EXPECT_NEAR(shallow->translation.direction.z, 1.0, 1e-6);
  // Through and through, it is shorter across: to where the round outsides part.
  const auto through = depthOf(tube, test::cylinderMesh(0.35, 3.0, kSegments), at({0.0, 0.0, 0.0}));
  ASSERT_TRUE(through);
  EXPECT_LE(through->translation.length, 0.85 + 1e-8);
  EXPECT_GE(through->translation.length, 0.85 * std::cos(std::numbers::pi / kSegments) - 1e-8);
}

TEST(ClashDepth, ABodyInsideAnotherIsFreedOutOfItsNearestSide) {
  const auto convex =
      depthOf(test::boxMesh(glm::dvec3(4.0)), test::boxMesh(glm::dvec3(1.0)), at({0.5, 0, 0}));
  ASSERT_TRUE(convex);
  EXPECT_TRUE(convex->isExact);
  EXPECT_NEAR(convex->translation.length, 2.0, 1e-12);
  const auto hollow = depthOf(test::cornerSolid(), test::boxMesh(glm::dvec3(0.2)), at({-0.5, -0.5, 0.5}));
  ASSERT_TRUE(hollow);
  EXPECT_NEAR(hollow->translation.length, 0.6, 1e-6);
}

TEST(ClashDepth, JaggedBodiesAreFreeAfterItAndNoAxisOfTheirBoxesIsShorter) {
  test::RandomValues random(3);
  int tried = 0;
  for (std::uint64_t round = 0; round < 10; ++round) {
    const TriangleMesh a = test::starMesh(2 * round, 0.5, 1, 0.4);
    const TriangleMesh b = test::starMesh(2 * round + 1, 0.5, 1, 0.4);
    RigidTransform pose = random.pose().normalized();
    pose.translation = random.vector(0.3);
    const auto found = depthOf(a, b, pose);
    if (!found) continue;
    ++tried;
    EXPECT_FALSE(found->isExact);
    RigidTransform moved = pose;
    moved.translation += found->translation.length * found->translation.direction;
    EXPECT_FALSE(test::doSurfacesMeetExactly(a, b, moved));
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        glm::dvec3 direction(0.0);
        direction[axis] = sign;
        EXPECT_LE(found->translation.length, widthAlong(a, b, pose, direction) + 1e-8);
      }
    }
  }
  EXPECT_GT(tried, 5);
}

TEST(ClashDepth, TheSearchCanBeBounded) {
  const NormalConeTree corner(test::cornerSolid()), ball(test::icosphereMesh(0.5, 3));
  LmdScratch scratch(1024);
  EXPECT_FALSE(findClashDepth({corner}, {ball}, at({0.1, 0.1, 0.1}), scratch, {.maxNodePairs = 1}));
}

TEST(ConvexBody, KnowsConvexMeshesFromOthers) {
  EXPECT_TRUE(convexBodyOf(test::boxMesh({1, 2, 3})));
  EXPECT_TRUE(convexBodyOf(test::icosphereMesh(1.0, 2)));
  EXPECT_TRUE(convexBodyOf(test::cylinderMesh(1.0, 1.0, 12)));
  EXPECT_FALSE(convexBodyOf(test::turned(test::boxMesh({1, 2, 3}))));
  EXPECT_FALSE(convexBodyOf(test::cornerSolid()));
  EXPECT_FALSE(convexBodyOf(test::torusMesh(1.0, 0.3, 12, 8)));
  EXPECT_FALSE(convexBodyOf(test::squareMesh(1.0, 2)));
  EXPECT_FALSE(convexBodyOf(test::joined(test::boxMesh({1, 1, 1}), test::boxMesh({1, 1, 1}, {3, 0, 0}))));
}

}  // namespace
}  // namespace nearfit::clash_depth_test
