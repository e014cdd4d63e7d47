// The proxy of a part that joints keep: it stays on them, wherever the hand leads and whatever it touches.
#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/math/rotation_vector.h"
#include "core/servo/proxy.h"
#include "tests/exact/pose_certifier.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/joint_sets.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/proxy_walk.h"
#include "tests/support/trial_share.h"

namespace nearfit::proxy_joints_test {
namespace {

using test::jointSetOf;
using test::keptAt;
using test::ProxyWalk;
using test::RandomValues;

constexpr double kMargin = 1e-3;
/// How far the clearance may be off the margin (kMarginWeight in proxy.cpp: a hundredth for each direction).
constexpr double kSag = 0.03 * kMargin;
/// How far a part that began on its joints may be off them [m, rad]: rounding, in free motion and in contact.
constexpr double kOff = 1e-9;
const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

/// A cube of side 0.2 about its origin, over a floor whose top is z = 0.
ProxyWalk cubeOverFloor(double height, double friction = 0.0) {
  return ProxyWalk({{test::boxMesh({4.0, 4.0, 1.0}, {0.0, 0.0, -0.5}), {}}}, test::boxMesh({0.2, 0.2, 0.2}),
                   at({0.0, 0.0, 0.1 + height}), {kMargin, friction});
}

double lowestCorner(const ProxyWalk& walk) {
  double lowest = 1e9;
  for (const glm::dvec3& v : walk.scene().moving.geometry->mesh.vertices())
    lowest = std::min(lowest, walk.pose().applyToPoint(v).z);
  return lowest;
}

/// The larger of distance and angle that the part is off its joints.
double offJoints(const ProxyWalk& walk) {
  const JointResidual off = walk.scene().joints.residual(walk.pose());
  return std::max(off.distance, off.angle);
}

/// Keeps the part on a feature where it is.
void keep(ProxyWalk& walk, JointKind kind, const glm::dvec3& point, const glm::dvec3& direction = kZ) {
  walk.setJoints(jointSetOf({keptAt(kind, walk.pose(), point, direction)}, walk.pose()));
}

TEST(ProxyJoints, LedOffItsAxisInFreeMotionItStaysOnItAndFollowsAlongAndAboutIt) {
  ProxyWalk walk = cubeOverFloor(1.0);
  keep(walk, JointKind::OnAxis, glm::dvec3(0.0), kZ);
  for (int i = 0; i < 400; ++i) {
    const RigidTransform hand{
        glm::angleAxis(0.3 * std::sin(0.03 * i), kX) * glm::angleAxis(0.02 * i, kZ),
        {0.2 * std::sin(0.05 * i), 0.1 * std::cos(0.02 * i), 1.1 + 0.2 * std::sin(0.01 * i)}};
    walk.lead(hand);
    ASSERT_LT(offJoints(walk), kOff) << i;
    ASSERT_NEAR(walk.pose().translation.z, hand.translation.z, 1e-6) << i;
  }
}

TEST(ProxyJoints, AHandOnTheJointIsFollowedToTheLastBit) {
  ProxyWalk walk = cubeOverFloor(1.0);
  keep(walk, JointKind::OnAxis, glm::dvec3(0.0), kZ);
  for (int i = 0; i < 200; ++i) {
    const RigidTransform hand{glm::angleAxis(0.02 * i, kZ), {0.0, 0.0, 1.1 + 0.001 * i}};
    walk.lead(hand);
    EXPECT_EQ(walk.pose().translation, hand.translation);
    EXPECT_EQ(walk.pose().rotation, hand.rotation);
  }
}

TEST(ProxyJoints, ALargeTurnAboutAnAxisBesideThePartKeepsToItsArc) {
  // Straight ways to the hand would leave the arc by some of its radius.
  ProxyWalk walk = cubeOverFloor(1.0);
  keep(walk, JointKind::OnAxis, {0.5, 0.0, 0.0}, kZ);
  const glm::dvec3 pivot(0.5, 0.0, 0.0);
  const glm::dquat turn = glm::angleAxis(2.0, kZ);
  const RigidTransform hand{turn, turn * (walk.pose().translation - pivot) + pivot};
  for (int i = 0; i < 60; ++i) {
    walk.lead(hand);
    ASSERT_LT(offJoints(walk), kOff) << i;
    EXPECT_NEAR(glm::length(glm::dvec2(walk.pose().translation - pivot)), 0.5, kOff) << i;
  }
  EXPECT_LT(glm::distance(walk.pose().translation, hand.translation), 1e-6);
}

TEST(ProxyJoints, PushedAlongItsAxisAgainstAWallItStopsAtTheMargin) {
  ProxyWalk walk = cubeOverFloor(0.05);
  keep(walk, JointKind::OnAxis, glm::dvec3(0.0), kZ);
  const RigidTransform hand{glm::angleAxis(0.3, glm::normalize(glm::dvec3(1, 2, 1))), {0.1, 0.05, -0.4}};
  for (int i = 0; i < 120; ++i) {
    walk.lead(hand);
    ASSERT_LT(offJoints(walk), kOff) << i;
    ASSERT_GT(lowestCorner(walk), 0.0) << i;
  }
  EXPECT_NEAR(lowestCorner(walk), kMargin, kSag);
  const RigidTransform rest = walk.pose();
  walk.hold(hand, 30);
  EXPECT_EQ(walk.pose().translation, rest.translation) << "and rests there to the last bit";
  EXPECT_EQ(walk.pose().rotation, rest.rotation);
}

TEST(ProxyJoints, InAPlaneItSlidesAlongAWallThatItIsPressedAgainst) {
  // The cube slides on the plane z = 0.3 and meets a wall at x = 1.
  ProxyWalk walk({{test::boxMesh({1.0, 4.0, 4.0}, {1.5, 0.0, 0.0}), {}}}, test::boxMesh({0.2, 0.2, 0.2}),
                 at({0.5, 0.0, 0.4}), {kMargin, 0.0});
  keep(walk, JointKind::InPlane, {0.5, 0.0, 0.3}, -kZ);
  for (int i = 0; i < 300; ++i) {
    walk.lead({glm::angleAxis(0.2, kY), {1.2, 0.002 * i, 0.6}});
    ASSERT_LT(offJoints(walk), kOff) << i;
  }
  EXPECT_NEAR(walk.pose().translation.x, 0.9 - kMargin, kSag);
  EXPECT_NEAR(walk.pose().translation.y, 0.002 * 299, 1e-3);
  EXPECT_NEAR(walk.pose().translation.z, 0.4, kOff);
}

TEST(ProxyJoints, NothingPullsAlongOrAboutAnAxisThatItIsLedOff) {
  // The coupling's energy is least where the part is: neither a slide nor a turn lowers it.
  RandomValues random(5);
  for (int i = 0; i < 20; ++i) {
    ProxyWalk walk = cubeOverFloor(1.0);
    const glm::dvec3 point = walk.pose().translation + random.vector(0.2),
                     direction = glm::normalize(kX + random.vector(0.8));
    keep(walk, JointKind::OnAxis, point, direction);
    const RigidTransform hand{glm::normalize(rotationOf(random.vector(0.3))),
                              walk.pose().translation + random.vector(0.1)};
    walk.hold(hand, 60);
    const MassMetric& metric = walk.scene().metric;
    const auto energy = [&](double slide, double turn) {
      const glm::dquat about = glm::angleAxis(turn, direction);
      const RigidTransform pose{glm::normalize(about * walk.pose().rotation),
                                about * (walk.pose().translation - point) + point + slide * direction};
      return test::energyOf(pose, hand, walk.scene().centreInPart, metric);
    };
    const double here = energy(0.0, 0.0);
    // Derivatives by central differences: the force along and the torque about the axis, of unit stiffness.
    constexpr double kStep = 1e-5;
    const double whole = std::sqrt(2.0 * here);
    EXPECT_NEAR((energy(kStep, 0.0) - energy(-kStep, 0.0)) / (2.0 * kStep), 0.0, 1e-4 * whole) << i;
    EXPECT_NEAR((energy(0.0, kStep) - energy(0.0, -kStep)) / (2.0 * kStep), 0.0, 1e-4 * whole) << i;
  }
}

TEST(ProxyJoints, AJointThatPressesThePartIntoAWallNeverLetsItThrough) {
  // Its point belongs half a metre under the floor.
  ProxyWalk walk = cubeOverFloor(0.2);
  RandomValues random(23);
  JointSet::Placed joint = keptAt(JointKind::ToPoint, at(glm::dvec3(0.0)), glm::dvec3(0.0));
  joint.place = {0.0, 0.0, -0.5};
  walk.setJoints(jointSetOf({joint}, walk.pose()));
  for (int i = 0; i < 60; ++i) {
    walk.lead(at({0.0, 0.0, 0.3}));
    ASSERT_GT(lowestCorner(walk), 0.4 * kMargin) << i;
  }
  EXPECT_LT(lowestCorner(walk), 2.0 * kMargin) << "it goes as far as contact lets it";
  for (int i = 0; i < 200; ++i) {
    walk.lead({rotationOf(random.vector(0.5)), random.vector(0.5)});
    ASSERT_GT(lowestCorner(walk), 0.0) << i;
  }
}

TEST(ProxyJoints, APartThatStartsOffItsJointGoesThereWithoutALeap) {
  const RigidTransform aside{glm::angleAxis(0.5, kX), {0.3, 0.2, 0.6}};
  ProxyWalk off({{test::boxMesh({4.0, 4.0, 1.0}, {0.0, 0.0, -0.5}), {}}}, test::boxMesh({0.2, 0.2, 0.2}),
                aside, {kMargin, 0.0});
  off.setJoints(jointSetOf({keptAt(JointKind::OnAxis, at({0.0, 0.0, 0.6}), glm::dvec3(0.0), kZ)}, aside));
  const double before = offJoints(off);
  off.lead(aside);
  EXPECT_GT(offJoints(off), 0.5 * before) << "not at once";
  off.hold(aside, 60);
  EXPECT_LT(offJoints(off), kOff);
}

TEST(ProxyJoints, APartAsideOfItsAxisComesBackToItAlongTheFloorThatItIsPressedAgainst) {
  ProxyWalk walk({{test::boxMesh({4.0, 4.0, 1.0}, {0.0, 0.0, -0.5}), {}}}, test::boxMesh({0.2, 0.2, 0.2}),
                 at({0.05, 0.0, 0.1 + kMargin}), {kMargin, 0.0});
  walk.setJoints(
      jointSetOf({keptAt(JointKind::OnAxis, at(glm::dvec3(0.0)), glm::dvec3(0.0), kZ)}, walk.pose()));
  for (int i = 0; i < 150; ++i) {
    walk.lead(at({0.05, 0.0, 0.0}));
    ASSERT_GT(lowestCorner(walk), 0.5 * kMargin) << i;
  }
  // Motions below a nanometre count as rest.
  EXPECT_LT(offJoints(walk), 2.0 * kOff);
  EXPECT_NEAR(lowestCorner(walk), kMargin, kSag);
}

TEST(ProxyJoints, JointsThatContradictEachOtherHoldNothing) {
  JointSet::Placed far = keptAt(JointKind::ToPoint, at(glm::dvec3(0.0)), {0.1, 0.0, 0.0});
  far.place.x = 0.3;
  const JointSet joints = jointSetOf({keptAt(JointKind::ToPoint, at(glm::dvec3(0.0)), glm::dvec3(0.0)), far},
                                     at(glm::dvec3(0.0)));
  ASSERT_TRUE(joints.isContradictory());
  ProxyWalk walk = cubeOverFloor(0.05), free = cubeOverFloor(0.05);
  walk.setJoints(joints);
  EXPECT_TRUE(walk.scene().areJointsContradictory);
  for (int i = 0; i < 100; ++i) {
    const RigidTransform hand{glm::angleAxis(0.01 * i, glm::normalize(glm::dvec3(1, 2, 3))),
                              {0.002 * i, 0.0, 0.05}};
    walk.lead(hand);
    free.lead(hand);
    ASSERT_EQ(walk.pose().translation, free.pose().translation) << i;
    ASSERT_EQ(walk.pose().rotation, free.pose().rotation) << i;
  }
}

TEST(ProxyJoints, TwoJointsLeaveOnlyWhatBothAllow) {
  // An axis and a plane across it leave the turn about the axis.
  ProxyWalk walk = cubeOverFloor(0.5);
  const RigidTransform start = walk.pose();
  walk.setJoints(jointSetOf({keptAt(JointKind::OnAxis, start, glm::dvec3(0.0), kZ),
                             keptAt(JointKind::InPlane, start, start.translation, -kZ)},
                            start));
  for (int i = 0; i < 200; ++i) {
    walk.lead({glm::angleAxis(0.2, kX) * glm::angleAxis(0.01 * i, kZ), {0.1, 0.2, 0.3}});
    ASSERT_LT(offJoints(walk), kOff) << i;
    ASSERT_LT(glm::distance(walk.pose().translation, start.translation), kOff) << i;
  }
  EXPECT_NEAR(rotationVector(walk.pose().rotation).z, 1.99, 0.05);
}

TEST(ProxyJoints, FrictionActsOnlyWithWhatTheJointDoesNotCarry) {
  // Pressed down, the cube hangs on an axis along x a little over the floor: nothing loads the floor.
  ProxyWalk walk = cubeOverFloor(1.2 * kMargin, 0.8);
  keep(walk, JointKind::OnAxis, walk.pose().translation, kX);
  for (int i = 0; i < 100; ++i) {
    walk.lead(at({0.0005 * i, 0.0, -0.1}));
    ASSERT_LT(offJoints(walk), kOff) << i;
  }
  EXPECT_NEAR(walk.pose().translation.x, 0.0005 * 99, 1e-6);
  // In a plane across y the floor carries it, and friction holds it within its cone.
  ProxyWalk held = cubeOverFloor(0.01, 0.8);
  keep(held, JointKind::InPlane, held.pose().translation, kY);
  held.hold(at({0.0, 0.0, 0.05}), 60);
  held.hold(at({0.01, 0.02, 0.05}), 60);
  EXPECT_LT(offJoints(held), kOff);
  EXPECT_NEAR(held.pose().translation.x, 0.0, 1e-4);
}

TEST(ProxyJoints, RandomHandsOnRandomJointsNeverMeetJaggedBodies) {
  const TriangleMesh a = test::starMesh(31, 0.5, 3, 0.3), b = test::starMesh(32, 0.4, 3, 0.3);
  const TriangleMesh part = test::starMesh(33, 0.3, 3, 0.3);
  const RigidTransform worldFromB = at({0.8, 0.0, 0.1}), start = at({0.4, 0.9, 0.0});
  const test::PoseCertifier withA(a, part), withB(b, part);
  RandomValues random(29);
  std::vector<RigidTransform> poses, inB;
  std::size_t touched = 0;
  const std::size_t ticks = 400 / test::kTrialShare;
  for (int trial = 0; trial < 12; ++trial) {
    ProxyWalk walk({{a, {}}, {b, worldFromB}}, part, start, {kMargin, trial % 3 == 2 ? 0.4 : 0.0});
    std::vector<JointSet::Placed> placed;
    for (int i = 0; i <= trial % 2; ++i) {
      const auto kind = static_cast<JointKind>((trial + i) % 3);
      placed.push_back(keptAt(kind, start, start.translation + random.vector(0.3), random.vector(1.0)));
    }
    walk.setJoints(JointSet(placed, start));
    ASSERT_FALSE(walk.scene().areJointsContradictory) << trial;
    RigidTransform hand;
    for (std::size_t i = 0; i < ticks; ++i) {
      const glm::dvec3 middle(0.4, 0.3, 0.0);
      if (i % 100 == 0) hand = {rotationOf(random.vector(2.0)), middle + random.vector(0.5)};
      walk.lead(hand);
      touched += walk.proxy().contacts().empty() ? 0 : 1;
      poses.push_back(walk.pose());
      inB.push_back(worldFromB.inverse() * walk.pose());
      ASSERT_LT(offJoints(walk), 1e-8) << trial << ", " << i;
    }
  }
  EXPECT_GT(touched, ticks / 10);
  const std::vector<char> meetsA = withA.meetings(poses), meetsB = withB.meetings(inB);
  EXPECT_EQ(std::count(meetsA.begin(), meetsA.end(), 1), 0);
  EXPECT_EQ(std::count(meetsB.begin(), meetsB.end(), 1), 0);
}

TEST(ProxyJoints, RandomHandsOnAJointThatIsOffNeverMeetJaggedBodies) {
  const TriangleMesh a = test::starMesh(31, 0.5, 3, 0.3), part = test::starMesh(33, 0.3, 3, 0.3);
  const test::PoseCertifier withA(a, part);
  RandomValues random(37);
  std::vector<RigidTransform> poses;
  for (int trial = 0; trial < 9; ++trial) {
    ProxyWalk walk({{a, {}}}, part, at({0.0, 1.0, 0.0}), {kMargin, 0.0});
    // Through the middle of the other body: contact and joint contradict each other.
    JointSet::Placed joint = keptAt(static_cast<JointKind>(trial % 3), at(glm::dvec3(0.0)),
                                    random.vector(0.1), random.vector(1.0));
    walk.setJoints(jointSetOf({joint}, walk.pose()));
    RigidTransform hand;
    for (std::size_t i = 0; i < 200 / test::kTrialShare; ++i) {
      if (i % 50 == 0) hand = {rotationOf(random.vector(2.0)), random.vector(0.8)};
      walk.lead(hand);
      poses.push_back(walk.pose());
    }
  }
  const std::vector<char> meets = withA.meetings(poses);
  EXPECT_EQ(std::count(meets.begin(), meets.end(), 1), 0);
}

TEST(ProxyJoints, FollowingAllocatesNothing) {
  ProxyWalk walk = cubeOverFloor(0.05, 0.3);
  keep(walk, JointKind::OnAxis, {0.3, 0.0, 0.0}, glm::normalize(glm::dvec3(0.1, 0.0, 1.0)));
  walk.hold(at({0.0, 0.0, 0.0}), 20);
  test::resetAllocationCount();
  test::startCountingAllocations();
  for (int i = 0; i < 20; ++i)
    walk.proxy().follow(walk.tracked(), at({0.01 * i, 0.0, -0.01 * i}), walk.settings());
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
}

}  // namespace
}  // namespace nearfit::proxy_joints_test
