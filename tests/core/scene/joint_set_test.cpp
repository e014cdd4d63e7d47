#include "core/scene/joint_set.h"

#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/joint_sets.h"
#include "tests/support/trial_share.h"

namespace nearfit::joint_set_test {
namespace {

using test::jointSetOf;
using test::keptAt;
using test::RandomValues;
using Placed = JointSet::Placed;

constexpr double kTight = 1e-12;
const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

RigidTransform turned(double angle, const glm::dvec3& axis, const glm::dvec3& translation = glm::dvec3(0.0)) {
  return {glm::angleAxis(angle, glm::normalize(axis)), translation};
}

void expectNear(const RigidTransform& a, const RigidTransform& b, double tolerance) {
  EXPECT_LT(glm::distance(a.translation, b.translation), tolerance);
  EXPECT_LT(1.0 - std::abs(glm::dot(a.rotation, b.rotation)), tolerance);
}

void expectOn(const JointSet& joints, const RigidTransform& pose, double tolerance = kTight) {
  const JointResidual left = joints.residual(pose);
  EXPECT_LT(left.distance, tolerance);
  EXPECT_LT(left.angle, tolerance);
}

TEST(JointSet, NoJointsLeaveAPoseAsItIsAndLockNothing) {
  const JointSet none;
  const RigidTransform pose = turned(0.3, kX, {1, 2, 3});
  EXPECT_TRUE(none.isEmpty());
  EXPECT_EQ(none.nearestPose(pose, glm::dvec3(0.0)).translation, pose.translation);
  EXPECT_TRUE(none.lockedMotions(pose, glm::dvec3(0.0), {}).isEmpty());
  EXPECT_EQ(none.freeShift(kX), kX);
}

TEST(JointSet, OnAxisTakesBackTheTiltAndTheShiftAsideAndKeepsTheRest) {
  // The part's z axis through its origin stays on the world's.
  const JointSet joints = jointSetOf({keptAt(JointKind::OnAxis, {}, glm::dvec3(0.0), kZ)}, {});
  // The centre lies 0.3 up the axis, which is the point that the part turns about.
  const glm::dvec3 centre(0.0, 0.0, 0.3);
  const glm::dquat tilt = glm::angleAxis(0.4, kX), spin = glm::angleAxis(0.7, kZ);
  const RigidTransform pose{tilt * spin, {0.1, 0.2, 0.5}};
  const double height = pose.applyToPoint(centre).z - 0.3;
  expectNear(joints.nearestPose(pose, centre), {spin, {0.0, 0.0, height}}, kTight);
}

TEST(JointSet, AnAxisKeepsTheSenseThatThePartHasNow) {
  const Placed joint = keptAt(JointKind::OnAxis, {}, glm::dvec3(0.0), kZ);
  const RigidTransform over = turned(std::numbers::pi, kX);
  const RigidTransform nearlyOver = turned(0.8 * std::numbers::pi, kX);
  expectNear(jointSetOf({joint}, over).nearestPose(nearlyOver, glm::dvec3(0.0)), over, kTight);
  expectNear(jointSetOf({joint}, {}).nearestPose(nearlyOver, glm::dvec3(0.0)), {}, kTight);
}

TEST(JointSet, InPlanePutsTheFaceFlushWithTheLeastTurn) {
  // The part's bottom, 0.1 under its centre, lies on the floor.
  const JointSet joints =
      jointSetOf({keptAt(JointKind::InPlane, turned(0.0, kX, {0, 0, 0.1}), glm::dvec3(0.0), -kZ)}, {});
  const RigidTransform pose = turned(0.2, kY, {1.0, 2.0, 0.5});
  // The point under the centre stays over its place.
  expectNear(joints.nearestPose(pose, glm::dvec3(0.0)), {{1, 0, 0, 0}, {1.0 - 0.1 * std::sin(0.2), 2.0, 0.1}},
             kTight);
  const RigidTransform spun = turned(0.7, kZ, {1.0, 2.0, 0.5});
  expectNear(joints.nearestPose(spun, glm::dvec3(0.0)), turned(0.7, kZ, {1.0, 2.0, 0.1}), kTight);
}

TEST(JointSet, ToPointShiftsWithoutATurn) {
  const JointSet joints = jointSetOf({keptAt(JointKind::ToPoint, {}, {0.1, 0.0, 0.0})}, {});
  const RigidTransform pose = turned(0.5, {1, 2, 3}, {0.4, 0.5, 0.6});
  const RigidTransform nearest = joints.nearestPose(pose, glm::dvec3(0.0));
  EXPECT_EQ(nearest.rotation, pose.rotation);
  EXPECT_LT(glm::distance(nearest.translation, kX * 0.1 - pose.rotation * (kX * 0.1)), kTight);
}

TEST(JointSet, HalfATurnOffTheAxisIsTakenBackToo) {
  const JointSet joints = jointSetOf({keptAt(JointKind::OnAxis, {}, glm::dvec3(0.0), kZ)}, {});
  for (const double angle : {3.1, std::numbers::pi - 1e-9, std::numbers::pi, 3.2})
    expectOn(joints, joints.nearestPose(turned(angle, {1, 1, 0}, {1, 2, 3}), {0.0, 0.1, 0.0}));
}

TEST(JointSet, APoseOnTheJointsStaysToTheLastBit) {
  RandomValues random(3);
  for (int i = 0; i < 200; ++i) {
    const RigidTransform start = random.pose();
    const glm::dvec3 centre = random.vector(0.1);
    const MassMetric metric{{1, 0, 0, 0}, {0.05, 0.08, 0.1}, 0.2};
    const auto kind = static_cast<JointKind>(i % 3);
    const JointSet joints =
        jointSetOf({keptAt(kind, start, random.vector(0.3), kX + random.vector(0.5))}, start);
    const RigidTransform plain = joints.nearestPose(random.pose(), centre);
    EXPECT_EQ(joints.nearestPose(plain, centre).translation, plain.translation);
    EXPECT_EQ(joints.nearestPose(plain, centre).rotation, plain.rotation);
    const RigidTransform weighed = joints.nearestPose(random.pose(), centre, metric);
    EXPECT_EQ(joints.nearestPose(weighed, centre, metric).translation, weighed.translation);
    EXPECT_EQ(joints.nearestPose(weighed, centre, metric).rotation, weighed.rotation);
  }
}

/// Poses on a joint by its free amounts: along or across it [m], and turns [rad]. Shares nothing with JointSet.
RigidTransform poseOn(const Placed& joint, const RigidTransform& onJoint, const std::array<double, 3>& free) {
  const glm::dvec3& t = joint.target;
  const glm::dvec3 aside = glm::normalize(glm::cross(t, std::abs(t.x) < 0.9 ? kX : kY));
  glm::dquat turn = glm::angleAxis(free[2], t);
  glm::dvec3 shift(0.0);
  switch (joint.kind) {
    case JointKind::OnAxis:
      shift = free[0] * t;
      break;
    case JointKind::InPlane:
      shift = free[0] * aside + free[1] * glm::cross(t, aside);
      break;
    case JointKind::ToPoint:
      turn = rotationOf({free[0], free[1], free[2]});
      break;
  }
  const glm::dvec3 pivot = onJoint.applyToPoint(joint.onPart.point);
  return {glm::normalize(turn * onJoint.rotation), turn * (onJoint.translation - pivot) + pivot + shift};
}

/// Least energy on the joint that a random descent finds from many starts.
double leastEnergy(RandomValues& random, const std::function<double(const std::array<double, 3>&)>& energy) {
  double best = 1e9;
  for (int start = 0; start < 30; ++start) {
    std::array<double, 3> at{random.in(-0.4, 0.4), random.in(-0.4, 0.4), random.in(-3.0, 3.0)};
    double here = energy(at);
    for (double size = 0.5; size > 1e-7;) {
      const std::array<double, 3> next{at[0] + random.in(-size, size), at[1] + random.in(-size, size),
                                       at[2] + random.in(-size, size)};
      const double there = energy(next);
      size *= there < here ? 1.5 : 0.93;
      if (there >= here) continue;
      at = next;
      here = there;
    }
    best = std::min(best, here);
  }
  return best;
}

TEST(JointSet, TheNearestPoseHasTheLeastEnergyOfAllOnTheJoint) {
  RandomValues random(7);
  for (int i = 0; i < 60 / static_cast<int>(test::kTrialShare); ++i) {
    const RigidTransform start = random.pose();
    const MassMetric metric{glm::normalize(rotationOf(random.vector(2.0))), {0.04, 0.07, 0.1}, 0.2};
    const glm::dvec3 centre = random.vector(0.05);
    const Placed joint = keptAt(static_cast<JointKind>(i % 3), start, start.translation + random.vector(0.2),
                                kX + random.vector(0.5));
    const JointSet joints = jointSetOf({joint}, start);
    // As far off as a hand may pull, and turned by up to half a radian.
    const RigidTransform wanted{glm::normalize(rotationOf(random.vector(0.3)) * start.rotation),
                                start.translation + random.vector(0.05)};
    const RigidTransform nearest = joints.nearestPose(wanted, centre, metric);
    expectOn(joints, nearest);
    const double oracle = leastEnergy(random, [&](const std::array<double, 3>& free) {
      return test::energyOf(poseOn(joint, start, free), wanted, centre, metric);
    });
    EXPECT_LT(test::energyOf(nearest, wanted, centre, metric), oracle * (1.0 + 1e-4) + 1e-12) << i;
  }
}

TEST(JointSet, SeveralJointsHoldTogetherWhereverThePartIs) {
  RandomValues random(11);
  using enum JointKind;
  const std::vector<std::vector<JointKind>> sets = {
      {OnAxis, InPlane},           {InPlane, InPlane},          {OnAxis, OnAxis},          {ToPoint, ToPoint},
      {InPlane, InPlane, InPlane}, {ToPoint, ToPoint, ToPoint}, {OnAxis, ToPoint, InPlane}};
  int told = 0, loose = 0, all = 0;
  for (const std::vector<JointKind>& kinds : sets) {
    for (int i = 0; i < 40; ++i, ++all) {
      const RigidTransform held = random.pose();
      std::vector<Placed> placed;
      for (const JointKind kind : kinds)
        placed.push_back(keptAt(kind, held, held.translation + random.vector(0.2), kX + random.vector(1.0)));
      // The sense of axes is that of the start, which is near.
      const RigidTransform start{glm::normalize(rotationOf(random.vector(0.2)) * held.rotation),
                                 held.translation + random.vector(0.1)};
      const JointSet joints(placed, start);
      told += joints.isContradictory() ? 1 : 0;
      if (joints.isContradictory()) continue;
      const RigidTransform wanted = random.pose();
      const glm::dvec3 centre(0.02, 0.0, 0.0);
      const MassMetric metric{{1, 0, 0, 0}, {0.05, 0.07, 0.1}, 0.2};
      for (const RigidTransform& nearest :
           {joints.nearestPose(wanted, centre), joints.nearestPose(wanted, centre, metric)}) {
        expectOn(joints, nearest, JointSet::kMaxMisfit);
        loose += joints.residual(nearest).distance > 1e-8 ? 1 : 0;
      }
    }
  }
  // A row of which less than a thousandth is independent counts as dependent; about one in a thousand is.
  EXPECT_LE(told, all / 100);
  EXPECT_LE(loose, all / 50);
}

TEST(JointSet, ThreePointsHoldThePartInOnePose) {
  RandomValues random(13);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform held = random.pose();
    std::vector<Placed> placed;
    for (const glm::dvec3& corner : {kX, kY, kZ})
      placed.push_back(keptAt(JointKind::ToPoint, held, held.applyToPoint(0.1 * corner)));
    const JointSet joints(placed, random.pose());
    ASSERT_FALSE(joints.isContradictory()) << i;
    expectNear(joints.nearestPose(random.pose(), glm::dvec3(0.0)), held, 1e-8);
    EXPECT_EQ(joints.lockedMotions(held, glm::dvec3(0.0), {}).directions().size(), 6U);
  }
}

TEST(JointSet, JointsThatContradictEachOtherAreToldAndHoldNothing) {
  // Two points 0.1 apart cannot be 0.2 apart.
  Placed far = keptAt(JointKind::ToPoint, {}, {0.1, 0.0, 0.0});
  far.place.x = 0.2;
  const JointSet joints = jointSetOf({keptAt(JointKind::ToPoint, {}, glm::dvec3(0.0)), far}, {});
  EXPECT_TRUE(joints.isContradictory());
  const RigidTransform pose = turned(0.3, kX, {1, 2, 3});
  EXPECT_EQ(joints.nearestPose(pose, glm::dvec3(0.0)).translation, pose.translation);
  EXPECT_TRUE(joints.lockedMotions(pose, glm::dvec3(0.0), {}).isEmpty());
  EXPECT_EQ(joints.freeShift(kX), kX);
  // The second is 0.1 off at the first.
  EXPECT_NEAR(joints.residual({}).distance, 0.1, kTight);
}

TEST(JointSet, FeaturesThatFitToAMicrometreDoNotContradictEachOther) {
  Placed second = keptAt(JointKind::OnAxis, {}, {0.1, 0.0, 0.0}, kZ);
  second.place.x += 1e-6;
  second.onPart.direction = glm::normalize(glm::dvec3(1e-6, 0.0, 1.0));
  const JointSet joints = jointSetOf({keptAt(JointKind::OnAxis, {}, glm::dvec3(0.0), kZ), second}, {});
  ASSERT_FALSE(joints.isContradictory());
  const RigidTransform nearest =
      joints.nearestPose(turned(0.1, {1, 2, 3}, {0.01, 0.02, 0.03}), {0.05, 0.0, 0.0});
  // The older one holds exactly.
  EXPECT_LT(glm::length(glm::dvec2(nearest.translation)), 1e-9);
  EXPECT_LT(glm::length((nearest.rotation * kZ) - kZ), 1e-9);
  EXPECT_LT(joints.residual(nearest).distance, 2e-6);
}

TEST(JointSet, LocksAsManyMotionsAsTheJointsTakeAway) {
  const Placed axis = keptAt(JointKind::OnAxis, {}, glm::dvec3(0.0), kZ);
  const Placed floor = keptAt(JointKind::InPlane, {}, glm::dvec3(0.0), -kZ);
  const Placed wall = keptAt(JointKind::InPlane, {}, glm::dvec3(0.0), kX);
  const Placed point = keptAt(JointKind::ToPoint, {}, {0.1, 0.0, 0.0});
  const auto count = [](std::initializer_list<Placed> placed) {
    const JointSet joints = jointSetOf(placed, {});
    return joints.lockedMotions({}, {0.01, 0.02, 0.03}, {}).directions().size();
  };
  EXPECT_EQ(count({axis}), 4U);
  EXPECT_EQ(count({floor}), 3U);
  EXPECT_EQ(count({point}), 3U);
  EXPECT_EQ(count({axis, floor}), 5U);
  EXPECT_EQ(count({floor, wall}), 5U);
  EXPECT_EQ(count({axis, axis}), 4U);
  EXPECT_EQ(count({axis, floor, point}), 6U);
}

TEST(JointSet, LockedMotionsAreOrthonormalAndTheCorrectionLeadsBackToFirstOrder) {
  RandomValues random(17);
  for (int i = 0; i < 100; ++i) {
    const RigidTransform held = random.pose();
    const JointSet joints =
        jointSetOf({keptAt(JointKind::OnAxis, held, random.vector(0.2), kX + random.vector(0.5)),
                    keptAt(JointKind::ToPoint, held, random.vector(0.2))},
                   held);
    const MassMetric metric{glm::normalize(rotationOf(random.vector(2.0))), {0.05, 0.07, 0.1}, 0.2};
    const glm::dvec3 centre = random.vector(0.05);
    constexpr double kOff = 1e-5;
    const RigidTransform off{glm::normalize(rotationOf(random.vector(kOff)) * held.rotation),
                             held.translation + random.vector(kOff)};
    const LockedMotions locked = joints.lockedMotions(off, centre, metric);
    for (std::size_t a = 0; a < locked.directions().size(); ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        double product = 0.0;
        for (std::size_t k = 0; k < 6; ++k)
          product += locked.directions()[a][k] * locked.directions()[b][k];
        EXPECT_NEAR(product, a == b ? 1.0 : 0.0, 1e-14);
      }
    }
    const StepVector& y = locked.correction();
    const glm::dquat worldFromPrincipal = off.rotation * metric.partFromPrincipal;
    const glm::dvec3 turn = worldFromPrincipal * (glm::dvec3(y[3], y[4], y[5]) / metric.gyration);
    const glm::dquat rotation = glm::normalize(rotationOf(turn) * off.rotation);
    const RigidTransform back{rotation,
                              off.applyToPoint(centre) + glm::dvec3(y[0], y[1], y[2]) - rotation * centre};
    expectOn(joints, back, 100.0 * kOff * kOff);
    for (const double value : locked.freePart(y))
      EXPECT_NEAR(value, 0.0, 1e-15);
  }
}

