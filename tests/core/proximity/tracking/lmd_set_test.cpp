#include "core/proximity/tracking/lmd_set.h"

#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::lmd_set_test {
namespace {

/// `count` x `count` tetrahedra in the plane z = 0, 4 apart from another: each has one vertex highest.
TriangleMesh bedOfTetrahedra(int count) {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  for (int i = 0; i < count * count; ++i) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    const auto row = i / count, column = i % count;
    const glm::dvec3 foot{4.0 * column, 4.0 * row, 0.0};
    for (const glm::dvec3& v : {glm::dvec3{0, 0, 2}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}})
      vertices.push_back(foot + v);
    for (const Triangle& t : {Triangle{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}) {
      triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  return {std::move(vertices), std::move(triangles)};
}

TEST(LmdCollector, StorageGrowsUntilTheSetIsWhole) {
  // 20 x 20 tips under a plate that covers them all.
  constexpr int kCount = 20;
  const NormalConeTree bed(bedOfTetrahedra(kCount));
  const NormalConeTree plate(test::boxMesh({1000, 1000, 2}, {4.0 * kCount / 2, 4.0 * kCount / 2, 3.5}));
  LmdCollector collector(1'000'000, 10);
  const LmdSet set = collector.collect(bed, plate, {}, 1.0);
  EXPECT_TRUE(set.isComplete);
  ASSERT_EQ(set.lmds.size(), static_cast<std::size_t>(kCount) * kCount);
  for (const Lmd& lmd : set.lmds)
    ASSERT_NEAR(lmd.distance, 0.5, 1e-12);
  EXPECT_GT(set.queryTime, 0.0);
}

TEST(LmdCollector, BeyondItsLimitItSaysThatMoreIsThere) {
  const NormalConeTree bed(bedOfTetrahedra(10));
  // Tilted about y: the tips at x = 0 are nearest.
  const NormalConeTree plate(test::boxMesh({200, 200, 2}, {0, 0, 1}));
  const RigidTransform tilted{glm::angleAxis(-0.01, glm::dvec3(0, 1, 0)), {0, 0, 2.5}};
  LmdCollector collector(10);
  const LmdSet set = collector.collect(bed, plate, tilted, 2.0);
  EXPECT_FALSE(set.isComplete);
  ASSERT_EQ(set.lmds.size(), 10U);
  for (const Lmd& lmd : set.lmds)
    EXPECT_NEAR(lmd.scenePoint.x, 0.0, 1e-12);
}

TEST(LmdCollector, KindsHaveTheNamesOfTheReports) {
  EXPECT_STREQ(nameOf(FeatureKind::Vertex), "vertex");
  EXPECT_STREQ(nameOf(FeatureKind::Edge), "edge");
  EXPECT_STREQ(nameOf(FeatureKind::Face), "face");
}

}  // namespace
}  // namespace nearfit::lmd_set_test
