#include "device/simulated/simulated_device.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace nearfit::simulated_device_test {
namespace {

RigidTransform at(double x) {
  return {glm::dquat(1.0, 0.0, 0.0, 0.0), {x, 0.0, 0.0}};
}

TEST(PathDevice, GivesEachPoseOnceThenEnds) {
  PathDevice device({at(1.0), at(2.0)});
  HandleInput handle{.pose = at(9.0)};
  EXPECT_EQ(device.state(), DeviceState::Ready);
  EXPECT_FALSE(device.readHandle(handle)) << "not started";
  device.start(at(0.0));
  EXPECT_EQ(device.state(), DeviceState::Armed);
  ASSERT_TRUE(device.readHandle(handle));
  EXPECT_EQ(handle.pose.translation.x, 1.0);
  ASSERT_TRUE(device.readHandle(handle));
  EXPECT_EQ(handle.pose.translation.x, 2.0);
  EXPECT_FALSE(device.readHandle(handle));
  EXPECT_EQ(handle.pose.translation.x, 2.0) << "left as it was";
  EXPECT_EQ(device.state(), DeviceState::Ready);
}

TEST(PathDevice, StartBeginsThePathAnew) {
  PathDevice device({at(1.0), at(2.0)});
  HandleInput handle;
  for (int run = 0; run < 2; ++run) {
    device.start(at(0.0));
    ASSERT_TRUE(device.readHandle(handle));
    EXPECT_EQ(handle.pose.translation.x, 1.0);
    device.stop();
    EXPECT_FALSE(device.readHandle(handle));
  }
}

TEST(PathDevice, ARepeatingPathNeverEnds) {
  PathDevice device({at(1.0), at(2.0), at(3.0)}, true);
  device.start(at(0.0));
  HandleInput handle;
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(device.readHandle(handle));
    EXPECT_EQ(handle.pose.translation.x, 1.0 + i % 3);
  }
}

TEST(PathDevice, AnEmptyPathIsRefused) {
  EXPECT_THROW(PathDevice({}), UsageError);
}

TEST(ManualDevice, StartsWhereThePartIsAndFollowsTheNewestPose) {
  ManualDevice device;
  HandleInput handle;
  EXPECT_FALSE(device.readHandle(handle)) << "not started";
  device.start(at(5.0));
  ASSERT_TRUE(device.readHandle(handle));
  EXPECT_EQ(handle.pose.translation.x, 5.0);
  device.setPose(at(6.0));
  device.setPose(at(7.0));
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(device.readHandle(handle));
    EXPECT_EQ(handle.pose.translation.x, 7.0);
  }
  device.stop();
  EXPECT_FALSE(device.readHandle(handle));
}

class ScriptedHand : public testing::Test {
 protected:
  static constexpr double kReach = 0.05, kSeconds = 4.0, kPeriod = 1e-3;
  const RigidTransform rest_{glm::angleAxis(0.7, glm::normalize(glm::dvec3(1.0, 2.0, 3.0))), {0.1, 0.2, 0.3}};
  const std::vector<RigidTransform> path_ =
      scriptedHandPath(rest_, glm::dvec3(0.0, 0.0, -2.0), kReach, kSeconds, kPeriod);
};

TEST_F(ScriptedHand, BeginsAndEndsWhereThePartIs) {
  EXPECT_EQ(path_.size(), 4001U);
  for (const RigidTransform& end : {path_.front(), path_.back()}) {
    EXPECT_NEAR(glm::distance(end.translation, rest_.translation), 0.0, 1e-12);
    EXPECT_NEAR(std::abs(glm::dot(end.rotation, rest_.rotation)), 1.0, 1e-12);
  }
}

TEST_F(ScriptedHand, GoesAsFarAsTheReachAlongTheApproachAndNoFarther) {
  double lowest = rest_.translation.z, farthestAside = 0.0, largestTurn = 0.0;
  for (const RigidTransform& pose : path_) {
    lowest = std::min(lowest, pose.translation.z);
    const glm::dvec3 d = pose.translation - rest_.translation;
    farthestAside = std::max(farthestAside, std::hypot(d.x, d.y));
    const double cosine = std::min(1.0, std::abs(glm::dot(pose.rotation, rest_.rotation)));
    largestTurn = std::max(largestTurn, 2.0 * std::acos(cosine));
  }
  EXPECT_NEAR(lowest, rest_.translation.z - kReach, 1e-12);
  EXPECT_GT(farthestAside, 0.1 * kReach) << "it slides";
  EXPECT_LT(farthestAside, kReach);
  EXPECT_GT(largestTurn, 0.02) << "it wobbles";
  EXPECT_LT(largestTurn, 0.2);
}

