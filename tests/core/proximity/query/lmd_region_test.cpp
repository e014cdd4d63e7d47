#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/lmd_query.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::lmd_region_test {
namespace {

std::vector<Lmd> query(const TriangleMesh& scene, const TriangleMesh& part, const RigidTransform& pose,
                       double cutoff) {
  LmdScratch scratch;
  std::vector<Lmd> out(4096);
  const LmdResult result = findLmds(NormalConeTree(scene), NormalConeTree(part), pose, cutoff, scratch, out);
  EXPECT_EQ(result.status, QueryStatus::Complete);
  out.resize(result.count);
  return out;
}

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

RigidTransform turnedBy(double angle, const glm::dvec3& axis, const glm::dvec3& translation) {
  return {glm::angleAxis(angle, axis), translation};
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-9) {
  EXPECT_LT(glm::distance(a, b), tolerance)
      << a.x << ' ' << a.y << ' ' << a.z << " is not " << b.x << ' ' << b.y << ' ' << b.z;
}

TEST(LmdRegion, BoxAboveBoxIsOneRegionAtTheCentroidOfTheOverlap) {
  const auto found = query(test::boxMesh({2, 2, 2}), test::boxMesh({2, 2, 2}), at({0.5, 0.25, 2.1}), 0.5);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].isRegion);
  EXPECT_EQ(found[0].sceneFeature, FeatureKind::Face);
  EXPECT_EQ(found[0].partFeature, FeatureKind::Face);
  EXPECT_NEAR(found[0].distance, 0.1, 1e-12);
  expectNear(found[0].scenePoint, {0.25, 0.125, 1.0});
  expectNear(found[0].partPoint, {0.25, 0.125, 1.1});
  expectNear(found[0].direction, {0, 0, 1});
}

TEST(LmdRegion, StaysOneRegionWhenBothFacesAreFinelyMeshed) {
  const auto found =
      query(test::squareMesh(2.0, 12), test::turned(test::squareMesh(1.0, 7)), at({0.3, 0.2, 0.1}), 0.2);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].isRegion);
  expectNear(found[0].scenePoint, {0.3, 0.2, 0.0});
}

TEST(LmdRegion, TwoFeetOnOneFloorAreTwoRegions) {
  const TriangleMesh feet =
      test::joined(test::boxMesh({0.2, 0.2, 0.2}, {-1, 0, 0.1}), test::boxMesh({0.2, 0.2, 0.2}, {1, 0, 0.1}));
  const auto found = query(test::boxMesh({4, 4, 1}, {0, 0, -0.5}), feet, at({0, 0, 0.05}), 0.1);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_TRUE(found[0].isRegion && found[1].isRegion);
  expectNear(found[0].scenePoint + found[1].scenePoint, {0, 0, 0});
  EXPECT_NEAR(std::abs(found[0].scenePoint.x), 1.0, 1e-9);
}

TEST(LmdRegion, EdgeLyingOverAFaceIsOneRegionAtItsMiddle) {
  // A box balanced on one of its edges, a twelfth of a turn off square, over a floor wider than the edge.
  const double angle = std::acos(-1.0) / 6;
  const auto found = query(test::boxMesh({4, 4, 1}, {0, 0, -0.5}), test::boxMesh({1, 1, 1}),
                           turnedBy(angle, {0, 1, 0}, {0.3, 0.2, 0.8}), 0.3);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].isRegion);
  EXPECT_EQ(found[0].partFeature, FeatureKind::Edge);
  EXPECT_EQ(found[0].sceneFeature, FeatureKind::Face);
  // The lowest edge has local x = 0.5, z = -0.5: it comes to x cos + z sin, -x sin + z cos.
  const double x = 0.3 + 0.5 * std::cos(angle) - 0.5 * std::sin(angle);
  const double z = 0.8 - 0.5 * std::sin(angle) - 0.5 * std::cos(angle);
  EXPECT_NEAR(found[0].distance, z, 1e-12);
  expectNear(found[0].partPoint, {x, 0.2, z});
}

