#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/math/tolerances.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/tracking/candidate_list.h"
#include "core/proximity/tracking/lmd_set.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/trial_share.h"

namespace nearfit::flat_region_test {
namespace {

constexpr double kCutoff = 0.2;

std::vector<Lmd> query(const TriangleMesh& scene, const TriangleMesh& part, const RigidTransform& pose) {
  return test::allLmds(NormalConeTree(scene), NormalConeTree(part), pose, kCutoff);
}

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  EXPECT_LT(glm::distance(a, b), tolerance) << fmt::format("({:.12g}, {:.12g}, {:.12g})", a.x, a.y, a.z);
}

/// A region of faces that is a rectangle with these half lengths.
void expectRectangle(const Lmd& lmd, double halfLength, double halfWidth, double tolerance) {
  EXPECT_TRUE(lmd.isRegion);
  EXPECT_EQ(lmd.extent.dimension, 2);
  EXPECT_NEAR(lmd.extent.measure, 4.0 * halfLength * halfWidth, tolerance);
  EXPECT_NEAR(lmd.extent.halfLength, halfLength, tolerance);
  EXPECT_NEAR(lmd.extent.halfWidth, halfWidth, tolerance);
  EXPECT_NEAR(glm::length(lmd.extent.axis), 1.0, 1e-12);
  EXPECT_NEAR(glm::dot(lmd.extent.axis, lmd.direction), 0.0, 1e-12);
}

const TriangleMesh kFloor = test::boxMesh({4, 4, 1}, {0, 0, -0.5});

TEST(FlatRegion, BoxOnAPlateIsOneRegionWithTheExtentOfItsBottom) {
  const auto found = query(kFloor, test::boxMesh({1, 0.5, 0.25}, {0, 0, 0.125}), at({0.3, 0.2, 0.1}));
  ASSERT_EQ(found.size(), 1U);
  expectRectangle(found[0], 0.5, 0.25, 1e-12);
  EXPECT_NEAR(std::abs(found[0].extent.axis.x), 1.0, 1e-12);
  EXPECT_EQ(found[0].extent.inside, glm::dvec2(0.0));
}

TEST(FlatRegion, TiltWithinTheToleranceLeavesOneRegionInItsPlace) {
  const TriangleMesh box = test::boxMesh({1, 0.5, 0.25}, {0, 0, 0.125});
  for (const double tilt : {0.0, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 0.9e-6}) {
    for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(1, 1, 0),
                                   glm::dvec3(1, -2, 0), glm::dvec3(-3, -1, 0)}) {
      SCOPED_TRACE(fmt::format("{} about ({}, {})", tilt, axis.x, axis.y));
      const glm::dvec3 n = glm::normalize(axis);
      const RigidTransform pose{glm::angleAxis(tilt, n), {0.3, 0.2, 0.1}};
      for (const bool isSwapped : {false, true}) {
        const auto found = isSwapped ? query(box, kFloor, pose.inverse()) : query(kFloor, box, pose);
        ASSERT_EQ(found.size(), 1U);
        // What a tilt moves: feet by the tilt times the gap, areas by its square.
        expectRectangle(found[0], 0.5, 0.25, 1e-9 + 10.0 * tilt * 0.1);
        if (!isSwapped) {
          expectNear(found[0].scenePoint, {0.3, 0.2, 0.0}, 1e-9 + 10.0 * tilt * 0.1);
          expectNear(found[0].partPoint, {0.3, 0.2, 0.1}, 1e-9 + 10.0 * tilt * 0.1);
        }
        // The lowest corner is that far down.
        const double reach = 0.5 * std::abs(n.y) + 0.25 * std::abs(n.x);
        EXPECT_NEAR(found[0].distance, 0.1 - tilt * reach, 1e-12);
      }
    }
  }
}

