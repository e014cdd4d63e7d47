#include "core/servo/servo_tick.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/servo/scene_tracker.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/servo_fixtures.h"
#include "tests/support/tick_observation.h"

namespace nearfit::servo_tick_test {
namespace {

constexpr double kPeriod = 1e-3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

RigidTransform moved(const glm::dvec3& translation) {
  return {glm::dquat(1.0, 0.0, 0.0, 0.0), translation};
}

void expectNear(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance = 1e-9) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

/// A floor whose top is z = 0, and a cone above it; the tip hangs beside the diagonal of the floor's square.
class ServoTickOnFloor : public testing::Test {
 protected:
  const glm::dvec3 kAside{0.3, 0.1, 0.0};
  const glm::dvec3 kCentre{-0.5, 0.0, 0.75};  ///< In the cone's frame.

  ServoTickOnFloor() {
    parameters_.haptics.mode = HapticMode::Springs;
    parameters_.haptics.springs = {
        .cutoff = 0.1, .stiffness = 50.0, .damping = 0.0, .law = SpringLaw::Linear};
    setLimits(100.0, 100.0);
    scene_.setMoving({PartId{7}, test::tipDownCone(kCentre), moved({5.0, 5.0, 5.0})});
    addFloor(PartId{1}, {});
  }

  /// Of a device that bears any stiffness here.
  void setLimits(double force, double torque) {
    parameters_.limits = {.maxForce = force, .maxTorque = torque, .damping = 1e3, .rotationalDamping = 1e3};
  }
  void addFloor(PartId id, const RigidTransform& worldFromFloor) {
    scene_.bodies.push_back({id, floor_, worldFromFloor});
  }
  /// One tick with the tip at that height above z = 0.
  const ServoSnapshot& tickAt(double height) { return tickAt(moved(kAside + glm::dvec3(0.0, 0.0, height))); }
  const ServoSnapshot& tickAt(const RigidTransform& handle) {
    return tickOf(test::untrackedView(scene_), handle);
  }
  const ServoSnapshot& tickOf(const TrackedScene& tracked, const RigidTransform& handle) {
    tick_.run(tracked, parameters_, {.pose = handle}, kPeriod, *snapshot_);
    return *snapshot_;
  }
  /// The scene with lists for around that pose.
  TrackedScene trackedAt(const RigidTransform& pose) {
    SceneTracker tracker;
    tracker.setScene(test::untrackedView(scene_).scene);
    tracker.update(test::partAt(pose), 1.0);
    TrackedScene tracked;
    tracker.refresh({parameters_.haptics.springs.cutoff}, tracked);
    return tracked;
  }

