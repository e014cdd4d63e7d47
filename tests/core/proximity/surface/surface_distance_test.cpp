#include "core/proximity/surface/surface_distance.h"

#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/triangle_distance.h"
#include "tests/exact/exact_meeting.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/trial_share.h"

namespace nearfit::surface_distance_test {
namespace {

using test::BodyPair;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kAnyWork = std::numeric_limits<std::uint64_t>::max();

double uniform(std::mt19937_64& random) {
  return 2.0 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1.0;
}
glm::dvec3 randomPoint(std::mt19937_64& random) {
  return {uniform(random), uniform(random), uniform(random)};
}

void expectExact(const TriangleCorners& a, const TriangleCorners& b, double tolerance) {
  const ClosestPoints found = closestOfTriangles(a, b);
  EXPECT_NEAR(std::sqrt(found.distanceSquared), test::exactDistance(a, b), tolerance);
  EXPECT_NEAR(glm::distance(found.a, found.b), std::sqrt(found.distanceSquared), tolerance);
}

TEST(TriangleDistance, RandomTrianglesHaveTheExactDistance) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000 / static_cast<int>(test::kTrialShare); ++i) {
    const glm::dvec3 away = 2.0 * uniform(random) * randomPoint(random);
    expectExact({randomPoint(random), randomPoint(random), randomPoint(random)},
                {away + randomPoint(random), away + randomPoint(random), away + randomPoint(random)}, 1e-14);
  }
}

TEST(TriangleDistance, WhatIsSurelyBeyondIsBeyond) {
  std::mt19937_64 random(6);
  int beyond = 0, within = 0;
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 away = 2.0 * randomPoint(random);
    // Every other one a sliver.
    const double thin = i % 2 == 0 ? 1.0 : 1e-9;
    const TriangleCorners a{randomPoint(random), randomPoint(random), randomPoint(random)};
    const glm::dvec3 p = away + randomPoint(random), q = away + randomPoint(random);
    const TriangleCorners b{p, q, 0.5 * (p + q) + thin * randomPoint(random)};
    const double distance = test::exactDistance(a, b);
    EXPECT_FALSE(areSurelyBeyond(a, b, distance * (1.0 + 1e-12) + 1e-14));
    distance > 0.0 && areSurelyBeyond(a, b, 0.5 * distance) ? ++beyond : ++within;
    for (const bool isSecond : {false, true}) {
      bool at = isSecond, again = isSecond;
      const DirectedTriangle directedA{a, SeparatingDirections(a)}, directedB{b, SeparatingDirections(b)};
      const double gap = triangleGapLowerBound(directedA, directedB, 2.0 * distance, at);
      EXPECT_EQ(gap, triangleGapLowerBound(a, b, 2.0 * distance, again));
      EXPECT_EQ(at, again);
      EXPECT_LE(gap, distance * (1.0 + 1e-12) + 1e-14);
    }
  }
  EXPECT_GT(beyond, within);
}

TEST(TriangleDistance, SliversParallelSidesAndCommonCornersHaveTheExactDistance) {
  std::mt19937_64 random(2);
  for (const double thin : {1e-3, 1e-6, 1e-9, 1e-12}) {
    for (int i = 0; i < 300 / static_cast<int>(test::kTrialShare); ++i) {
      const glm::dvec3 along = randomPoint(random), from = randomPoint(random);
      const double share = 0.5 + 0.6 * uniform(random);
      const TriangleCorners a{from, from + along, from + share * along + thin * randomPoint(random)};
      const glm::dvec3 off = std::pow(10.0, -8.0 * std::abs(uniform(random))) * randomPoint(random);
      const TriangleCorners b{from + off, from + off + along + thin * randomPoint(random),
                              from + off + randomPoint(random)};
      expectExact(a, b, 1e-14);
      expectExact(b, a, 1e-14);
      // Two slivers beside each other.
      expectExact(a, {a[0] + off, a[1] + off, a[2] + off + thin * randomPoint(random)}, 1e-14);
    }
  }
}

