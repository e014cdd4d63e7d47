#include "core/report/clearance.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/exact/exact_meeting.h"
#include "tests/support/lmd_oracle.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/random_values.h"
#include "tests/support/trial_share.h"

namespace nearfit::clearance_test {
namespace {

/// Rough all over: their minima are isolated ones.
TriangleMesh rock(std::uint64_t seed) {
  return test::starMesh(seed, 0.5, 1, 0.4);
}

RigidTransform relativePose(const Part& other, const Part& part) {
  return (other.worldFromPart.inverse() * part.worldFromPart).normalized();
}

double distanceToSurface(const Part& part, const glm::dvec3& worldPoint) {
  // A point is a triangle so small that it makes no difference.
  const glm::dvec3 p = part.worldFromPart.inverse().applyToPoint(worldPoint);
  constexpr double kSmall = 1e-12;
  const TriangleMesh point({p, p + glm::dvec3(kSmall, 0, 0), p + glm::dvec3(0, kSmall, 0)}, {{0, 1, 2}});
  return test::leastDistanceExactly(part.geometry->mesh, point, {});
}

void expectAsBruteForce(const Scene& scene, const PartClearance& found, const Part& part, double cutoff) {
  const Part& other = *scene.find(found.other);
  const TriangleMesh &a = part.geometry->mesh, &b = other.geometry->mesh;
  const RigidTransform pose = relativePose(other, part);
  const bool doMeet = test::doSurfacesMeetExactly(b, a, pose);
  EXPECT_EQ(found.overlap == InterferenceKind::SurfacesMeet, doMeet);
  EXPECT_LT(distanceToSurface(part, found.partPoint), 1e-10);
  EXPECT_LT(distanceToSurface(other, found.otherPoint), 1e-10);
  if (doMeet) {
    EXPECT_EQ(found.distance, 0.0);
    return;
  }
  const double expected = test::leastDistanceExactly(b, a, pose);
  EXPECT_NEAR(found.distance, expected, 1e-12);
  EXPECT_NEAR(glm::distance(found.partPoint, found.otherPoint), expected, 1e-12);
  constexpr double kMargin = 1e-9;
  const auto minima = test::bruteForceMinima(test::OracleBody(b), test::OracleBody(a), pose, cutoff, kMargin);
  const auto certain = std::ranges::count_if(minima, [&](const auto& m) { return m.slack > kMargin; });
  EXPECT_GE(found.minima, static_cast<std::size_t>(certain));
  EXPECT_LE(found.minima, minima.size());
  EXPECT_TRUE(found.isEveryMinimum);
}

TEST(Clearance, DistancesPointsMinimaAndOverlapsAreThoseOfBruteForce) {
  constexpr double kCutoff = 0.4;
  test::RandomValues random(11);
  std::size_t meeting = 0, apart = 0;
  for (unsigned round = 0; round < 24 / test::kTrialShare; ++round) {
    Scene scene;
    const auto place = [&](const char* name, std::uint64_t seed, double reach) {
      RigidTransform pose = random.pose().normalized();
      pose.translation *= reach;
      return scene.add(test::partOf(test::geometryOf(rock(seed)), name, pose));
    };
    const PartId part = place("part", std::uint64_t{2} * round, 0.0);
    place("near", std::uint64_t{2} * round + 1, 2.2);
    place("far", 2 * round + 7, 6.0);
    const auto clearances = clearancesOf(scene, part, kCutoff);
    ASSERT_EQ(clearances.size(), 2U);
    for (const PartClearance& each : clearances) {
      expectAsBruteForce(scene, each, *scene.find(part), kCutoff);
      each.isOverlapping() ? ++meeting : ++apart;
    }
  }
  EXPECT_GT(meeting, 0U);
  EXPECT_GT(apart, meeting);
}

TEST(Clearance, APartInsideAnotherOverlapsItEitherWay) {
  Scene scene;
  const PartId shell = scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(2.0))), "shell"));
  const PartId core = scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "core"));
  const PartClearance inner = clearancesOf(scene, core, 1.0).at(0),
                      outer = clearancesOf(scene, shell, 1.0).at(0);
  EXPECT_EQ(inner.overlap, InterferenceKind::PartInside);
  EXPECT_EQ(outer.overlap, InterferenceKind::SceneInside);
  EXPECT_EQ(inner.distance, 0.0);
  EXPECT_EQ(inner.minima, 0U);
  EXPECT_NEAR(glm::distance(inner.partPoint, inner.otherPoint), 0.5, 1e-12) << "points of the surfaces";
}