TEST(LmdRegion, ParallelEdgesAreOneRegionAtTheMiddleOfTheirOverlap) {
  // Two boxes, both on edge, edge over edge along y, overlapping in y from -0.5 to 0.5 - 0.4.
  const double quarter = std::acos(-1.0) / 4;
  const TriangleMesh box = test::boxMesh({1, 1, 1});
  const RigidTransform tilt = turnedBy(quarter, {0, 1, 0}, {0, 0, 0});
  const auto found = query(test::transformed(box, 1.0, tilt), test::transformed(box, 1.0, tilt),
                           at({0.0, -0.4, 2 * std::sqrt(0.5) + 0.05}), 0.1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].isRegion);
  EXPECT_EQ(found[0].sceneFeature, FeatureKind::Edge);
  EXPECT_EQ(found[0].partFeature, FeatureKind::Edge);
  EXPECT_NEAR(found[0].distance, 0.05, 1e-9);
  expectNear(found[0].scenePoint, {0, -0.2, std::sqrt(0.5)});
}

TEST(LmdRegion, TiltOfAMilliradianMakesItACorner) {
  const auto found = query(test::boxMesh({4, 4, 1}, {0, 0, -0.5}), test::boxMesh({1, 1, 1}, {0, 0, 0.5}),
                           turnedBy(1e-3, glm::normalize(glm::dvec3(1, 2, 0)), {0, 0, 0.1}), 0.2);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FALSE(found[0].isRegion);
  EXPECT_EQ(found[0].partFeature, FeatureKind::Vertex);
  EXPECT_EQ(found[0].sceneFeature, FeatureKind::Face);
}

TEST(LmdRegion, CornerOverTheDiagonalOfASquareFaceIsFoundOnce) {
  // A pyramid's tip exactly over the flat edge that splits the floor's square, which is no feature.
  const TriangleMesh tip = test::turned(
      test::transformed(test::coneMesh(1.0, 1.0, 7), 1.0, turnedBy(std::acos(-1.0), {1, 0, 0}, {0, 0, 0})));
  const TriangleMesh down = test::turned(tip);
  for (const glm::dvec3& over : {glm::dvec3(0, 0, 0), glm::dvec3(0.25, 0.25, 0), glm::dvec3(-0.5, -0.5, 0),
                                 glm::dvec3(0.25, -0.25, 0), glm::dvec3(0.5, 0.125, 0)}) {
    const auto found = query(test::squareMesh(2.0, 4), down, at(over + glm::dvec3(0, 0, 1.1)), 0.2);
    ASSERT_EQ(found.size(), 1U) << over.x << ' ' << over.y;
    EXPECT_FALSE(found[0].isRegion);
    expectNear(found[0].scenePoint, over);
    expectNear(found[0].partPoint, over + glm::dvec3(0, 0, 0.1));
    EXPECT_EQ(found[0].sceneFeature, FeatureKind::Face);
    EXPECT_EQ(found[0].partFeature, FeatureKind::Vertex);
  }
}

TEST(LmdRegion, BoxInABoxWithParallelWallsHasOneRegionAWall) {
  const TriangleMesh cavity = test::turned(test::boxMesh({2, 2, 2}));
  const auto found = query(cavity, test::boxMesh({1.6, 1.7, 1.8}), at({0, 0, 0}), 0.3);
  ASSERT_EQ(found.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_TRUE(found[i].isRegion);
    EXPECT_NEAR(found[i].distance, i < 2 ? 0.1 : i < 4 ? 0.15 : 0.2, 1e-12);
  }
}

TEST(LmdQuery, SphereOverAPlaneHasItsLowestVertexOnly) {
  // The icosphere's own vertex points down after this turn: the answer is that of a true sphere.
  const TriangleMesh ball = test::icosphereMesh(1.0, 3);
  const glm::dvec3 lowest = glm::normalize(ball.vertices()[0]);
  const glm::dvec3 down(0, 0, -1);
  const RigidTransform pose{glm::dquat(lowest, down), {0.11, 0.07, 1.05}};
  const auto found = query(test::squareMesh(4.0, 3), ball, pose, 0.1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].distance, 0.05, 1e-12);
  expectNear(found[0].scenePoint, {0.11, 0.07, 0.0});
}

