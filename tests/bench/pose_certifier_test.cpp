#include "tests/exact/pose_certifier.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/exact/exact_meeting.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::test {
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
    for (std::size_t i = 0; i < 24 / kPoseShare; ++i) {
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

}  // namespace
}  // namespace nearfit::test