TEST_F(ScriptedHand, MovesSmoothlyAndRestsAtBothEnds) {
  // A sweep of the whole reach in a second by the quintic ease reaches 15/8 reach a second, and changes its
  // speed by 10/sqrt(3) reach a second squared; the circle stays within a few times that.
  double largestJerkStep = 0.0;
  glm::dvec3 before(0.0);
  for (std::size_t i = 1; i < path_.size(); ++i) {
    const glm::dvec3 step = path_[i].translation - path_[i - 1].translation;
    EXPECT_LT(glm::length(step), 3.0 * kReach * kPeriod);
    largestJerkStep = std::max(largestJerkStep, glm::length(step - before));
    before = step;
  }
  EXPECT_LT(largestJerkStep, 30.0 * kReach * kPeriod * kPeriod);
  EXPECT_LT(glm::length(path_[1].translation - path_[0].translation), 1e-6 * kReach);
  EXPECT_LT(glm::length(before), 1e-6 * kReach);
}

TEST_F(ScriptedHand, WobblesNoFartherThanTheCallerSays) {
  constexpr double kWobble = 0.001;
  const auto path = scriptedHandPath(rest_, glm::dvec3(0.0, 0.0, -2.0), kReach, kSeconds, kPeriod, kWobble);
  double largestTurn = 0.0;
  for (const RigidTransform& pose : path) {
    // From the vector part: the cosine of so small an angle has lost its digits.
    const glm::dquat turn = pose.rotation * glm::conjugate(rest_.rotation);
    largestTurn = std::max(largestTurn, 2.0 * std::asin(glm::length(glm::dvec3(turn.x, turn.y, turn.z))));
  }
  // Two turns about perpendicular axes, sin(phase) and sin(2 phase) of the amplitude: together they reach
  // sqrt(max(s + 4 s (1 - s))) of it over s = sin^2, which is 5/4 at s = 5/8.
  EXPECT_NEAR(largestTurn, 1.25 * kWobble, 1e-6);
}

TEST_F(ScriptedHand, SlidesInACircleOfTheGivenRadius) {
  constexpr double kShare = 0.4;
  const auto path =
      scriptedHandPath(rest_, glm::dvec3(0.0, 0.0, -2.0), kReach, kSeconds, kPeriod, 0.0, kShare);
  double farthestAside = 0.0;
  for (const RigidTransform& pose : path) {
    const glm::dvec3 d = pose.translation - rest_.translation;
    farthestAside = std::max(farthestAside, std::hypot(d.x, d.y));
  }
  // The circle begins on the way of the approach: its far side is a diameter away.
  EXPECT_NEAR(farthestAside, 2.0 * kShare * kReach, 1e-6 * kReach);
}

TEST_F(ScriptedHand, TheSameArgumentsGiveTheSamePath) {
  const auto again = scriptedHandPath(rest_, glm::dvec3(0.0, 0.0, -2.0), kReach, kSeconds, kPeriod);
  ASSERT_EQ(again.size(), path_.size());
  for (std::size_t i = 0; i < path_.size(); ++i) {
    EXPECT_EQ(again[i].translation, path_[i].translation);
    EXPECT_EQ(again[i].rotation, path_[i].rotation);
  }
}

TEST_F(ScriptedHand, SenselessArgumentsAreRefused) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const glm::dvec3 down(0.0, 0.0, -1.0);
  EXPECT_THROW(scriptedHandPath(rest_, glm::dvec3(0.0), kReach, kSeconds, kPeriod), UsageError);
  EXPECT_THROW(scriptedHandPath(rest_, glm::dvec3(kInfinity, 0.0, 0.0), kReach, kSeconds, kPeriod),
               UsageError);
  EXPECT_THROW(scriptedHandPath(at(kInfinity), down, kReach, kSeconds, kPeriod), UsageError);
  EXPECT_THROW(scriptedHandPath(rest_, down, 0.0, kSeconds, kPeriod), UsageError);
  EXPECT_THROW(scriptedHandPath(rest_, down, kReach, kInfinity, kPeriod), UsageError);
  EXPECT_THROW(scriptedHandPath(rest_, down, kReach, kSeconds, 0.0), UsageError);
  EXPECT_THROW(scriptedHandPath(rest_, down, kReach, kSeconds, kPeriod, 0.0, -1.0), UsageError);
  EXPECT_THROW(scriptedHandPath(rest_, down, kReach, 1e9, 1e-3), UsageError);
}

}  // namespace
}  // namespace nearfit::simulated_device_test