TEST(FlatRegion, TiltBeyondTheToleranceIsTheExactCorner) {
  const TriangleMesh box = test::boxMesh({1, 0.5, 0.25}, {0, 0, 0.125});
  for (const double tilt : {2e-6, 1e-5, 1e-3}) {
    const RigidTransform pose{glm::angleAxis(tilt, glm::normalize(glm::dvec3(1, 1, 0))), {0.3, 0.2, 0.1}};
    const auto found = query(kFloor, box, pose);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_FALSE(found[0].isRegion);
    EXPECT_EQ(found[0].extent.dimension, 0);
    // About (1, 1, 0) the corner at +x, -y goes down.
    const glm::dvec3 corner = pose.applyToPoint({0.5, -0.25, 0.0});
    expectNear(found[0].partPoint, corner, 1e-12);
    EXPECT_NEAR(found[0].distance, corner.z, 1e-12);
  }
}

TEST(FlatRegion, TiltAboutAnEdgeBeyondTheToleranceIsThatEdge) {
  const TriangleMesh box = test::boxMesh({1, 0.5, 0.25}, {0, 0, 0.125});
  const RigidTransform pose{glm::angleAxis(1e-4, glm::dvec3(0, 1, 0)), {0.3, 0.2, 0.1}};
  const auto found = query(kFloor, box, pose);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].extent.dimension, 1);
  EXPECT_NEAR(found[0].extent.measure, 0.5, 1e-12);
  EXPECT_NEAR(found[0].extent.halfLength, 0.25, 1e-12);
  EXPECT_NEAR(found[0].extent.halfWidth, 0.0, 1e-7);
  EXPECT_NEAR(std::abs(found[0].extent.axis.y), 1.0, 1e-12);
  expectNear(found[0].partPoint, pose.applyToPoint({0.5, 0.0, 0.0}), 1e-12);
}

TEST(FlatRegion, EdgeOverAFaceStaysOneRegionWithinTheTolerance) {
  // A box a twelfth of a turn off square, on an edge along y that is tilted about x, over a plate's rim.
  const TriangleMesh box = test::boxMesh({1, 1, 1});
  const double angle = std::numbers::pi / 6.0;
  for (const double tilt : {0.0, 1e-12, 1e-9, 1e-8, 1e-7, -0.9e-6}) {
    const RigidTransform pose{
        glm::angleAxis(tilt, glm::dvec3(1, 0, 0)) * glm::angleAxis(angle, glm::dvec3(0, 1, 0)),
        {0.3, 1.8, 0.75}};
    const auto found = query(kFloor, box, pose);
    ASSERT_EQ(found.size(), 1U) << tilt;
    EXPECT_TRUE(found[0].isRegion);
    EXPECT_EQ(found[0].extent.dimension, 1);
    // From y = 1.3 to the rim at 2.
    EXPECT_NEAR(found[0].extent.measure, 0.7, 1e-9 + std::abs(tilt));
    EXPECT_NEAR(found[0].scenePoint.y, 1.65, 1e-9 + std::abs(tilt));
    const double height = 0.75 - 0.5 * std::sin(angle) - 0.5 * std::cos(angle);
    EXPECT_NEAR(glm::distance(found[0].scenePoint, found[0].partPoint), height, 1e-9 + std::abs(tilt));
    EXPECT_NEAR(found[0].distance, height - (tilt < 0.0 ? 0.2 : 0.5) * std::abs(tilt), 1e-9);
  }
}

TEST(FlatRegion, ParallelEdgesStayOneRegionWithinTheTolerance) {
  const double quarter = std::numbers::pi / 4.0;
  const TriangleMesh box = test::boxMesh({1, 1, 1});
  const RigidTransform onEdge{glm::angleAxis(quarter, glm::dvec3(0, 1, 0)), {}};
  const TriangleMesh ridge = test::transformed(box, 1.0, onEdge);
  for (const glm::dvec3& axis : {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0.6, 0, 0.8)}) {
    for (const double tilt : {0.0, 1e-12, 1e-9, 1e-8, 1e-7, 0.9e-6}) {
      const RigidTransform pose{glm::angleAxis(tilt, axis),
                                {0.0, -0.4, 2.0 * std::numbers::sqrt2 / 2.0 + 0.05}};
      const auto found = query(ridge, ridge, pose);
      ASSERT_EQ(found.size(), 1U) << tilt;
      EXPECT_EQ(found[0].extent.dimension, 1);
      EXPECT_NEAR(found[0].extent.measure, 0.6, 1e-9 + 2.0 * tilt);
      EXPECT_NEAR(found[0].extent.halfLength, 0.3, 1e-9 + 2.0 * tilt);
      expectNear(found[0].scenePoint, {0, -0.2, std::numbers::sqrt2 / 2.0}, 1e-9 + 2.0 * tilt);
      EXPECT_NEAR(found[0].distance, 0.05, 1e-9 + tilt);
    }
  }
}