TEST(LmdQuery, CrossedEdgesHaveOneMinimumBetweenTheirMiddles) {
  const double quarter = std::acos(-1.0) / 4;
  const TriangleMesh box = test::boxMesh({1, 1, 1});
  const RigidTransform along = turnedBy(quarter, {0, 1, 0}, {0, 0, 0}),
                       across = turnedBy(quarter, {1, 0, 0}, {0, 0, 0});
  const auto found = query(test::transformed(box, 1.0, along), test::transformed(box, 1.0, across),
                           at({0.1, 0.2, 2 * std::sqrt(0.5) + 0.05}), 0.1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FALSE(found[0].isRegion);
  EXPECT_EQ(found[0].sceneFeature, FeatureKind::Edge);
  EXPECT_EQ(found[0].partFeature, FeatureKind::Edge);
  expectNear(found[0].scenePoint, {0.0, 0.2, std::sqrt(0.5)});
}

TEST(LmdQuery, FindsTheSetAlsoWhereTheBodiesInterpenetrateElsewhere) {
  // A bar through a plate; its end over a second plate is a region all the same.
  const TriangleMesh plates =
      test::joined(test::boxMesh({2, 2, 0.1}, {0, 0, 0}), test::boxMesh({2, 2, 0.1}, {0, 0, 1}));
  const auto found = query(plates, test::boxMesh({0.2, 0.2, 1.8}), at({0, 0, 0.0}), 0.2);
  const bool end = std::any_of(found.begin(), found.end(), [](const Lmd& l) {
    return l.isRegion && std::abs(l.distance - 0.05) < 1e-12 && std::abs(l.partPoint.z - 0.9) < 1e-12;
  });
  EXPECT_TRUE(end);
}

TEST(LmdQuery, StorageThatIsTooSmallKeepsTheNearestAndSaysTruncated) {
  const TriangleMesh a = test::starMesh(1, 1.0, 3, 0.3), b = test::starMesh(2, 1.0, 3, 0.3);
  const NormalConeTree ta(a), tb(b);
  LmdScratch scratch;
  std::vector<Lmd> all(4096), few(5);
  const RigidTransform pose = at({1.2, 0.3, 0.1});
  const LmdResult whole = findLmds(ta, tb, pose, 0.5, scratch, all);
  ASSERT_EQ(whole.status, QueryStatus::Complete);
  ASSERT_GT(whole.count, 10U);
  const LmdResult part = findLmds(ta, tb, pose, 0.5, scratch, few);
  EXPECT_EQ(part.status, QueryStatus::Truncated);
  ASSERT_EQ(part.count, few.size());
  for (std::size_t i = 0; i < few.size(); ++i)
    EXPECT_EQ(few[i].distance, all[i].distance);

  LmdScratch tiny(5);
  const LmdResult heaped = findLmds(ta, tb, pose, 0.5, tiny, all);
  EXPECT_EQ(heaped.status, QueryStatus::Truncated);
  ASSERT_EQ(heaped.count, 5U);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_EQ(few[i].distance, all[i].distance);
}

TEST(LmdQuery, SenselessArgumentsGiveAnEmptySet) {
  const NormalConeTree box(test::boxMesh({1, 1, 1})), nothing{TriangleMesh()};
  LmdScratch scratch;
  std::vector<Lmd> out(16);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double cutoff : {0.0, -1.0, nan, inf}) {
    EXPECT_EQ(findLmds(box, box, at({1.5, 0, 0}), cutoff, scratch, out).count, 0U);
  }
  EXPECT_EQ(findLmds(box, nothing, at({1.5, 0, 0}), 1.0, scratch, out).count, 0U);
  EXPECT_EQ(findLmds(nothing, box, at({1.5, 0, 0}), 1.0, scratch, out).count, 0U);
  EXPECT_EQ(findLmds(box, box, at({nan, 0, 0}), 1.0, scratch, out).count, 0U);
  EXPECT_EQ(findLmds(box, box, {{inf, 0, 0, 0}, {}}, 1.0, scratch, out).count, 0U);
  EXPECT_EQ(findLmds(box, box, at({1.5, 0, 0}), 1.0, scratch, out).count, 1U);
}

TEST(LmdQuery, QuaternionAMillionthOffUnitIsTakenAsItsRotation) {
  const NormalConeTree a(test::starMesh(1, 1.0, 3, 0.3)), b(test::starMesh(2, 1.0, 3, 0.3));
  LmdScratch scratch;
  std::vector<Lmd> exact(512), off(512);
  RigidTransform pose = turnedBy(0.7, glm::normalize(glm::dvec3(1, 2, 3)), {1.2, 0.3, 0.1});
  const std::size_t count = findLmds(a, b, pose, 0.5, scratch, exact).count;
  pose.rotation *= 1.000001;
  ASSERT_EQ(findLmds(a, b, pose, 0.5, scratch, off).count, count);
  ASSERT_GT(count, 0U);
  for (std::size_t i = 0; i < count; ++i)
    expectNear(exact[i].partPoint, off[i].partPoint, 1e-12);
}

}  // namespace
}  // namespace nearfit::lmd_region_test