TEST(TriangleDistance, CoplanarAndStackedTrianglesHaveTheDistanceByHand) {
  const TriangleCorners a{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
  const auto moved = [&](const glm::dvec3& by) { return TriangleCorners{a[0] + by, a[1] + by, a[2] + by}; };
  EXPECT_DOUBLE_EQ(std::sqrt(closestOfTriangles(a, moved({1, 1, 3})).distanceSquared), 3.0);
  EXPECT_DOUBLE_EQ(std::sqrt(closestOfTriangles(a, moved({5, 0, 0})).distanceSquared), 1.0);
  EXPECT_DOUBLE_EQ(std::sqrt(closestOfTriangles(a, moved({4, 4, 0})).distanceSquared), std::sqrt(8.0));
  EXPECT_EQ(closestOfTriangles(a, moved({1, 1, 0})).distanceSquared, 0.0);
  // Pierced in the middle, no side near another.
  const TriangleCorners spike{{{1, 1, -9}, {1, 1, 9}, {1, 90, 9}}};
  EXPECT_EQ(closestOfTriangles(a, spike).distanceSquared, 0.0);
}

SurfaceDistance leastAt(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& pose,
                        double within = kInfinity, std::uint64_t work = kAnyWork) {
  static LmdScratch scratch;
  return leastSurfaceDistance(scene, part, pose, within, scratch, work);
}

/// At random poses, apart and through each other, and with any bound of work.
void compareWithBruteForce(const BodyPair& pair, std::size_t poses, double reach, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const NormalConeTree scene(pair.scene), part(pair.part);
  const double size = scene.size() + part.size();
  for (std::size_t i = 0; i < poses / test::kTrialShare; ++i) {
    const RigidTransform pose = test::poseNearContact(pair, reach, random);
    const double expected = test::leastDistanceExactly(pair.scene, pair.part, pose);
    const SurfaceDistance found = leastAt(scene, part, pose);
    ASSERT_TRUE(found.isFound && found.isComplete) << pair.name;
    EXPECT_NEAR(found.distance, expected, 1e-13 * size) << pair.name;
    EXPECT_LE(found.lowerBound, expected);
    EXPECT_GE(found.lowerBound, expected - 2e-12 * size);
    EXPECT_NEAR(glm::distance(found.scenePoint, found.partPoint), expected, 1e-13 * size);
    for (const std::uint64_t work : {0, 1, 10, 50, 300}) {
      const SurfaceDistance early = leastAt(scene, part, pose, kInfinity, work);
      EXPECT_LE(early.lowerBound, expected) << work;
      EXPECT_GE(early.distance, expected - 1e-13 * size);
    }
    const double near = 0.5 * expected + 1e-9 * size;
    const SurfaceDistance none = leastAt(scene, part, pose, near);
    EXPECT_EQ(none.isFound, expected <= near);
    if (!none.isFound) {
      EXPECT_NEAR(none.lowerBound, near, 2e-12 * size);
    }
  }
}

TEST(SurfaceDistance, RandomMeshesHaveTheBruteForceDistance) {
  compareWithBruteForce({"stars", test::starMesh(1, 1.0, 2, 0.4), test::starMesh(2, 0.3, 1, 0.4)}, 16, 0.5,
                        1);
  compareWithBruteForce({"soup", test::looseTriangles(3, 200), test::looseTriangles(4, 60)}, 16, 0.5, 2);
  compareWithBruteForce({"fans", test::jaggedFan(3, 40, 0.2), test::finsMesh(4, 9, 1.0)}, 16, 0.5, 3);
}

TEST(SurfaceDistance, DegenerateMeshesHaveTheBruteForceDistance) {
  for (const double aspect : {1e3, 1e6, 1e9}) {
    compareWithBruteForce({"slivers", test::withSlivers(test::icosphereMesh(1.0, 1), aspect, 0.1),
                           test::withNeedles(test::icosphereMesh(0.5, 0), aspect, 0.1)},
                          8, 0.5, 4);
  }
  compareWithBruteForce({"coplanar", test::coplanarFans(1, 6), test::squareMesh(3.0, 4)}, 8, 1.0, 5);
}

TEST(SurfaceDistance, SmallLargeAndFarBodiesHaveTheBruteForceDistance) {
  const TriangleMesh scene = test::starMesh(1, 1.0, 1, 0.4), part = test::starMesh(2, 0.3, 1, 0.4);
  for (const double scale : {1e-5, 1e4}) {
    const BodyPair pair{"scaled", test::transformed(scene, scale), test::transformed(part, scale)};
    compareWithBruteForce(pair, 8, 0.5 * scale, 6);
  }
  const RigidTransform away{{1, 0, 0, 0}, {1e4, -2e4, 1.5e4}};
  const TriangleMesh far = test::transformed(scene, 1.0, away);
  const NormalConeTree farTree(far), partTree(part);
  // Steps of double precision out there are 4e-12.
  for (const double x : {0.5, 1.5, 3.0}) {
    const RigidTransform pose = away * RigidTransform{{1, 0, 0, 0}, {x, 0.1, 0.2}};
    EXPECT_NEAR(leastAt(farTree, partTree, pose).distance, test::leastDistanceExactly(far, part, pose),
                2e-11);
  }
}

TEST(SurfaceDistance, SheetIsAsFarFromBehindAsFromTheFront) {
  const NormalConeTree sheet(test::squareMesh(1.0, 4)), box(test::boxMesh({0.2, 0.2, 0.2}));
  for (const double side : {-1.0, 1.0}) {
    const SurfaceDistance found = leastAt(sheet, box, {{1, 0, 0, 0}, {0.03, 0.05, side * 0.35}}, 1.0);
    EXPECT_NEAR(found.distance, 0.25, 1e-15);
    EXPECT_NEAR(found.partPoint.z, side * 0.25, 1e-15);
  }
}

TEST(SurfaceDistance, BadArgumentsGiveNoDistance) {
  const NormalConeTree box(test::boxMesh({1, 1, 1})), empty{TriangleMesh()};
  const SurfaceDistance none = leastAt(box, empty, {}, 2.0);
  EXPECT_FALSE(none.isFound);
  EXPECT_EQ(none.lowerBound, 2.0);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), kInfinity}) {
    const SurfaceDistance refused = leastAt(box, box, {{1, 0, 0, 0}, {bad, 0, 0}}, 2.0);
    EXPECT_FALSE(refused.isFound);
    EXPECT_EQ(refused.lowerBound, 0.0);
  }
  EXPECT_EQ(leastAt(box, box, {}, -1.0).lowerBound, 0.0);
  EXPECT_EQ(leastAt(box, box, {}, std::numeric_limits<double>::quiet_NaN()).lowerBound, 0.0);
}

