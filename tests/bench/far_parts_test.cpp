#include "tests/bench/far_parts.h"

#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace nearfit::bench::far_parts_test {
namespace {

const Ball kBall{{1.0, -2.0, 3.0}, 1.5};
const FarField kField{kBall, 1.0, 0.5, 3};

TEST(BallAround, HoldsTheSceneAndThePartAtEachPose) {
  const PathBodies bodies{{0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, 1.0, 0.25, 2.0};
  std::vector<RigidTransform> path(2);
  path[0].translation = {2.5, 0.0, 0.0};
  path[1].translation = {-0.5, 3.0, 0.0};
  const Ball ball = ballAround(bodies, path);
  EXPECT_GE(ball.radius, glm::length(ball.centre) + 1.0);
  EXPECT_GE(ball.radius, glm::distance(ball.centre, {3.0, 0.0, 0.0}) + 0.25);
  EXPECT_GE(ball.radius, glm::distance(ball.centre, {0.0, 3.0, 0.0}) + 0.25);
  // No larger than the ball about the box of x from -1 to 3.25 and y from -1 to 3.25.
  EXPECT_LE(ball.radius, glm::length(glm::dvec3(4.25, 4.25, 2.0)) / 2.0);
}

TEST(FarParts, NoVertexIsInTheBallAndSomeAreBesideIt) {
  const std::vector<PartGeometryPtr> geometries = farGeometries(1.0);
  double least = 1e9, farthest = 0.0;
  for (const Part& part : farParts(kField, geometries, 600)) {
    for (const glm::dvec3& p : part.geometry->mesh.vertices()) {
      const double away = glm::distance(part.worldFromPart.applyToPoint(p), kBall.centre);
      least = std::min(least, away);
      farthest = std::max(farthest, away);
    }
  }
  EXPECT_GT(least, kBall.radius);
  EXPECT_LT(least, kBall.radius + 0.25);
  // 600 cubes of 0.5 around the ball fill one of 2.77, to which the largest part adds half a metre and
  // reaches half a diagonal beyond.
  EXPECT_LT(farthest, 2.77 + 0.5 + 0.25 + 0.01);
}

TEST(FarParts, SameFieldGivesTheSamePosesAndFewGeometries) {
  const std::vector<PartGeometryPtr> geometries = farGeometries(1.0);
  const std::vector<Part> a = farParts(kField, geometries, 50), b = farParts(kField, geometries, 50);
  std::set<PartGeometryPtr> shown;
  std::set<std::string> names;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].worldFromPart.translation, b[i].worldFromPart.translation);
    EXPECT_EQ(a[i].worldFromPart.rotation, b[i].worldFromPart.rotation);
    shown.insert(a[i].geometry);
    names.insert(a[i].name);
  }
  EXPECT_EQ(shown.size(), geometries.size());
  EXPECT_EQ(names.size(), 50U);
}

TEST(FarGeometries, HaveHundredsToThousandsOfTrianglesAndAtMostHalfTheSize) {
  for (const PartGeometryPtr& geometry : farGeometries(2.0)) {
    EXPECT_GE(geometry->mesh.triangles().size(), 300U);
    EXPECT_LE(geometry->mesh.triangles().size(), 10'000U);
    EXPECT_LE(geometry->mesh.bounds().diagonal(), 1.0 + 1e-12);
  }
}

}  // namespace
}  // namespace nearfit::bench::far_parts_test