TEST(Clearance, HiddenPartsAreNotMeasuredAndThatOfAnOpenMeshIsSaid) {
  Scene scene;
  const PartId part = scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "part"));
  Part other = test::partOf(test::geometryOf(test::squareMesh(1.0, 1)), "sheet",
                            {{1.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 2.0}});
  const PartId sheet = scene.add(other);
  other.isVisible = false;
  other.name = "hidden";
  scene.add(other);
  const auto clearances = clearancesOf(scene, part, 1.0);
  ASSERT_EQ(clearances.size(), 1U);
  EXPECT_EQ(clearances[0].other, sheet);
  EXPECT_NEAR(clearances[0].distance, 1.5, 1e-12);
  EXPECT_EQ(clearances[0].minima, 0U) << "beyond the cutoff";
  EXPECT_FALSE(clearances[0].isBetweenSolids);
}

TEST(Clearance, WhatMakesNoSenseIsRefusedAndLongWorkEndsWhenAsked) {
  Scene scene;
  const PartId part = scene.add(test::partOf(test::geometryOf(test::tetrahedronMesh()), "part"));
  EXPECT_TRUE(clearancesOf(scene, part, 1.0).empty());
  EXPECT_THROW(clearancesOf(scene, PartId{99}, 1.0), UsageError);
  EXPECT_THROW(clearancesOf(scene, part, 0.0), UsageError);
  EXPECT_THROW(clearancesOf(scene, part, std::nan("")), UsageError);
  EXPECT_THROW(clearancesOf(scene, part, 1.0, [](double) { return false; }), Cancelled);
}

TEST(Clearance, OfPartsThatMoveAsOneTheNearestCounts) {
  Scene scene;
  const PartGeometryPtr cube = test::geometryOf(test::boxMesh(glm::dvec3(1.0)));
  const auto add = [&](const char* name, double x) {
    return scene.add(test::partOf(cube, name, {{1, 0, 0, 0}, {x, 0, 0}}));
  };
  const PartId left = add("Left", 0.0), right = add("Right", 1.5);
  const PartId nearRight = add("Near right", 2.75), nearLeft = add("Near left", -1.125);
  const auto rows = clearancesOf(scene, {left, right}, 1.0);
  ASSERT_EQ(rows.size(), 2U) << "not to each other";
  EXPECT_EQ(rows[0].other, nearRight);
  EXPECT_EQ(rows[0].part, right);
  EXPECT_NEAR(rows[0].distance, 0.25, 1e-12);
  EXPECT_EQ(rows[1].other, nearLeft);
  EXPECT_EQ(rows[1].part, left);
  EXPECT_NEAR(rows[1].distance, 0.125, 1e-12);
  EXPECT_EQ(rows[0].minima, 1U) << "the left one has none within the cutoff";
  // A part that overlaps counts before one that is near.
  Part moved = scene.get(nearRight);
  moved.worldFromPart.translation.x = 0.75;
  scene.replace(moved);
  const PartClearance both = clearancesOf(scene, {left, right}, 1.0).at(0);
  EXPECT_TRUE(both.isOverlapping());
  EXPECT_EQ(both.distance, 0.0);
  // Hidden parts of the body do not count.
  Part hidden = scene.get(left);
  hidden.isVisible = false;
  scene.replace(hidden);
  EXPECT_EQ(clearancesOf(scene, {left, right}, 1.0).at(1).part, right);
}

TEST(Clearance, WhatATickKnowsIsTakenOverAndTheRestStays) {
  const auto row = [](unsigned id, bool isSolid) {
    PartClearance each;
    each.other = PartId{id};
    each.distance = 9.0;
    each.isBetweenSolids = isSolid;
    return each;
  };
  std::vector<PartClearance> rows{row(1, true), row(2, true), row(3, false), row(4, true)};
  rows[3].overlap = InterferenceKind::SurfacesMeet;
  const auto snapshot = std::make_unique<ServoSnapshot>();
  const auto add = [&](unsigned id, double distance) {
    SnapshotLmd& minimum = snapshot->lmds[snapshot->storedLmds++];
    minimum.other = PartId{id};
    minimum.lmd.distance = distance;
    minimum.lmd.scenePoint.x = distance;
  };
  add(1, 0.5);
  add(1, 0.25);
  add(3, 0.1);
  add(4, 0.125);
  snapshot->lmdCount = 5;
  updateFrom(*snapshot, rows);
  EXPECT_EQ(rows[0].distance, 0.25);
  EXPECT_EQ(rows[0].otherPoint.x, 0.25);
  EXPECT_EQ(rows[0].minima, 2U);
  EXPECT_FALSE(rows[0].isEveryMinimum) << "one of five was not stored";
  EXPECT_EQ(rows[1].distance, 9.0) << "nothing is known of what is beyond the cutoff";
  EXPECT_EQ(rows[2].distance, 9.0) << "minima of open meshes need not hold the least distance";
  EXPECT_EQ(rows[3].distance, 0.125);
  EXPECT_FALSE(rows[3].isOverlapping()) << "they are apart again";

  rows[3] = row(4, true);
  snapshot->overlapping[0] = PartId{4};
  snapshot->overlappingCount = 1;
  updateFrom(*snapshot, rows);
  EXPECT_EQ(rows[3].distance, 9.0) << "overlapping: the next search tells";

  snapshot->overlappingCount = ServoSnapshot::kMaxOverlapping + 1;
  rows[0] = row(1, true);
  rows[0].overlap = InterferenceKind::SurfacesMeet;
  updateFrom(*snapshot, rows);
  EXPECT_TRUE(rows[0].isOverlapping()) << "it may be one of those that are not named";

  snapshot->overlappingCount = 0;
  snapshot->isOverlapUnknown = true;
  updateFrom(*snapshot, rows);
  EXPECT_TRUE(rows[0].isOverlapping()) << "surfaces that pass through each other have minima too";
  EXPECT_EQ(rows[0].distance, 9.0);
}