TEST(FlatRegion, EdgesParallelToTheToleranceAreTheRegionThoughFacesOverlapAtOneEnd) {
  // Two boxes diagonally above each other, edge over edge. Turned about the direction between the edges, their
  // faces overlap in a triangle at one end, less than a micrometre wide. The shift narrows it.
  const TriangleMesh left = test::boxMesh({1, 1, 1}, {-0.5, 0, -0.5}),
                     right = test::boxMesh({1, 1, 1}, {0.5, 0, 0.5});
  for (const double turn : {0.9e-6, -0.9e-6}) {
    for (const double shift : {0.0, 1e-9, 1e-7, 3e-7, 0.44e-6}) {
      SCOPED_TRACE(fmt::format("{}, {}", turn, shift));
      const RigidTransform pose{glm::angleAxis(turn, glm::dvec3(0, 0, 1)), {shift, 0.0, 0.1}};
      for (const bool isSwapped : {false, true}) {
        const auto found = isSwapped ? query(right, left, pose.inverse()) : query(left, right, pose);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_TRUE(found[0].isRegion);
        EXPECT_EQ(found[0].extent.dimension, 1);
        // Up to 0.5e-6 of each box's adjacent edge also lies over the other box.
        EXPECT_NEAR(found[0].extent.measure, 1.0, 4e-6);
        EXPECT_NEAR(found[0].extent.halfLength, 0.5, 4e-6);
        EXPECT_NEAR(found[0].distance, 0.1, 1e-11);
        const glm::dvec3 middle = isSwapped ? pose.applyToPoint(found[0].partPoint) : found[0].scenePoint;
        expectNear(middle, {0, 0, 0}, 4e-6);
      }
    }
  }
}

TEST(FlatRegion, StripAsLongAsTheEdgesBesideItIsARegionOfFaces) {
  const TriangleMesh left = test::boxMesh({1, 1, 1}, {-0.5, 0, -0.5}),
                     right = test::boxMesh({1, 1, 1}, {0.5, 0, 0.5});
  for (const double width : {1e-3, 1e-5, 1e-6, 1e-7}) {
    const auto found = query(left, right, at({-width, 0.0, 0.1}));
    ASSERT_EQ(found.size(), 1U) << width;
    EXPECT_EQ(found[0].extent.dimension, 2);
    EXPECT_NEAR(found[0].extent.measure, width, 1e-12);
    EXPECT_NEAR(found[0].extent.halfLength, 0.5, 1e-6);
    expectNear(found[0].scenePoint, {-0.5 * width, 0, 0}, 1e-9);
  }
}

TEST(FlatRegion, CentroidAndExtentDoNotDependOnTheMesh) {
  for (const std::uint32_t divisions : {1U, 2U, 8U}) {  // 2, 8 and 128 triangles a side.
    for (const std::uint32_t others : {1U, 3U, 8U}) {
      const TriangleMesh plate = test::squareMesh(2.0, divisions);
      const TriangleMesh foot = test::turned(test::squareMesh(1.0, others));
      const RigidTransform pose{glm::angleAxis(0.3, glm::dvec3(0, 0, 1)), {0.2, 0.1, 0.1}};
      const auto found = query(plate, foot, pose);
      ASSERT_EQ(found.size(), 1U);
      EXPECT_NEAR(found[0].extent.measure, 1.0, 1e-10);
      EXPECT_NEAR(found[0].extent.halfLength, 0.5, 1e-10);
      EXPECT_NEAR(found[0].extent.halfWidth, 0.5, 1e-10);
      expectNear(found[0].scenePoint, {0.2, 0.1, 0.0}, 1e-10);
    }
  }
}

