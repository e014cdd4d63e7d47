#include "core/path/path_thinning.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/path_scenes.h"
#include "tests/support/random_values.h"

namespace nearfit::path_thinning_test {
namespace {

constexpr double kSeparation = 1e-3;

/// A cube of 0.2 m that is led round a post of 1 m x 1 m: along y = -0.7 and then along x = 0.7, with 0.1 m to spare.
test::PathScene cubeRoundACorner() {
  test::PathScene made;
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({1, 1, 1})), "Post"));
  made.scene.add(
      test::partOf(test::geometryOf(test::boxMesh({0.2, 0.2, 0.2})), "Cube", test::at(-1, -0.7, 0)));
  std::vector<RigidTransform> poses;
  for (int i = 0; i <= 34; ++i)
    poses.push_back(test::at(-1.0 + 0.05 * i, -0.7, 0.0));
  for (int i = 1; i <= 34; ++i)
    poses.push_back(test::at(0.7, -0.7 + 0.05 * i, 0.0));
  made.path = test::pathThrough("Cube", poses);
  return made;
}

/// Max distance between where two paths have the cube's centre at the times of the first [m]; cubes here do not turn.
double maxDeviation(const AssemblyPath& original, const AssemblyPath& changed) {
  double most = 0.0;
  for (const PathPose& pose : original.poses) {
    const RigidTransform there = poseAt(changed, placeAt(changed, pose.time));
    most = std::max(most, glm::distance(there.translation, pose.worldFromLead.translation));
  }
  return most;
}

TEST(PathThinning, AStraightMotionKeepsItsEndsAlone) {
  const test::PathScene made = test::cubePastCube(0.01);
  AssemblyPath path = made.path;
  path.poses.clear();
  for (int i = 0; i <= 60; ++i)
    path.poses.push_back({0.1 * i, test::at(-3.0 + 0.1 * i, 1.01, 0.0)});
  const ChangedPath result = thinned(path, PathCertifier(made.scene, path, kSeparation), 1e-6);
  EXPECT_EQ(result.path.poses.size(), 2U);
  EXPECT_EQ(result.changed, 59U);
  EXPECT_EQ(result.refused, 0U);
  EXPECT_EQ(result.path.poses[0].time, 0.0);
  EXPECT_EQ(result.path.poses[1].time, path.poses.back().time);
}

TEST(PathThinning, DeviatesByNoMoreThanTheTolerance) {
  const test::PathScene made = cubeRoundACorner();
  AssemblyPath path = made.path;
  test::RandomValues random(2);
  for (PathPose& pose : path.poses)
    pose.worldFromLead.translation += random.vector(0.01);
  const PathCertifier certifier(made.scene, path, kSeparation);
  for (const double tolerance : {0.01, 0.02, 0.04}) {
    const ChangedPath result = thinned(path, certifier, tolerance);
    EXPECT_LT(result.path.poses.size(), path.poses.size());
    EXPECT_LE(maxDeviation(path, result.path), tolerance * (1.0 + 1e-9));
    EXPECT_TRUE(certifier.prove(result.path).isFree());
  }
}

TEST(PathThinning, ACornerIsNotCutThroughWhatIsInTheWay) {
  const test::PathScene made = cubeRoundACorner();
  const PathCertifier certifier(made.scene, made.path, kSeparation);
  // The straight way from end to end is within this, and goes through the post.
  const ChangedPath result = thinned(made.path, certifier, 2.0);
  EXPECT_GT(result.refused, 0U);
  EXPECT_GT(result.path.poses.size(), 2U);
  EXPECT_LT(result.path.poses.size(), made.path.poses.size() / 2);
  EXPECT_TRUE(certifier.prove(result.path).isFree());
}

TEST(PathThinning, WhereTheOriginalIsNotFreeItStays) {
  const test::PathScene made = cubeRoundACorner();
  // Crosses the post's surface all the way, so that no segment is proven.
  AssemblyPath path = test::pathThrough("Cube", {});
  for (int i = 0; i <= 20; ++i)
    path.poses.push_back({0.1 * i, test::at(-0.3 + 0.03 * i, 0.5, 0.0)});
  const PathCertifier certifier(made.scene, path, kSeparation);
  const ChangedPath result = thinned(path, certifier, 1.0);
  EXPECT_TRUE(isSamePath(result.path, path));
  EXPECT_EQ(result.changed, 0U);
}

