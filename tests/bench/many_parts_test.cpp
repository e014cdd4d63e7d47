#include "tests/bench/many_parts.h"

#include <set>
#include <tuple>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/exact/exact_meeting.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::bench::many_parts_test {
namespace {

/// Bodies of 80 and 180 triangles, two of which are moved into the one before.
const ManyPartsSize kSmall{
    .parts = 14, .shapes = 5, .frequency = 2, .clashEvery = 4, .thresholdFraction = 0.05};

TEST(StackedParts, AreAsManyAsAskedForOfClosedMeshesThatAllDiffer) {
  const ManyPartsScene scene = stackedParts("small", kSmall);
  EXPECT_EQ(scene.parts.size(), 14U);
  ASSERT_EQ(scene.meshes.size(), 5U);
  std::size_t triangles = 0;
  std::set<std::tuple<double, double, double>> firsts;
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    triangles += i % 5 % 2 == 0 ? 80U : 180U;
  EXPECT_EQ(scene.triangles(), triangles);
  for (const TriangleMesh& mesh : scene.meshes) {
    EXPECT_TRUE(mesh.topology().isClosed());
    EXPECT_TRUE(mesh.topology().isOriented());
    EXPECT_EQ(mesh.topology().components, 1U);
    const glm::dvec3& p = mesh.vertices()[0];
    firsts.emplace(p.x, p.y, p.z);
    // Not convex: a triangle has a vertex in front of its plane.
    bool isBehind = true;
    for (const Triangle& t : mesh.triangles()) {
      const glm::dvec3 &a = mesh.vertices()[t[0]], &b = mesh.vertices()[t[1]], &c = mesh.vertices()[t[2]];
      const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
      for (const glm::dvec3& v : mesh.vertices())
        isBehind = isBehind && glm::dot(v - a, normal) < 1e-6;
    }
    EXPECT_FALSE(isBehind);
  }
  EXPECT_EQ(firsts.size(), 5U);
}

TEST(StackedParts, AreTheSameEachTime) {
  const ManyPartsScene one = stackedParts("small", kSmall), again = stackedParts("small", kSmall);
  ASSERT_EQ(one.parts.size(), again.parts.size());
  for (std::size_t i = 0; i < one.parts.size(); ++i) {
    EXPECT_EQ(one.parts[i].worldFromPart.translation, again.parts[i].worldFromPart.translation);
    EXPECT_EQ(one.parts[i].worldFromPart.rotation, again.parts[i].worldFromPart.rotation);
  }
  ManyPartsSize other = kSmall;
  other.seed = 2;
  EXPECT_NE(stackedParts("small", other).parts[1].worldFromPart.rotation,
            one.parts[1].worldFromPart.rotation);
}

TEST(StackedParts, OnlyThoseMovedIntoTheOneBeforeMeetAndAllOfThemDo) {
  const ManyPartsScene scene = stackedParts("small", kSmall);
  ASSERT_EQ(scene.meantClashes.size(), 2U);
  std::set<std::uint32_t> moved;
  for (const auto& [before, part] : scene.meantClashes)
    moved.insert(part);
  const auto doMeet = [&](std::size_t i, std::size_t k) {
    const RigidTransform pose = scene.parts[i].worldFromPart.inverse() * scene.parts[k].worldFromPart;
    return test::doSurfacesMeetExactly(scene.meshOf(i), scene.meshOf(k), pose);
  };
  for (const auto& [before, part] : scene.meantClashes)
    EXPECT_TRUE(doMeet(before, part)) << before << " and " << part;
  for (std::uint32_t i = 0; i < scene.parts.size(); ++i) {
    for (std::uint32_t k = i + 1; k < scene.parts.size(); ++k) {
      if (moved.contains(i) || moved.contains(k)) continue;
      EXPECT_FALSE(doMeet(i, k)) << i << " and " << k;
    }
  }
}

TEST(FittedParts, AreClosedBlocksAndPegsOfWhichNoneMeetThoughEachPegIsNearItsHole) {
  const ManyPartsScene scene = fittedParts("small", {.pegs = 6, .fineness = 1, .thresholdFraction = 0.01});
  ASSERT_EQ(scene.parts.size(), 12U);
  EXPECT_EQ(scene.triangles(), 6U * (32U + 16U) * 4U);
  for (const TriangleMesh& mesh : scene.meshes) {
    EXPECT_TRUE(mesh.topology().isClosed());
    EXPECT_TRUE(mesh.topology().isOriented());
  }
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    for (std::size_t k = i + 1; k < scene.parts.size(); ++k) {
      const RigidTransform pose = scene.parts[i].worldFromPart.inverse() * scene.parts[k].worldFromPart;
      EXPECT_FALSE(test::doSurfacesMeetExactly(scene.meshOf(i), scene.meshOf(k), pose)) << i << " and " << k;
      if (i % 2 != 0 || k != i + 1) continue;
      const double gap = test::leastDistanceExactly(scene.meshOf(i), scene.meshOf(k), pose);
      EXPECT_LE(gap, scene.threshold) << "peg " << k;
      EXPECT_GT(gap, 0.0);
      // The peg is in the hole, not beside the block.
      EXPECT_LT(glm::length(pose.translation), 0.02);
    }
  }
}

TEST(ManyPartsOf, TakesVisiblePartsAndEachGeometryOnce) {
  const PartGeometryPtr box = test::freshGeometryOf(test::boxMesh({1, 1, 1})),
                        ball = test::freshGeometryOf(test::icosphereMesh(1.0, 1));
  Scene scene;
  scene.add(test::partOf(box, "a"));
  scene.add(test::partOf(ball, "b", {{1, 0, 0, 0}, {3, 0, 0}}));
  scene.add(test::partOf(box, "c", {{1, 0, 0, 0}, {0, 4, 0}}));
  Part hidden = test::partOf(test::freshGeometryOf(test::tetrahedronMesh(1.0)), "hidden");
  hidden.isVisible = false;
  scene.add(hidden);
  const ManyPartsScene many = manyPartsOf("some", scene, 0.1);
  EXPECT_EQ(many.meshes.size(), 2U);
  ASSERT_EQ(many.parts.size(), 3U);
  EXPECT_EQ(many.parts[0].mesh, many.parts[2].mesh);
  EXPECT_EQ(many.triangles(), 12U + 80U + 12U);
  EXPECT_DOUBLE_EQ(many.parts[2].worldFromPart.translation.y, 4.0);
  EXPECT_NEAR(many.threshold, 0.1 * many.diagonal, 1e-15);
}

}  // namespace
}  // namespace nearfit::bench::many_parts_test