TEST(FlatRegion, OverlapInAnLHasItsCentroidAndAPointInside) {
  // Feet on x from 0 to 1 and y from 0 to 0.1, and on x from 0 to 0.1 and y from 0.1 to 1: 0.1 and 0.09.
  const TriangleMesh part = test::joined(test::boxMesh({1, 0.1, 0.1}, {0.5, 0.05, 0.05}),
                                         test::boxMesh({0.1, 0.9, 0.1}, {0.05, 0.55, 0.05}));
  const auto found = query(kFloor, part, at({0, 0, 0.1}));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].extent.measure, 0.19, 1e-12);
  const glm::dvec3 centroid((0.1 * 0.5 + 0.09 * 0.05) / 0.19, (0.1 * 0.05 + 0.09 * 0.55) / 0.19, 0.0);
  expectNear(found[0].scenePoint, centroid, 1e-9);  // Outside.
  const glm::dvec3 inside = scenePointInside(found[0]);
  EXPECT_NEAR(inside.z, 0.0, 1e-12);
  EXPECT_TRUE((inside.y > 0.0 && inside.y < 0.1) || (inside.x > 0.0 && inside.x < 0.1));
  EXPECT_TRUE(inside.x > 0.0 && inside.y > 0.0 && inside.x < 1.0 && inside.y < 1.0);
}

TEST(FlatRegion, RingHasItsCentroidInItsMiddleAndAPointInside) {
  constexpr std::uint32_t kSides = 48;
  const TriangleMesh ring = test::tubeMesh(0.3, 0.5, 0.4, kSides);
  const auto found = query(kFloor, ring, at({0.4, 0.1, 0.3}));
  ASSERT_EQ(found.size(), 1U);
  // A regular polygon has the area s r^2 sin(a) cos(a), a half its angle, times its number of sides.
  const double a = std::numbers::pi / kSides, ringArea = kSides * std::sin(a) * std::cos(a) * (0.25 - 0.09);
  EXPECT_NEAR(found[0].extent.measure, ringArea, 1e-12);
  expectNear(found[0].scenePoint, {0.4, 0.1, 0.0}, 1e-9);
  EXPECT_NEAR(found[0].extent.halfLength, found[0].extent.halfWidth, 1e-7);
  const double r = glm::distance(scenePointInside(found[0]), found[0].scenePoint);
  EXPECT_TRUE(r > 0.29 && r < 0.5) << r;
}

TEST(FlatRegion, RingAroundABossIsNotBlockedByIt) {
  const TriangleMesh floor = test::joined(kFloor, test::boxMesh({0.2, 0.2, 1.0}, {0.4, 0.1, 0.4}));
  const NormalConeTree scene(floor), part(test::tubeMesh(0.3, 0.5, 0.4, 16));
  const LmdSet set = LmdCollector(1000).collect(scene, part, at({0.4, 0.1, 0.3}), 0.11);
  const auto ring = std::find_if(set.lmds.begin(), set.lmds.end(),
                                 [](const Lmd& lmd) { return std::abs(lmd.distance - 0.1) < 1e-12; });
  ASSERT_NE(ring, set.lmds.end());
  EXPECT_FALSE(ring->isBlocked);
}

TEST(FlatRegion, WhatCoplanarFacesCoverTwiceCountsOnce) {
  // Plates that overlap in x from 0 to 0.5, and one that doubles the first.
  const auto plate = [](double from, double to) {
    return test::boxMesh({to - from, 1, 0.1}, {0.5 * (from + to), 0, -0.05});
  };
  const TriangleMesh foot = test::boxMesh({4, 0.5, 0.1}, {0, 0, 0.05});
  const TriangleMesh two = test::joined(plate(-1.0, 0.5), plate(0.0, 2.0));
  for (const TriangleMesh& scene :
       {two, test::joined(two, plate(-1.0, 0.5)), test::joined(plate(-1.0, 2.0), two)}) {
    const auto found = query(scene, foot, at({0, 0, 0.1}));
    ASSERT_EQ(found.size(), 1U);
    expectRectangle(found[0], 1.5, 0.25, 1e-10);
    expectNear(found[0].scenePoint, {0.5, 0, 0}, 1e-10);
  }
}