TEST(SurfaceDistance, EachInstructionSetGivesTheSame) {
  const BodyPair pair{"stars", test::starMesh(1, 1.0, 3, 0.3), test::starMesh(2, 0.5, 3, 0.3)};
  const NormalConeTree scene(pair.scene), part(pair.part);
  std::mt19937_64 random(9);
  for (int i = 0; i < 20; ++i) {
    const RigidTransform pose = test::poseNearContact(pair, 0.3, random);
    const double expected = leastAt(scene, part, pose).distance;
    for (const SimdLevel level : availableSimdLevels()) {
      LmdScratch scratch(1, level);
      EXPECT_EQ(leastSurfaceDistance(scene, part, pose, 1.0, scratch, kAnyWork).distance, expected);
    }
  }
}

TEST(SurfaceDistance, AllocatesNothing) {
  const NormalConeTree scene(test::starMesh(1, 1.0, 3, 0.3)), part(test::starMesh(2, 1.0, 3, 0.3));
  LmdScratch scratch;
  test::resetAllocationCount();
  test::startCountingAllocations();
  for (const double x : {0.0, 1.0, 1.8, 3.0})
    leastSurfaceDistance(scene, part, {{1, 0, 0, 0}, {x, 0, 0}}, 1.0, scratch, kAnyWork);
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
}

}  // namespace
}  // namespace nearfit::surface_distance_test
