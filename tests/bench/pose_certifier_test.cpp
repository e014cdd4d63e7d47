#include "tests/exact/pose_certifier.h"

#include <cmath>
#include <numbers>
#include <random>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/exact/exact_meeting.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/trial_share.h"

namespace nearfit::test::pose_certifier_test {
namespace {

RigidTransform shift(double x, double y, double z) {
  return {{1, 0, 0, 0}, {x, y, z}};
}

TEST(PoseCertifier, SaysOfSurfacesWhatRationalArithmeticSays) {
  std::mt19937_64 random(1);
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const BodyPair pair{"stars", starMesh(seed, 1.0, 2, 0.4),
                        withFacesWithoutArea(starMesh(seed + 9, 0.3, 1, 0.4))};
    const PoseCertifier certifier(pair.scene, pair.part);
    int meetings = 0;
    for (std::size_t i = 0; i < 24 / kTrialShare; ++i) {
      const RigidTransform pose = poseNearContact(pair, 0.4, random);
      const bool expected = doSurfacesMeetExactly(pair.scene, pair.part, pose);
      // What does not touch may be inside.
      const bool isInside = windingNumber(pair.scene, pose.applyToPoint(pair.part.vertices()[0])) > 0.5;
      EXPECT_EQ(certifier.doMeet(pose), expected || isInside);
      meetings += expected ? 1 : 0;
    }
    EXPECT_GT(meetings, 0);
  }
}

TEST(PoseCertifier, TouchingMeetsAndInsideMeets) {
  const PoseCertifier boxes(boxMesh({2, 2, 2}), boxMesh({1, 1, 1}));
  EXPECT_TRUE(boxes.doMeet(shift(1.5, 0.25, 0)));
  EXPECT_FALSE(boxes.doMeet(shift(std::nextafter(1.5, 2.0), 0.25, 0)));
  EXPECT_TRUE(boxes.doMeet(shift(0.25, 0, 0)));
  const PoseCertifier turnedAbout(boxMesh({1, 1, 1}), boxMesh({2, 2, 2}));
  EXPECT_TRUE(turnedAbout.doMeet(shift(0.25, 0, 0)));
  const PoseCertifier hollow(joined(boxMesh({4, 4, 4}), turned(boxMesh({2, 2, 2}))),
                             boxMesh({0.5, 0.5, 0.5}));
  EXPECT_FALSE(hollow.doMeet({}));
  EXPECT_TRUE(hollow.doMeet(shift(1.5, 0, 0)));
}

TEST(PoseCertifier, ManyPosesAreToldOneByOne) {
  const PoseCertifier boxes(boxMesh({2, 2, 2}), boxMesh({1, 1, 1}));
  std::vector<RigidTransform> poses;
  for (int i = 0; i < 40; ++i)
    poses.push_back(shift(0.1 * i, 0.0, 0.0));
  const std::vector<char> meetings = boxes.meetings(poses);
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_EQ(meetings[i] != 0, poses[i].translation.x <= 1.5) << i;
}

TEST(PoseCertifier, SurfacesAreApartByTheDistanceOfTheirNearestFeatures) {
  constexpr double kFar = 10.0, kExact = 1e-12;
  const PoseCertifier boxes(boxMesh({2, 2, 2}), boxMesh({1, 1, 1}));
  // Face and face, corner and corner, edge and edge.
  EXPECT_NEAR(boxes.surfacesApart(shift(2.0, 0.25, 0.1), kFar), 0.5, kExact);
  EXPECT_NEAR(boxes.surfacesApart(shift(1.6, 1.7, 1.8), kFar), std::sqrt(0.01 + 0.04 + 0.09), kExact);
  EXPECT_NEAR(boxes.surfacesApart(shift(1.8, 1.9, 0.1), kFar), 0.5, kExact);
  // Edge across an edge: both on their edges, one along y, the other along x.
  const double quarter = 0.25 * std::numbers::pi;
  const RigidTransform aboutY{glm::angleAxis(quarter, glm::dvec3(0, 1, 0)), {}};
  const RigidTransform over{glm::angleAxis(quarter, glm::dvec3(1, 0, 0)),
                            {0.3, 0.2, std::sqrt(2.0) + std::sqrt(0.5) + 0.125}};
  EXPECT_NEAR(PoseCertifier(transformed(boxMesh({2, 2, 2}), 1.0, aboutY), boxMesh({1, 1, 1}))
                  .surfacesApart(over, kFar),
              0.125, kExact);
  // No more than asked for, nothing where they meet, the walls where one is inside.
  EXPECT_LE(boxes.surfacesApart(shift(9.0, 0, 0), 1.0), 1.0);
  EXPECT_NEAR(boxes.surfacesApart(shift(9.0, 0, 0), 1.0), 1.0, kExact);
  EXPECT_EQ(boxes.surfacesApart(shift(1.5, 0.25, 0), kFar), 0.0);
  EXPECT_NEAR(boxes.surfacesApart(shift(0.25, 0, 0), kFar), 0.25, kExact);
}

TEST(PoseCertifier, SaysNoMoreThanTheDistanceByRationalArithmetic) {
  std::mt19937_64 random(7);
  const BodyPair pair{"stars", starMesh(2, 1.0, 2, 0.4), starMesh(11, 0.3, 1, 0.4)};
  const PoseCertifier certifier(pair.scene, pair.part);
  for (std::size_t i = 0; i < 24 / kTrialShare; ++i) {
    const RigidTransform pose = poseNearContact(pair, 0.4, random);
    const double exact = leastDistanceExactly(pair.scene, pair.part, pose);
    const double apart = certifier.surfacesApart(pose, 10.0);
    EXPECT_LE(apart, exact);
    EXPECT_NEAR(apart, exact, 1e-12);
  }
}

/// Out of a bowl of stars and into it again, slowly and by leaps, at rest now and then.
TEST(PoseCertifier, AlongAWayItSaysWhatItSaysOfEachPose) {
  const BodyPair pair{"stars", starMesh(5, 1.0, 2, 0.4), starMesh(8, 0.3, 1, 0.4)};
  const PoseCertifier certifier(pair.scene, pair.part);
  std::mt19937_64 random(3);
  std::normal_distribution<double> some;
  std::vector<RigidTransform> way;
  for (int walk = 0; walk < 8; ++walk) {
    RigidTransform pose = poseNearContact(pair, 0.2, random);
    const double pace = walk % 2 == 0 ? 2e-3 : 2e-2;
    for (int i = 0; i < 60; ++i) {
      if (i % 7 != 0) {
        pose.translation += pace * glm::dvec3{some(random), some(random), some(random)};
        pose.rotation =
            glm::normalize(glm::angleAxis(pace * some(random), glm::dvec3(0.0, 0.6, 0.8)) * pose.rotation);
      }
      way.push_back(pose);
    }
  }
  const std::vector<char> meetings = certifier.meetings(way);
  int met = 0;
  for (std::size_t i = 0; i < way.size(); ++i) {
    EXPECT_EQ(meetings[i] != 0, certifier.doMeet(way[i])) << i;
    met += meetings[i];
  }
  EXPECT_GT(met, 20);
  EXPECT_LT(met, 460);
}

TEST(PoseCertifier, CountsThePosesThatItLooksAtInEachWay) {
  const PoseCertifier boxes(boxMesh({2, 2, 2}), boxMesh({1, 1, 1}));
  // The boxes are apart at the first, the gap is less than the second's motion, the last two meet.
  const std::vector<RigidTransform> way{shift(3.0, 0, 0), shift(2.5, 0, 0), shift(1.2, 0, 0),
                                        shift(1.1, 0, 0)};
  const WayVerdicts far = boxes.along(way);
  EXPECT_EQ(far.meetings, (std::vector<char>{0, 0, 1, 1}));
  EXPECT_EQ(far.boxed, 1U);
  EXPECT_EQ(far.tested, 2U);
  // A ball in a corner of its box is beside another one whose box it overlaps: triangles tell, and the pose that follows is
  // argued.
  const PoseCertifier balls(icosphereMesh(1.0, 2), icosphereMesh(1.0, 2));
  const WayVerdicts near =
      balls.along(std::vector{shift(1.5, 1.5, 0), shift(1.501, 1.5, 0), shift(1.502, 1.5, 0)});
  EXPECT_EQ(near.meetings, (std::vector<char>{0, 0, 0}));
  EXPECT_EQ(near.boxed, 0U);
  EXPECT_EQ(near.measured, 1U);
  EXPECT_EQ(near.tested, 0U);
}

TEST(PoseCertifier, AWayThroughAThinWallOrIntoASolidIsSeen) {
  const PoseCertifier boxes(boxMesh({2, 2, 2}), boxMesh({1, 1, 1}));
  // Two poses on either side of the wall, or one outside and one inside, are farther from each other than
  // from it: no clearance at the first says anything of the second.
  const std::vector<RigidTransform> way{shift(2.6, 0, 0), shift(2.5, 0, 0), shift(0.1, 0, 0), shift(0, 0, 0),
                                        shift(-2.5, 0, 0)};
  EXPECT_EQ(boxes.meetings(way), (std::vector<char>{0, 0, 1, 1, 0}));
}

}  // namespace
}  // namespace nearfit::test::pose_certifier_test
