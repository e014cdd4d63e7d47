#include "core/path/triangle_boxes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/exact/exact_meeting.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/random_values.h"

namespace nearfit::triangle_boxes_test {
namespace {

TriangleCorners randomTriangle(test::RandomValues& random, const glm::dvec3& about) {
  const glm::dvec3 a = about + random.vector(0.5), b = about + random.vector(0.5),
                   c = about + random.vector(0.5);
  return {a, b, c};
}

TEST(TriangleSlabs, AreAsWideAsTheExactDistance) {
  test::RandomValues random(1);
  for (int i = 0; i < 400; ++i) {
    const TriangleCorners a = randomTriangle(random, glm::dvec3(0.0)),
                          b = randomTriangle(random, random.vector(1.0));
    const double distance = test::exactDistance(a, b);
    if (distance > 0.0) {
      EXPECT_TRUE(areSlabApart(a, b, distance * (1.0 - 1e-9))) << i;
      EXPECT_FALSE(areSlabApart(a, b, distance * (1.0 + 1e-9))) << i;
    } else {
      EXPECT_FALSE(areSlabApart(a, b, 1e-9)) << i;
    }
  }
}

TEST(TriangleSlabs, HoldBesideTrianglesWithoutArea) {
  const TriangleCorners flat{glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)};
  const TriangleCorners needle{glm::dvec3(0.2, 0.2, 0.5), glm::dvec3(0.2, 0.2, 1.5),
                               glm::dvec3(0.2, 0.2, 1.0)};
  const TriangleCorners point{glm::dvec3(2, 0, 0), glm::dvec3(2, 0, 0), glm::dvec3(2, 0, 0)};
  EXPECT_TRUE(areSlabApart(flat, needle, 0.499));
  EXPECT_FALSE(areSlabApart(flat, needle, 0.501));
  EXPECT_TRUE(areSlabApart(flat, point, 0.999));
  EXPECT_FALSE(areSlabApart(flat, point, 1.001));
}

TEST(TriangleBoxes, ProveWhatTheExactDistanceOfTwoMeshesAllows) {
  test::RandomValues random(9);
  const TriangleMesh a = test::starMesh(1, 0.5, 1, 0.3), b = test::starMesh(2, 0.5, 1, 0.3);
  const TriangleBoxes boxesOfA(a), boxesOfB(b);
  TriangleBoxes::Waiting waiting;
  for (int i = 0; i < 20; ++i) {
    RigidTransform pose = random.pose().normalized();
    pose.translation = 1.2 * glm::normalize(random.vector(1.0) + glm::dvec3(1e-3));
    const double distance = test::leastDistanceExactly(a, b, pose);
    if (distance > 0.0) {
      EXPECT_TRUE(boxesOfA.isApart(boxesOfB, pose, distance * (1.0 - 1e-6), waiting)) << i;
      EXPECT_FALSE(boxesOfA.isApart(boxesOfB, pose, distance * (1.0 + 1e-6), waiting)) << i;
    } else {
      EXPECT_FALSE(boxesOfA.isApart(boxesOfB, pose, 1e-6, waiting)) << i;
    }
  }
}

TEST(TriangleBoxes, ProveNothingForAPoseThatIsNone) {
  const TriangleBoxes box(test::boxMesh({1, 1, 1}));
  TriangleBoxes::Waiting waiting;
  RigidTransform pose;
  pose.translation.x = std::nan("");
  EXPECT_FALSE(box.isApart(box, pose, 0.1, waiting));
  EXPECT_FALSE(box.isApart(box, {{1, 0, 0, 0}, {5, 0, 0}}, 0.0, waiting));
}

TEST(TriangleBoxes, MeshesFarFromTheirOriginLoseNoMoreThanRounding) {
  const glm::dvec3 far(1e4, -2e4, 3e4);
  const TriangleMesh a = test::boxMesh({1, 1, 1}, far),
                     b = test::boxMesh({1, 1, 1}, far + glm::dvec3(1.5, 0, 0));
  TriangleBoxes::Waiting waiting;
  EXPECT_TRUE(TriangleBoxes(a).isApart(TriangleBoxes(b), {}, 0.5 - 1e-8, waiting));
  EXPECT_FALSE(TriangleBoxes(a).isApart(TriangleBoxes(b), {}, 0.5 + 1e-8, waiting));
}

}  // namespace
}  // namespace nearfit::triangle_boxes_test