TEST(PathThinning, AFullTurnIsNotTakenForRest) {
  const test::PathScene made = test::barInRing(0.5);
  AssemblyPath path = made.path;
  path.poses.clear();
  for (int i = 0; i <= 72; ++i)
    path.poses.push_back({0.1 * i, {rotationOf({0, 0, 2.0 * std::numbers::pi * i / 72.0}), glm::dvec3(0.0)}});
  const ChangedPath result = thinned(path, PathCertifier(made.scene, path, kSeparation), 0.01);
  EXPECT_GE(result.path.poses.size(), 4U) << "no segment turns by more than 170 degrees";
  EXPECT_LT(result.path.poses.size(), 20U);
  for (const PathPose& pose : path.poses) {
    const RigidTransform there = poseAt(result.path, placeAt(result.path, pose.time));
    EXPECT_LT(glm::distance(there.applyToVector({1, 0, 0}), pose.worldFromLead.applyToVector({1, 0, 0})),
              0.05);
  }
}

TEST(PathSmoothing, TakesAZigzagOutOfAMotionInTheOpen) {
  test::PathScene made = test::cubePastCube(2.0);
  AssemblyPath path = made.path;
  path.poses.clear();
  for (int i = 0; i <= 60; ++i)
    path.poses.push_back({0.1 * i, test::at(-3.0 + 0.1 * i, 3.0, i % 2 == 0 ? 0.001 : -0.001)});
  const ChangedPath result = smoothed(path, PathCertifier(made.scene, path, kSeparation), 0.01);
  EXPECT_EQ(result.refused, 0U);
  ASSERT_EQ(result.path.poses.size(), path.poses.size());
  EXPECT_EQ(result.path.poses.front().worldFromLead.translation.z, 0.001) << "the ends stay";
  EXPECT_EQ(result.path.poses.back().worldFromLead.translation.z, 0.001);
  for (std::size_t i = 20; i < 40; ++i) {
    EXPECT_LT(std::abs(result.path.poses[i].worldFromLead.translation.z), 0.0005);
    EXPECT_EQ(result.path.poses[i].time, path.poses[i].time);
  }
}

TEST(PathSmoothing, MovesNoPoseFartherThanTheTolerance) {
  test::PathScene made = test::cubePastCube(2.0);
  AssemblyPath path = made.path;
  path.poses.clear();
  test::RandomValues random(4);
  for (int i = 0; i <= 60; ++i)
    path.poses.push_back(
        {0.1 * i, test::at(-3.0 + 0.1 * i, 3.0 + random.in(-0.05, 0.05), random.in(-0.05, 0.05))});
  const ChangedPath result = smoothed(path, PathCertifier(made.scene, path, kSeparation), 0.02);
  EXPECT_GT(result.changed, 0U);
  for (std::size_t i = 0; i < path.poses.size(); ++i) {
    EXPECT_LE(glm::distance(result.path.poses[i].worldFromLead.translation,
                            path.poses[i].worldFromLead.translation),
              0.02 * (1.0 + 1e-9));
  }
}

TEST(PathSmoothing, AWayRoundAnObstacleStaysRoundIt) {
  test::PathScene made;
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({0.02, 0.02, 1})), "Pin"));
  made.scene.add(
      test::partOf(test::geometryOf(test::boxMesh({0.2, 0.2, 0.2})), "Cube", test::at(-1, 0.05, 0)));
  // Straight but for poses that step out just round the pin: 0.11 m would touch it.
  AssemblyPath path = test::pathThrough("Cube", {});
  for (int i = 0; i <= 40; ++i) {
    const double x = -1.0 + 0.05 * i;
    path.poses.push_back({0.1 * i, test::at(x, std::abs(x) < 0.28 ? 0.1115 : 0.0, 0.0)});
  }
  const PathCertifier certifier(made.scene, path, kSeparation);
  ASSERT_TRUE(certifier.prove(path).isFree());
  const ChangedPath result = smoothed(path, certifier, 0.2);
  EXPECT_GT(result.refused, 0U);
  EXPECT_GT(result.changed, 0U);
  EXPECT_TRUE(certifier.prove(result.path).isFree());
}

TEST(PathSmoothing, TolerancesThatAreNoLengthAreRefused) {
  const test::PathScene made = test::cubePastCube(0.01);
  const PathCertifier certifier(made.scene, made.path, kSeparation);
  for (const double tolerance : {0.0, -1.0, std::nan(""), static_cast<double>(INFINITY)}) {
    EXPECT_THROW(thinned(made.path, certifier, tolerance), UsageError);
    EXPECT_THROW(smoothed(made.path, certifier, tolerance), UsageError);
  }
}

}  // namespace
}  // namespace nearfit::path_thinning_test