TEST(JointSet, FreeShiftIsWhatTheJointsLeaveOfATranslation) {
  const Placed axis = keptAt(JointKind::OnAxis, {}, glm::dvec3(0.0), kZ);
  const Placed wall = keptAt(JointKind::InPlane, {}, glm::dvec3(0.0), kX);
  const Placed point = keptAt(JointKind::ToPoint, {}, glm::dvec3(0.0));
  const glm::dvec3 shift(1.0, 2.0, 3.0);
  EXPECT_LT(glm::distance(jointSetOf({axis}, {}).freeShift(shift), {0, 0, 3}), kTight);
  EXPECT_LT(glm::distance(jointSetOf({wall}, {}).freeShift(shift), {0, 2, 3}), kTight);
  EXPECT_LT(glm::length(jointSetOf({point}, {}).freeShift(shift)), kTight);
}

TEST(JointSet, OfASceneHasThePartsJointsThatAreOnWhereTheirBasesStand) {
  Scene scene;
  Part part;
  part.name = "Peg";
  const PartId peg = scene.add(part);
  part.name = "Hole";
  part.worldFromPart = turned(0.5 * std::numbers::pi, kY, {1.0, 0.0, 0.0});
  const PartId hole = scene.add(part);
  Joint joint;
  joint.part = peg;
  joint.base = hole;
  scene.addJoint(joint);
  joint.isOn = false;
  scene.addJoint(joint);
  joint.isOn = true;
  joint.part = hole;
  joint.base = peg;
  scene.addJoint(joint);
  const JointSet joints = jointsOf(scene, peg);
  EXPECT_EQ(joints.size(), 1U);
  // The hole's axis, its z, lies along the world's x now.
  const RigidTransform nearest = joints.nearestPose({{1, 0, 0, 0}, {0.3, 0.4, 0.5}}, glm::dvec3(0.0));
  EXPECT_LT(glm::distance(nearest.translation, {0.3, 0.0, 0.0}), kTight);
  EXPECT_LT(glm::distance(nearest.rotation * kZ, kX), kTight);
  EXPECT_THROW(jointsOf(scene, PartId{99}), UsageError);
}