TEST(FlatRegion, EdgeAlongTheSeamOfTwoFacesCountsOnce) {
  // The lowest edge lies over the flat edges in the middle of the plate.
  const RigidTransform pose{glm::angleAxis(std::numbers::pi / 4.0, glm::dvec3(0, 1, 0)),
                            {0.0, 0.0, std::numbers::sqrt2 / 4.0 + 0.1}};
  const TriangleMesh bar = test::boxMesh({0.5, 1.5, 0.5});
  for (const std::uint32_t divisions : {2U, 4U, 6U}) {
    const auto found = query(test::squareMesh(4.0, divisions), bar, pose);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].extent.dimension, 1);
    EXPECT_NEAR(found[0].extent.measure, 1.5, 1e-9);
    EXPECT_NEAR(found[0].extent.halfLength, 0.75, 1e-9);
    expectNear(found[0].scenePoint, {0, 0, 0}, 1e-9);
  }
}

TEST(FlatRegion, CentroidMovesByHalfTheStepWhileOneFaceSlidesOffTheOther) {
  const NormalConeTree scene(test::squareMesh(2.0, 7)), part(test::turned(test::squareMesh(1.0, 5)));
  // They overlap in x from half a unit before the sliding one's middle to 1.
  constexpr double kStep = 1e-3;
  for (int i = 0; i < 880; ++i) {
    const double x = 0.61 + kStep * i;
    const auto found = test::allLmds(scene, part, at({x, 0.05, 0.1}), kCutoff);
    ASSERT_EQ(found.size(), 1U) << x;
    const double width = 1.0 - (x - 0.5);
    ASSERT_NEAR(found[0].scenePoint.x, std::min(x, 1.0 - 0.5 * width), 1e-10);
    ASSERT_NEAR(found[0].extent.measure, width, 1e-10);
  }
}

TEST(FlatRegion, FacesOfASinglePrecisionMeshThatAreOnePlaneButForRoundingAreOneRegion) {
  // A fine plate, tilted and away from the origin, as a file in single precision has it.
  RigidTransform tilted{glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3))), {0.3, -0.2, 0.5}};
  const TriangleMesh exact = test::squareMesh(2.0, 6);
  std::vector<glm::dvec3> rounded;
  for (const glm::dvec3& p : exact.vertices())
    rounded.push_back(test::inSinglePrecision(tilted.applyToPoint(p)));
  const TriangleMesh plate(rounded,
                           std::vector<Triangle>(exact.triangles().begin(), exact.triangles().end()));
  const TriangleMesh foot = test::boxMesh({1, 0.5, 0.25}, {0, 0, 0.125});
  const auto found = query(plate, foot, tilted * at({0.13, 0.2, 0.1}));
  ASSERT_EQ(found.size(), 1U);
  expectRectangle(found[0], 0.5, 0.25, 1e-6);
  expectNear(found[0].scenePoint, tilted.applyToPoint({0.13, 0.2, 0.0}), 1e-6);
  EXPECT_NEAR(found[0].distance, 0.1, 1e-6);
}