  const PartGeometryPtr floor_ = test::floorSlab();
  ServoScene scene_;
  ServoParameters parameters_;
  ServoTick tick_;
  const std::unique_ptr<ServoSnapshot> snapshot_ = std::make_unique<ServoSnapshot>();
};

TEST_F(ServoTickOnFloor, TheTipsSpringPushesUpAndTurnsAboutTheCentreOfMass) {
  const ServoSnapshot& s = tickAt(0.04);
  // 50 N/m * (0.1 - 0.04) m; arm from centre to tip is (0.5, 0, -0.75).
  expectNear(s.unclampedWrench.force, {0.0, 0.0, 3.0});
  expectNear(s.unclampedWrench.torque, {0.0, -1.5, 0.0});
  expectNear(s.centre, kAside + kCentre + glm::dvec3(0.0, 0.0, 0.04));
  EXPECT_EQ(s.lmdCount, 1U);
  EXPECT_EQ(s.storedLmds, 1U);
  EXPECT_NEAR(s.distance, 0.04, 1e-12);
  EXPECT_EQ(s.moving, PartId{7});
  EXPECT_EQ(s.lmds[0].other, PartId{1});
  expectNear(s.lmds[0].lmd.scenePoint, kAside);
  expectNear(s.lmds[0].lmd.partPoint, kAside + glm::dvec3(0.0, 0.0, 0.04));
  EXPECT_GT(s.queryTime, 0.0);
  EXPECT_FALSE(s.isTruncated);
  EXPECT_FALSE(s.isClamped);
  EXPECT_EQ(s.fault, ServoFault::None);
}

TEST_F(ServoTickOnFloor, MovingTheWholeWorldMovesTheWrenchWithIt) {
  const RigidTransform world{glm::angleAxis(1.1, glm::normalize(glm::dvec3(1.0, -2.0, 0.5))),
                             {3.0, -4.0, 5.0}};
  scene_.bodies[0].worldFromPart = world;
  const ServoSnapshot& s = tickAt(world * moved(kAside + glm::dvec3(0.0, 0.0, 0.04)));
  expectNear(s.unclampedWrench.force, world.applyToVector({0.0, 0.0, 3.0}));
  expectNear(s.unclampedWrench.torque, world.applyToVector({0.0, -1.5, 0.0}));
  expectNear(s.lmds[0].lmd.scenePoint, world.applyToPoint(kAside));
  expectNear(s.lmds[0].lmd.direction, world.applyToVector({0.0, 0.0, 1.0}));
}

TEST_F(ServoTickOnFloor, NothingIsFeltBeyondTheCutoff) {
  const ServoSnapshot& s = tickAt(0.11);
  EXPECT_EQ(s.lmdCount, 0U);
  EXPECT_EQ(s.distance, kInfinity);
  expectNear(s.unclampedWrench.force, {0.0, 0.0, 0.0}, 0.0);
  EXPECT_EQ(tickAt(moved({1e6, 0.0, 0.0})).lmdCount, 0U);
  EXPECT_EQ(tickAt(moved({1e300, 0.0, 0.0})).fault, ServoFault::None);
}

TEST_F(ServoTickOnFloor, ForcesOfAllBodiesAddUpAndTheLeastDistanceIsTheirs) {
  addFloor(PartId{2}, moved({0.0, 0.0, 0.01}));
  const ServoSnapshot& s = tickAt(0.04);
  expectNear(s.unclampedWrench.force, {0.0, 0.0, 50.0 * (0.06 + 0.07)});
  EXPECT_NEAR(s.distance, 0.03, 1e-12);
  EXPECT_EQ(s.lmdCount, 2U);
  EXPECT_EQ(s.lmds[1].other, PartId{2});
}

TEST_F(ServoTickOnFloor, NothingInHandFeelsNothing) {
  scene_.moving.geometry = nullptr;
  const ServoSnapshot& s = tickAt(0.04);
  EXPECT_EQ(s.lmdCount, 0U);
  EXPECT_EQ(s.fault, ServoFault::None);
  expectNear(s.handle.translation, kAside + glm::dvec3(0.0, 0.0, 0.04));
}

TEST_F(ServoTickOnFloor, ForceAndTorqueRiseToTheirLimitsByLength) {
  setLimits(1.0, 0.25);
  EXPECT_EQ(tickAt(0.04).wrench.force, glm::dvec3(0.0)) << "not at once";
  for (double time = 0.0; time < WrenchConditioner::kRampTime; time += kPeriod)
    tickAt(0.04);
  const ServoSnapshot& s = tickAt(0.04);
  EXPECT_TRUE(s.isClamped);
  expectNear(s.wrench.force, {0.0, 0.0, 1.0});
  expectNear(s.wrench.torque, {0.0, -0.25, 0.0});
  expectNear(s.unclampedWrench.force, {0.0, 0.0, 3.0});
  expectNear(s.unclampedWrench.torque, {0.0, -1.5, 0.0});
}

TEST_F(ServoTickOnFloor, DampingFollowsTheFilteredVelocityOfTheDescent) {
  parameters_.haptics.springs.damping = 10.0;
  constexpr double kSpeed = 0.2;
  // The share of each new velocity is 1 ms / (2 ms + 1 ms): after n steps the filter holds 1 - (2/3)^n of it.
  for (int n = 0; n < 40; ++n) {
    const double height = 0.08 - kSpeed * kPeriod * n;
    const double velocity = kSpeed * (1.0 - std::pow(2.0 / 3.0, n));
    EXPECT_NEAR(tickAt(height).unclampedWrench.force.z, 50.0 * (0.1 - height) + 10.0 * velocity, 1e-9) << n;
  }
}

TEST_F(ServoTickOnFloor, TurningAboutTheCentreMovesTheTip) {
  parameters_.haptics.springs.damping = 10.0;
  constexpr double kRate =
      0.05;  // rad/s about y: the tip, half a metre in x from the centre, sinks by 0.025 m/s.
  const glm::dvec3 centre = kAside + kCentre + glm::dvec3(0.0, 0.0, 0.05);
  double tip = 0.0;
  for (int n = 0; n < 60; ++n) {
    const glm::dquat turn = glm::angleAxis(kRate * kPeriod * n, glm::dvec3(0.0, 1.0, 0.0));
    const RigidTransform pose{turn, centre - turn * kCentre};
    tip = pose.applyToPoint(glm::dvec3(0.0)).z;
    // The sign of a quaternion must not matter.
    tickAt(n % 2 == 0 ? pose : RigidTransform{-pose.rotation, pose.translation});
  }
  EXPECT_NEAR(snapshot_->unclampedWrench.force.z, 50.0 * (0.1 - tip) + 10.0 * 0.5 * kRate, 2e-3);
}

TEST_F(ServoTickOnFloor, AnotherPartInHandHasNoVelocityFromTheLast) {
  parameters_.haptics.springs.damping = 10.0;
  tickAt(0.09);
  scene_.moving.id = PartId{8};
  EXPECT_NEAR(tickAt(0.04).unclampedWrench.force.z, 3.0, 1e-9);
}

TEST_F(ServoTickOnFloor, TheHandlesQuaternionIsScaledToUnitLength) {
  RigidTransform handle = moved(kAside + glm::dvec3(0.0, 0.0, 0.04));
  handle.rotation = handle.rotation * 1.01;
  const ServoSnapshot& s = tickAt(handle);
  EXPECT_EQ(s.proxy.rotation.w, 1.0);
  expectNear(s.unclampedWrench.force, {0.0, 0.0, 3.0});
}

TEST_F(ServoTickOnFloor, ABadPoseStopsForceAndPartUntilReset) {
  for (const RigidTransform& bad : {moved({kNan, 0.0, 0.0}), moved({0.0, kInfinity, 0.0}),
                                    RigidTransform{glm::dquat(kNan, 0.0, 0.0, 0.0), {}},
                                    RigidTransform{glm::dquat(0.0, 0.0, 0.0, 0.0), {}}}) {
    tick_.reset();
    EXPECT_GT(tickAt(0.04).unclampedWrench.force.z, 0.0);
    for (int i = 0; i < 3; ++i) {
      const ServoSnapshot& s = i == 0 ? tickAt(bad) : tickAt(0.02);
      EXPECT_EQ(s.fault, ServoFault::PoseNotFinite) << "latched";
      expectNear(s.unclampedWrench.force, {0.0, 0.0, 0.0}, 0.0);
      expectNear(s.unclampedWrench.torque, {0.0, 0.0, 0.0}, 0.0);
      EXPECT_EQ(s.lmdCount, 0U);
      EXPECT_NEAR(s.proxy.translation.z, 0.04, 1e-12) << "stays where it was";
    }
    tick_.reset();
    EXPECT_EQ(tickAt(0.04).fault, ServoFault::None);
  }
}

TEST_F(ServoTickOnFloor, ABadFirstPoseLeavesThePartWhereTheSceneHasIt) {
  const ServoSnapshot& s = tickAt(moved({kNan, 0.0, 0.0}));
  EXPECT_EQ(s.fault, ServoFault::PoseNotFinite);
  expectNear(s.proxy.translation, {5.0, 5.0, 5.0}, 0.0);
}

TEST_F(ServoTickOnFloor, ABadPoseOfAnotherBodyIsAFaultToo) {
  scene_.bodies[0].worldFromPart.translation.x = kNan;
  EXPECT_EQ(tickAt(0.04).fault, ServoFault::PoseNotFinite);
  expectNear(snapshot_->wrench.force, {0.0, 0.0, 0.0}, 0.0);
}

TEST_F(ServoTickOnFloor, SenselessParametersAreAFault) {
  const ServoParameters good = parameters_;
  const auto faultWith = [&](auto&& spoil) {
    parameters_ = good;
    spoil(parameters_);
    tick_.reset();
    const ServoFault fault = tickAt(0.04).fault;
    EXPECT_EQ(snapshot_->wrench.force, glm::dvec3(0.0));
    return fault;
  };
  for (const double bad : {kNan, kInfinity, -1.0}) {
    EXPECT_EQ(faultWith([&](ServoParameters& p) { p.haptics.springs.cutoff = bad; }),
              ServoFault::ParametersInvalid);
    EXPECT_EQ(faultWith([&](ServoParameters& p) { p.haptics.springs.stiffness = bad; }),
              ServoFault::ParametersInvalid);
    EXPECT_EQ(faultWith([&](ServoParameters& p) { p.haptics.springs.damping = bad; }),
              ServoFault::ParametersInvalid);
    EXPECT_EQ(faultWith([&](ServoParameters& p) { p.limits.maxForce = bad; }), ServoFault::ParametersInvalid);
    EXPECT_EQ(faultWith([&](ServoParameters& p) { p.limits.maxTorque = bad; }),
              ServoFault::ParametersInvalid);
  }
  EXPECT_EQ(faultWith([](ServoParameters& p) { p.haptics.springs.cutoff = 0.0; }),
            ServoFault::ParametersInvalid);
  for (const double badPeriod : {0.0, -1e-3, kNan}) {
    ServoTick tick;
    tick.run(test::untrackedView(scene_), good, {.pose = moved({0.0, 0.0, 1.0})}, badPeriod, *snapshot_);
    EXPECT_EQ(snapshot_->fault, ServoFault::ParametersInvalid);
  }
}

TEST_F(ServoTickOnFloor, AnOverflowingForceIsAFaultAndSendsNothing) {
  // Times a compression of almost ten metres.
  parameters_.haptics.springs.cutoff = 10.0;
  parameters_.haptics.springs.stiffness = 1e308;
  parameters_.haptics.springs.damping = 1e308;
  tickAt(0.09);
  const ServoSnapshot& s = tickAt(0.01);
  EXPECT_EQ(s.fault, ServoFault::WrenchNotFinite);
  expectNear(s.unclampedWrench.force, {0.0, 0.0, 0.0}, 0.0);
  parameters_.haptics.springs = {};
  EXPECT_EQ(tickAt(0.04).fault, ServoFault::WrenchNotFinite) << "latched";
}

TEST_F(ServoTickOnFloor, SpringsStifferThanTheDeviceBearsAreHeldToIt) {
  parameters_.limits = {100.0, 100.0};
  parameters_.haptics.springs.stiffness = 1e4;
  const ServoSnapshot& s = tickAt(0.04);
  EXPECT_EQ(s.areaCount, 1U);
  // At 1 kHz 1 N s/m bears 2000 N/m, and 1e-3 N m s/rad 2 N m/rad, where the lever of half a metre has 1e4 / 4.
  const double share = 1.0 / (1e4 / 2000.0 + 2500.0 / 2.0);
  EXPECT_NEAR(s.springShares.wrench, share, 1e-9);
  EXPECT_NEAR(s.unclampedWrench.force.z, share * 1e4 * 0.06, 1e-6);
  EXPECT_NEAR(s.unclampedWrench.torque.y, -share * 1e4 * 0.06 * 0.5, 1e-6);
  // Softer ones are felt in full again, after a while.
  parameters_.haptics.springs.stiffness = 1.0;
  EXPECT_LT(tickAt(0.04).springShares.wrench, 0.2);
  for (double time = 0.0; time < 20.0 * kShareRiseTime; time += kPeriod)
    tickAt(0.04);
  EXPECT_EQ(tickAt(0.04).springShares, SpringShares{});
  EXPECT_NEAR(snapshot_->unclampedWrench.force.z, 0.06, 1e-9);
}

TEST(ServoFaultReason, EveryFaultHasOne) {
  EXPECT_STREQ(faultReason(ServoFault::None), "");
  for (const ServoFault fault :
       {ServoFault::PoseNotFinite, ServoFault::WrenchNotFinite, ServoFault::ParametersInvalid}) {
    EXPECT_GT(std::string(faultReason(fault)).size(), 20U);
  }
}

TEST_F(ServoTickOnFloor, OfTooManyMinimaTheNearestAreShownGroupedByPartAndAllAreFelt) {
  constexpr std::uint32_t kFloors = 1300;
  scene_.bodies.clear();
  // The farthest floor first, each 10 um above the one before.
  for (std::uint32_t i = 0; i < kFloors; ++i)
    addFloor(PartId{100 + i}, moved({0.0, 0.0, 1e-5 * i}));
  setLimits(1e6, 1e6);
  const double height = 0.05;
  const RigidTransform pose = moved(kAside + glm::dvec3(0.0, 0.0, height));
  const ServoSnapshot& s = tickOf(trackedAt(pose), pose);
  double expectedForce = 0.0;
  for (std::uint32_t i = 0; i < kFloors; ++i)
    expectedForce += 50.0 * (0.1 - (height - 1e-5 * i));
  EXPECT_NEAR(s.unclampedWrench.force.z, expectedForce, 1e-6);
  EXPECT_EQ(s.lateBodies, 0U);
  EXPECT_EQ(s.lmdCount, kFloors);
  ASSERT_EQ(s.storedLmds, ServoSnapshot::kMaxLmds);
  for (std::uint32_t k = 0; k < s.storedLmds; ++k) {
    EXPECT_EQ(s.lmds[k].other,
              PartId{100 + kFloors - static_cast<std::uint32_t>(ServoSnapshot::kMaxLmds) + k});
  }
}

TEST_F(ServoTickOnFloor, TheSamePosesGiveTheSameWrenchToTheLastBit) {
  parameters_.haptics.springs.damping = 3.0;
  ServoTick other;
  const auto second = std::make_unique<ServoSnapshot>();
  for (int n = 0; n < 50; ++n) {
    const RigidTransform pose = moved(kAside + glm::dvec3(0.0, 0.0, 0.05 + 0.03 * std::sin(0.3 * n)));
    tickAt(pose);
    other.run(test::untrackedView(scene_), parameters_, {.pose = pose}, kPeriod, *second);
    EXPECT_EQ(snapshot_->wrench.force, second->wrench.force);
    EXPECT_EQ(snapshot_->wrench.torque, second->wrench.torque);
  }
}

TEST_F(ServoTickOnFloor, ATickAllocatesNothing) {
  for (std::uint32_t i = 0; i < 700; ++i)
    addFloor(PartId{100 + i}, moved({0.0, 0.0, -1e-5 * i}));
  const auto tip = [this](double height) { return moved(kAside + glm::dvec3(0.0, 0.0, height)); };
  const TrackedScene untracked = test::untrackedView(scene_), tracked = trackedAt(tip(0.04));
  std::uint32_t lateTicks = 0, listedTicks = 0;
  test::resetAllocationCount();
  test::startCountingAllocations();
  for (int n = 0; n < 20; ++n) {
    lateTicks += tickOf(untracked, tip(0.03 + 0.001 * n)).lateBodies > 0 ? 1 : 0;
    listedTicks += tickOf(tracked, tip(0.03 + 0.001 * n)).lateBodies == 0 ? 1 : 0;
  }
  tickOf(tracked, moved({kNan, 0.0, 0.0}));
  tick_.reset();
  tickOf(tracked, tip(0.04));
  test::stopCountingAllocations();
  EXPECT_EQ(lateTicks, 20U);
  EXPECT_GT(listedTicks, 0U);
  EXPECT_EQ(test::countedAllocations(), 0U);
}

TEST(AllocationHook, SeesWhatAThreadAllocates) {
  test::resetAllocationCount();
  test::startCountingAllocations();
  std::make_unique<std::array<int, 100>>()->fill(1);
  test::stopCountingAllocations();
  EXPECT_GE(test::countedAllocations(), 2U) << "one request, one release";
}

}  // namespace
}  // namespace nearfit::servo_tick_test