TEST(JointSet, FacesOfASceneAreKeptFaceToFace) {
  Scene scene;
  Part part;
  part.name = "Box";
  Joint joint;
  joint.kind = JointKind::InPlane;
  joint.part = scene.add(part);
  joint.onPart = {{0.0, 0.0, -0.1}, -kZ};
  joint.onBase = {{0.0, 0.0, 1.0}, kZ};
  scene.addJoint(joint);
  const RigidTransform nearest =
      jointsOf(scene, joint.part).nearestPose(turned(0.1, kX, {5.0, 6.0, 7.0}), glm::dvec3(0.0));
  EXPECT_NEAR(nearest.translation.z, 1.1, kTight);
  EXPECT_LT(glm::distance(nearest.rotation * kZ, kZ), kTight);
}

TEST(JointSet, NothingIsAllocatedByASearch) {
  RandomValues random(19);
  const RigidTransform held = random.pose();
  const JointSet joints = jointSetOf({keptAt(JointKind::OnAxis, held, random.vector(0.2), kX),
                                      keptAt(JointKind::ToPoint, held, random.vector(0.2))},
                                     held);
  const MassMetric metric{{1, 0, 0, 0}, {0.05, 0.07, 0.1}, 0.2};
  test::resetAllocationCount();
  test::startCountingAllocations();
  for (int i = 0; i < 20; ++i)
    joints.nearestPose(random.pose(), glm::dvec3(0.0), metric);
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
}

}  // namespace
}  // namespace nearfit::joint_set_test