TEST(Clearance, WhereATickKnowsOnlyABoundItIsTakenOverAsOne) {
  std::vector<PartClearance> rows(2);
  for (PartClearance& each : rows)
    each.isBetweenSolids = true;
  rows[0].other = PartId{1};
  rows[1].other = PartId{2};
  const auto snapshot = std::make_unique<ServoSnapshot>();
  const auto add = [&](unsigned id, double distance) {
    SnapshotLmd& minimum = snapshot->lmds[snapshot->storedLmds++];
    minimum.other = PartId{id};
    minimum.lmd.distance = distance;
  };
  add(1, 0.5);
  add(2, 0.125);
  snapshot->lmdCount = 2;
  snapshot->distance = 0.25;
  snapshot->isDistanceBound = true;
  updateFrom(*snapshot, rows);
  EXPECT_EQ(rows[0].distance, 0.25) << "a minimum nearer than that found may be missing";
  EXPECT_TRUE(rows[0].isDistanceBound);
  EXPECT_EQ(rows[1].distance, 0.125) << "none can be nearer than the one found";
  EXPECT_FALSE(rows[1].isDistanceBound);

  snapshot->isDistanceBound = false;
  snapshot->distance = 0.125;
  updateFrom(*snapshot, rows);
  EXPECT_EQ(rows[0].distance, 0.5);
  EXPECT_FALSE(rows[0].isDistanceBound);
}

TEST(Clearance, TheTableSaysNamesUnitsAndOverlaps) {
  Scene scene;
  const PartId part = scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "a, b"));
  const PartId other = scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "c"));
  PartClearance row;
  row.part = part;
  row.other = other;
  row.distance = 0.125;
  row.partPoint = {1, 2, 3};
  row.otherPoint = {4, 5, 6};
  row.minima = 7;
  PartClearance second = row;
  second.overlap = InterferenceKind::PartInside;
  second.isEveryMinimum = false;
  row.isDistanceBound = true;
  EXPECT_EQ(clearanceCsv(scene, {row, second}),
            "part,other,distance [m],part_x [m],part_y [m],part_z [m],other_x [m],other_y [m],other_z [m],"
            "minima,every_minimum,overlap,distance_bound\n"
            "\"a, b\",c,0.125,1,2,3,4,5,6,7,1,no,1\n"
            "\"a, b\",c,0.125,1,2,3,4,5,6,7,0,inside the other,0\n");
  second.overlap = InterferenceKind::SurfacesMeet;
  second.isTouching = true;
  EXPECT_TRUE(clearanceCsv(scene, {second}).ends_with(",touching,0\n"));
}

/// Flush contact was called an overlap.
TEST(Clearance, PartsThatTouchAreToldApartFromPartsThatOverlap) {
  Scene scene;
  const PartGeometryPtr cube = test::geometryOf(test::boxMesh(glm::dvec3(0.02)));
  const auto add = [&](const char* name, double height) {
    return scene.add(test::partOf(cube, name, {{1, 0, 0, 0}, {0.001, 0.0, height}}));
  };
  const PartId part = add("part", 0.0);
  add("flush", 0.02);
  add("deep", -0.019);
  const std::vector<PartClearance> rows = clearancesOf(scene, part, 0.01);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_TRUE(rows[0].isTouching);
  EXPECT_FALSE(rows[0].isOverlapping());
  EXPECT_LT(rows[0].distance, 1e-12);
  EXPECT_FALSE(rows[1].isTouching);
  EXPECT_TRUE(rows[1].isOverlapping());
  EXPECT_EQ(rows[1].distance, 0.0);
}

}  // namespace
}  // namespace nearfit::clearance_test
