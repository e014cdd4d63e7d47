#include "core/haptics/passivity_controller.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/haptics/virtual_coupling.h"
#include "tests/support/wall_encounter.h"

namespace nearfit::passivity_controller_test {
namespace {

using test::leaningOn;
using test::meetWall;
using test::wallOf;
using test::WallOutcome;
using test::WallTrial;

constexpr double kPeriod = WallTrial::kPeriod;

TEST(PassivityController, NeverTouchesAWallWithinTheBound) {
  std::mt19937 engine(41);
  std::uniform_real_distribution<> unit(0.0, 1.0);
  for (int run = 0; run < 300; ++run) {
    WallTrial trial;
    trial.damping = 0.2 + 2.0 * unit(engine);
    trial.wall = {unit(engine) * stiffnessBound(trial.damping, 0.0, kPeriod), 0.0, 0};
    trial.mass = 0.02 + 0.5 * unit(engine);
    trial.velocity = 0.5 * unit(engine);
    trial.push = 5.0 * unit(engine);
    EXPECT_EQ(meetWall(trial).paidTicks, 0) << run;
  }
}

TEST(PassivityController, NeverTouchesADampedWallWithinTheBound) {
  std::mt19937 engine(42);
  std::uniform_real_distribution<> unit(0.0, 1.0);
  for (int run = 0; run < 300; ++run) {
    WallTrial trial;
    trial.damping = 0.2 + 2.0 * unit(engine);
    const double damping = kAutomaticDampingShare * trial.damping * unit(engine);
    trial.wall = {unit(engine) * stiffnessBound(trial.damping, damping, kPeriod), damping, 0};
    trial.mass = 0.02 + 0.5 * unit(engine);
    trial.velocity = 0.15 * unit(engine);  // kSlack says how fast.
    trial.push = 5.0 * unit(engine);
    trial.position = -1e-4;
    EXPECT_EQ(meetWall(trial).paidTicks, 0) << run;
  }
}

TEST(PassivityController, DelayedStiffWallGrowsWithoutItAndDecaysWithIt) {
  for (const int delay : {1, 2}) {
    WallTrial trial = wallOf(5000.0, delay);
    const WallOutcome wild = meetWall(trial);
    EXPECT_GT(wild.late, 1.05 * wild.early) << delay;
    trial.isControlled = true;
    const WallOutcome tame = meetWall(trial);
    // Half of the device's damping is left to calm the hand: exp(-b t / 4 m) in 3 s is 0.02.
    EXPECT_LT(tame.late, 0.1 * tame.early) << delay;
    // A few ticks' worth of what a wall of 5 N gives at 0.1 m/s.
    EXPECT_LT(tame.largestDebt, 1e-3) << delay;
    EXPECT_GT(wild.largestDebt, 10.0 * tame.largestDebt) << delay;
    EXPECT_GT(tame.paidTicks, 0) << delay;
  }
}

TEST(PassivityController, StiffWallBeyondTheBoundIsCalmedWithoutDelayToo) {
  WallTrial trial = leaningOn(5000.0, 0.2);
  trial.velocity = 0.01;
  EXPECT_GT(meetWall(trial).late, 10.0 * trial.velocity);
  trial.isControlled = true;
  EXPECT_LT(meetWall(trial).late, 0.5 * trial.velocity);
}

TEST(PassivityController, LightHandOnADelayedStiffWallIsCalmed) {
  WallTrial trial = wallOf(5000.0, 1);
  trial.mass = DeviceLimits{}.leastMass;
  EXPECT_GT(meetWall(trial).late, 0.8);
  trial.isControlled = true;
  EXPECT_LT(meetWall(trial).late, 0.02);
}

TEST(PassivityController, DelayedStiffHingeIsCalmed) {
  WallTrial trial = wallOf(5.0, 2);  // The bound is 2 N m/rad.
  trial.along = test::Along::Torque;
  trial.mass = 1e-4;
  trial.damping = 1e-3;
  trial.position = -0.01;
  trial.velocity = 0.5;
  trial.push = 0.01;
  const WallOutcome wild = meetWall(trial);
  EXPECT_GT(wild.late, 10.0 * trial.velocity);
  trial.isControlled = true;
  const WallOutcome tame = meetWall(trial);
  EXPECT_LT(tame.late, 0.1 * trial.velocity);
  EXPECT_LT(tame.largestDebt, 0.1 * wild.largestDebt);
}

HandInterval interval(const Wrench& held, const glm::dvec3& shift, const glm::dvec3& turn = {}) {
  return {held, shift, turn, kPeriod, {}, {}};
}

TEST(PassivityController, EnergyIsTheWorkOfTheHeldWrench) {
  PassivityController controller;
  const Wrench held{{1, 2, 3}, {0.1, 0.2, 0.3}};
  controller.observe(interval(held, {0.01, 0, 0.02}, {0.1, 0, -0.2}), {}, 0.0);
  // 0.01 + 0.06 + 0.01 - 0.06 = 0.02 J to the hand.
  EXPECT_NEAR(controller.energyToHand(), 0.02, 1e-16);
  controller.observe(interval(held, {-0.01, 0, -0.02}, {-0.1, 0, 0.2}), {}, 0.0);
  EXPECT_NEAR(controller.energyToHand(), 0.0, 1e-16);
}

/// Without damping of its own, so that the account is the work alone.
DeviceLimits bareDevice() {
  DeviceLimits limits;
  limits.damping = limits.rotationalDamping = 0.0;
  return limits;
}

TEST(PassivityController, ReactsOnceWhatIsStoredIsSpentWhateverWasLostBefore) {
  PassivityController controller;
  const Wrench held{{-1, 0, 0}, {}};
  for (int i = 0; i < 1000; ++i)  // The hand gives 10 J, of which 0.04 J are in the spring.
    controller.observe(interval(held, {0.01, 0, 0}), bareDevice(), 0.04);
  for (int i = 0; i < 4; ++i)
    controller.observe(interval(held, {-0.01, 0, 0}), bareDevice(), 0.04);
  EXPECT_EQ(controller.debt(), 0.0);
  controller.observe(interval(held, {-0.01, 0, 0}), bareDevice(), 0.04);
  EXPECT_NEAR(controller.debt(), 0.01 - PassivityController::kSlack, 1e-15);
  EXPECT_NEAR(controller.energyToHand(), -10.0 + 0.05, 1e-9);
}

TEST(PassivityController, DampingPaysTheDebtInOneTickAtTheSameVelocity) {
  PassivityController controller;
  const glm::dvec3 shift(1e-3, 0, 0);  // 1 m/s.
  controller.observe(interval({{2, 0, 0}, {}}, shift), bareDevice(), 0.0);
  const double debt = 2e-3 - PassivityController::kSlack;
  EXPECT_NEAR(controller.debt(), debt, 1e-18);
  const Wrench extra = controller.damping(bareDevice(), kPeriod);
  EXPECT_NEAR(glm::distance(extra.force, {-debt / 1e-3, 0, 0}), 0.0, 1e-12);
  controller.observe(interval(extra, shift), bareDevice(), 0.0);
  EXPECT_NEAR(controller.debt(), 0.0, 1e-15);
}

TEST(PassivityController, DampingIsNeverStrongerThanALightHandBears) {
  PassivityController controller;
  controller.observe(interval({{2, 0, 0}, {}}, {1e-3, 0, 0}), bareDevice(), 0.0);
  controller.observe(interval({}, {1e-5, 1e-5, 0}), bareDevice(), 0.0);  // Slow now: 14 mm/s.
  const double most = 0.5 * DeviceLimits{}.leastMass / kPeriod;
  const glm::dvec3 velocity(0.01, 0.01, 0);
  EXPECT_NEAR(glm::distance(controller.damping(bareDevice(), kPeriod).force, -most * velocity), 0.0, 1e-12);
}

TEST(PassivityController, SlidingIsFreeWhileTheDebtCanBePaidAlongTheForce) {
  PassivityController controller;
  // Slides along y and gets a little along x, which a damper along x can take back.
  controller.observe(interval({{0.5, 0, 0}, {}}, {4e-5, 5e-4, 0}), bareDevice(), 0.0);
  const Wrench extra = controller.damping(bareDevice(), kPeriod);
  EXPECT_LT(extra.force.x, 0.0);
  EXPECT_EQ(extra.force.y, 0.0);
}

TEST(PassivityController, DampingKeepsTheLimitsOfTheDevice) {
  DeviceLimits limits = bareDevice();
  limits.maxForce = 0.5;
  limits.maxTorque = 1e-3;
  PassivityController controller;
  controller.observe(interval({{9, 0, 0}, {9, 0, 0}}, {1e-3, 0, 0}, {1e-3, 0, 0}), limits, 0.0);
  const Wrench extra = controller.damping(limits, kPeriod);
  EXPECT_NEAR(glm::length(extra.force), 0.5, 1e-12);
  EXPECT_LE(glm::length(extra.torque), 1e-3 * (1.0 + 1e-12));
}

TEST(PassivityController, WeightOfThePartIsGravitysToGive) {
  PassivityController controller;
  const glm::dvec3 weight(0, 0, -3.0);
  for (int i = 0; i < 2000; ++i) {  // Lowered by 2 m, then lifted again.
    const glm::dvec3 shift(0, 0, i < 1000 ? -2e-3 : 2e-3);
    controller.observe({{weight, {}}, shift, {}, kPeriod, weight, shift}, bareDevice(), 0.0);
    EXPECT_EQ(controller.debt(), 0.0);
    if (i == 999) {
      EXPECT_NEAR(controller.energyToHand(), 6.0, 1e-9);
    }
  }
  EXPECT_NEAR(controller.energyToHand(), 0.0, 1e-9);
}

TEST(PassivityController, FreeMotionEarnsNothing) {
  PassivityController controller;
  for (int i = 0; i < 1000; ++i)
    controller.observe(interval({}, {1e-3, 0, 0}), {}, 0.0);
  controller.observe(interval({{1, 0, 0}, {}}, {2e-3, 0, 0}), bareDevice(), 0.0);
  EXPECT_NEAR(controller.debt(), 2e-3 - PassivityController::kSlack, 1e-15);
}

TEST(PassivityController, DebtIsForgottenBeyondWhatAHandKeeps) {
  PassivityController controller;
  controller.observe(interval({{1000, 0, 0}, {}}, {1, 0, 0}), bareDevice(), 0.0);
  EXPECT_EQ(controller.debt(), PassivityController::kMaxDebt);
  EXPECT_EQ(controller.energyToHand(), 1000.0);
  controller.reset();
  EXPECT_EQ(controller.debt(), 0.0);
  EXPECT_EQ(controller.energyToHand(), 0.0);
}

TEST(PassivityController, SenselessNumbersLeaveNoTrace) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), most = std::numeric_limits<double>::max();
  PassivityController controller;
  controller.observe(interval({{1, 0, 0}, {}}, {1e-3, 0, 0}), bareDevice(), 0.0);
  const double debt = controller.debt();
  for (const double bad : {nan, std::numeric_limits<double>::infinity(), most}) {
    controller.observe(interval({{bad, 0, 0}, {}}, {2.0, 0, 0}), {}, 0.0);
    controller.observe(interval({{0, 0, 0}, {bad, 0, 0}}, {}, {2.0, 0, 0}), {}, 0.0);
    controller.observe(interval({{1, 0, 0}, {}}, {0, bad, bad}), {}, 0.0);
    controller.observe({{}, {}, {}, kPeriod, {0, 0, bad}, {0, 0, 3.0}}, {}, 0.0);
    EXPECT_EQ(controller.debt(), debt) << bad;
    EXPECT_TRUE(std::isfinite(controller.energyToHand()));
  }
  for (const double period : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(controller.damping({}, period).force, glm::dvec3(0.0));
}

TEST(PassivityController, RandomHistoriesStayFiniteAndWithinTheLimits) {
  std::mt19937 engine(43);
  std::uniform_real_distribution<> exponent(-200.0, 200.0), sign(-1.0, 1.0);
  const auto number = [&] {
    const double size = std::pow(10.0, exponent(engine));
    return std::copysign(size, sign(engine));
  };
  const auto vector = [&] { return glm::dvec3{number(), number(), number()}; };
  PassivityController controller;
  for (int i = 0; i < 20'000; ++i) {
    controller.observe({{vector(), vector()}, vector(), vector(), number(), vector(), vector()}, {},
                       number());
    const Wrench extra = controller.damping({}, kPeriod);
    ASSERT_LE(glm::length(extra.force), 10.0 * (1.0 + 1e-12));
    ASSERT_LE(glm::length(extra.torque), 1.0 * (1.0 + 1e-12));
    ASSERT_TRUE(controller.debt() <= PassivityController::kMaxDebt);
  }
}

}  // namespace
}  // namespace nearfit::passivity_controller_test