TEST(FlatRegion, CandidateListHoldsTiltedRegionsToo) {
  const NormalConeTree scene(kFloor), part(test::boxMesh({1, 0.5, 0.25}, {0, 0, 0.125}));
  LmdScratch scratch;
  CandidateList list;
  std::vector<Lmd> out(64);
  const MotionBudget budget{1e-5, 1e-6};
  for (const double from : {0.0, 0.5e-6, 1.2e-6}) {
    for (const double to : {0.0, 1e-7, 0.9e-6}) {
      const auto pose = [](double tilt) {
        return RigidTransform{glm::angleAxis(tilt, glm::normalize(glm::dvec3(1, 1, 0))), {0.3, 0.2, 0.1}};
      };
      list.build({scene, part, pose(from), kCutoff}, {{}, budget}, scratch);
      const std::optional<LmdResult> listed = list.query(pose(to), kCutoff, scratch, out);
      if (!listed) continue;
      ASSERT_EQ(listed->count, 1U);
      EXPECT_TRUE(out[0].isRegion);
      const auto cold = test::allLmds(scene, part, pose(to), kCutoff);
      EXPECT_NEAR(out[0].extent.measure, cold[0].extent.measure, 1e-12);
      EXPECT_EQ(out[0].distance, cold[0].distance);
    }
  }
}

TEST(FlatRegion, StepsThatFaceStepsAtOneDistanceAreTwoRegions) {
  // The upper step of the scene under the upper step of the part, overlapping in plan with what is beside it.
  const TriangleMesh scene =
      test::joined(test::boxMesh({2, 1, 1}, {0, 0, -0.5}), test::boxMesh({1, 0.5, 0.5}, {0.5, 0, 0.25}));
  const TriangleMesh part =
      test::joined(test::boxMesh({2, 1, 1}, {0, 0, 1.1}), test::boxMesh({1.4, 0.5, 0.6}, {-0.3, 0, 0.4}));
  const auto found = query(scene, part, at({0, 0, 0}));
  const auto regions = std::count_if(found.begin(), found.end(),
                                     [](const Lmd& lmd) { return std::abs(lmd.distance - 0.1) < 1e-12; });
  EXPECT_EQ(regions, 2);
}

TEST(FlatRegion, PosesOfParallelFacesHaveTheBruteForceSet) {
  const std::vector<test::BodyPair> pairs{
      {"boxes", test::boxMesh({1, 0.7, 0.5}), test::boxMesh({0.4, 0.6, 0.3})},
      {"tube on box", test::boxMesh({1, 0.7, 0.5}), test::tubeMesh(0.2, 0.3, 0.4, 11)},
      {"overlapping boxes",
       test::joined(test::boxMesh({1, 0.3, 0.5}), test::boxMesh({0.3, 1, 0.5}, {0.1, 0.2, 0.0})),
       test::joined(test::boxMesh({0.5, 0.2, 0.1}), test::boxMesh({0.2, 0.5, 0.1}, {0.1, 0.0, 0.0}))},
      {"fine squares", test::squareMesh(1.0, 6), test::turned(test::squareMesh(0.7, 4))}};
  std::mt19937_64 random(11);
  test::LmdTally tally;
  for (const test::BodyPair& pair : pairs) {
    for (std::size_t i = 0; i < 160 / test::kTrialShare; ++i) {
      constexpr std::array<double, 5> kTilts{0.0, 1e-12, 1e-9, 1e-8, 1e-7};
      const RigidTransform pose = test::poseWithParallelFaces(pair, 0.1, kTilts[i % 5], random);
      test::compareAtPose(pair, pose, 0.15, tally);
    }
  }
  EXPECT_GT(tally.regions, tally.poses / 2);
  EXPECT_GT(tally.minima, 0U);
}

TEST(FlatRegion, InAnotherFrameItsAxesTurnAlong) {
  const auto found = query(kFloor, test::boxMesh({1, 0.5, 0.25}, {0, 0, 0.125}), at({0.3, 0.2, 0.1}));
  ASSERT_EQ(found.size(), 1U);
  const RigidTransform turn{glm::angleAxis(0.5 * std::numbers::pi, glm::dvec3(0, 0, 1)), {1, 2, 3}};
  const Lmd moved = transformed(found[0], turn);
  expectNear(moved.scenePoint, {1 - 0.2, 2 + 0.3, 3}, 1e-9);
  EXPECT_NEAR(std::abs(moved.extent.axis.y), 1.0, 1e-12);
  expectNear(moved.direction, {0, 0, 1}, 1e-12);
}

}  // namespace
}  // namespace nearfit::flat_region_test
