#include "core/haptics/wrench_conditioner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace nearfit::wrench_conditioner_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(LimitWrench, AWrenchWithinTheLimitsIsLeftAlone) {
  const LimitedWrench r = limitWrench({{3.0, 4.0, 0.0}, {0.0, 0.6, 0.8}}, {5.0, 1.0});
  EXPECT_FALSE(r.isClamped);
  EXPECT_EQ(r.wrench.force, glm::dvec3(3.0, 4.0, 0.0));
  EXPECT_EQ(r.wrench.torque, glm::dvec3(0.0, 0.6, 0.8));
}

TEST(LimitWrench, ForceAndTorqueAreEachScaledToTheirLengthLimit) {
  // |(30, 40, 0)| = 50 to 5; |(0, 0.6, 0.8)| = 1 to 0.5.
  const LimitedWrench r = limitWrench({{30.0, 40.0, 0.0}, {0.0, 0.6, 0.8}}, {5.0, 0.5});
  EXPECT_TRUE(r.isClamped);
  EXPECT_DOUBLE_EQ(r.wrench.force.x, 3.0);
  EXPECT_DOUBLE_EQ(r.wrench.force.y, 4.0);
  EXPECT_DOUBLE_EQ(r.wrench.torque.y, 0.3);
  EXPECT_DOUBLE_EQ(r.wrench.torque.z, 0.4);
}

TEST(LimitWrench, ALargeForceLeavesASmallTorqueAlone) {
  const LimitedWrench r = limitWrench({{100.0, 0.0, 0.0}, {0.0, 0.1, 0.0}}, {5.0, 0.5});
  EXPECT_TRUE(r.isClamped);
  EXPECT_EQ(r.wrench.torque, glm::dvec3(0.0, 0.1, 0.0));
}

TEST(LimitWrench, NumbersWhoseSquareOverflowsKeepTheirDirection) {
  const LimitedWrench r = limitWrench({{0.0, -1e300, 0.0}, {}}, {5.0, 0.5});
  EXPECT_DOUBLE_EQ(r.wrench.force.y, -5.0);
}

TEST(LimitWrench, ALimitOfZeroGivesZero) {
  const LimitedWrench r = limitWrench({{1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, {0.0, 0.0});
  EXPECT_TRUE(r.isClamped);
  EXPECT_EQ(r.wrench.force, glm::dvec3(0.0));
  EXPECT_EQ(r.wrench.torque, glm::dvec3(0.0));
}

TEST(LimitWrench, LargestFiniteNumbersKeepTheirDirection) {
  const double most = std::numeric_limits<double>::max();
  const LimitedWrench r = limitWrench({{most, -most, 0.0}, {}}, {5.0, 0.5});
  EXPECT_NEAR(glm::distance(r.wrench.force, glm::dvec3(5.0, -5.0, 0.0) / std::sqrt(2.0)), 0.0, 1e-14);
}

TEST(LimitWrench, LimitThatIsNoNumberCountsAsZero) {
  const LimitedWrench r = limitWrench({{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}, {kNan, -1.0});
  EXPECT_EQ(r.wrench.force, glm::dvec3(0.0));
  EXPECT_EQ(r.wrench.torque, glm::dvec3(0.0));
}

constexpr double kPeriod = 1e-3;
const Wrench kWanted{{3.0, 0.0, 4.0}, {0.0, 0.5, 0.0}};

/// So fast that the slew limit never shows.
DeviceLimits fastDevice() {
  DeviceLimits limits;
  limits.forceSlew = limits.torqueSlew = 1e9;
  return limits;
}

WrenchConditioner engaged() {
  WrenchConditioner conditioner;
  conditioner.engage();
  return conditioner;
}

/// Engaged long ago, sending what is wanted.
WrenchConditioner sending(const Wrench& wanted, const DeviceLimits& limits) {
  WrenchConditioner conditioner = engaged();
  for (int i = 0; i < 1000; ++i)
    conditioner.condition(wanted, 0.0, kPeriod, limits);
  return conditioner;
}

TEST(WrenchConditioner, SendsNothingUntilEngaged) {
  WrenchConditioner conditioner;
  for (int i = 0; i < 500; ++i)
    EXPECT_EQ(conditioner.condition(kWanted, 0.0, kPeriod, {}).wrench.force, glm::dvec3(0.0));
}

TEST(WrenchConditioner, RampsInSmoothlyWithinItsTime) {
  WrenchConditioner conditioner = engaged();
  const int ticks = static_cast<int>(std::lround(WrenchConditioner::kRampTime / kPeriod));
  double last = 0.0, largestStep = 0.0;
  for (int i = 0; i <= ticks; ++i) {
    const double force = glm::length(conditioner.condition(kWanted, 0.0, kPeriod, fastDevice()).wrench.force);
    if (i == 0) {
      EXPECT_EQ(force, 0.0);
    }
    // 3 t^2 - 2 t^3 is a half at half time and no steeper than 1.5.
    if (i == ticks / 2) {
      EXPECT_NEAR(force, 2.5, 1e-9);
    }
    EXPECT_GE(force, last);
    largestStep = std::max(largestStep, force - last);
    last = force;
  }
  EXPECT_NEAR(last, 5.0, 1e-9);
  EXPECT_LE(largestStep, 5.0 * 1.5 / ticks * (1.0 + 1e-9));
}

TEST(WrenchConditioner, PassesOnWhatIsWithinAllLimitsBitForBit) {
  WrenchConditioner conditioner = sending(kWanted, {});
  const ConditionedWrench r = conditioner.condition(kWanted, 0.0, kPeriod, {});
  EXPECT_EQ(r.wrench.force, kWanted.force);
  EXPECT_EQ(r.wrench.torque, kWanted.torque);
  EXPECT_FALSE(r.isClamped || r.isSlewed);
  EXPECT_TRUE(r.isFinite);
}

TEST(WrenchConditioner, ClampsForceAndTorque) {
  WrenchConditioner conditioner = sending({{100.0, 0.0, 0.0}, {0.0, -100.0, 0.0}}, {});
  const ConditionedWrench r =
      conditioner.condition({{100.0, 0.0, 0.0}, {0.0, -100.0, 0.0}}, 0.0, kPeriod, {});
  EXPECT_NEAR(glm::distance(r.wrench.force, {10.0, 0.0, 0.0}), 0.0, 1e-14);
  EXPECT_NEAR(glm::distance(r.wrench.torque, {0.0, -1.0, 0.0}), 0.0, 1e-14);
  EXPECT_TRUE(r.isClamped);
}

TEST(WrenchConditioner, FullForceTakesTheTimeOfTheSlewLimit) {
  WrenchConditioner conditioner = sending({}, {});
  // 10 N at 2000 N/s: five ticks of 2 N.
  for (int i = 1; i <= 5; ++i) {
    const ConditionedWrench r = conditioner.condition({{0.0, 10.0, 0.0}, {}}, 0.0, kPeriod, {});
    EXPECT_NEAR(r.wrench.force.y, 2.0 * i, 1e-12);
    EXPECT_EQ(r.isSlewed, i < 5);
  }
}

TEST(WrenchConditioner, StaleInputFadesToNothing) {
  WrenchConditioner conditioner = sending(kWanted, fastDevice());
  const auto forceAt = [&](double age) {
    return glm::length(conditioner.condition(kWanted, age, kPeriod, fastDevice()).wrench.force);
  };
  // Held for 5 ms, then down along a line that ends at 20 ms.
  EXPECT_NEAR(forceAt(0.005), 5.0, 1e-12);
  EXPECT_NEAR(forceAt(0.008), 4.0, 1e-12);
  EXPECT_NEAR(forceAt(0.0125), 2.5, 1e-12);
  EXPECT_NEAR(forceAt(0.0199999), 0.0, 1e-4);
  EXPECT_EQ(forceAt(0.020), 0.0);
  EXPECT_EQ(forceAt(1e9), 0.0);
  EXPECT_EQ(forceAt(kInfinity), 0.0);
}

TEST(WrenchConditioner, AHandThatIsSlowByItsNatureIsWaitedFor) {
  WrenchConditioner conditioner = sending(kWanted, fastDevice());
  const auto forceAt = [&](double age, const PoseFade& patience) {
    return glm::length(conditioner.condition(kWanted, age, kPeriod, fastDevice(), patience).wrench.force);
  };
  const PoseFade slow{0.020, 0.040};
  EXPECT_NEAR(forceAt(0.020, slow), 5.0, 1e-12);
  EXPECT_NEAR(forceAt(0.030, slow), 2.5, 1e-12);
  EXPECT_EQ(forceAt(0.040, slow), 0.0);
}

TEST(WrenchConditioner, PatienceThatIsNoNumberIsNone) {
  for (const PoseFade& patience : {PoseFade{kNan, 0.02}, {0.005, kNan}, {0.005, 0.001}}) {
    WrenchConditioner conditioner = sending(kWanted, fastDevice());
    EXPECT_EQ(conditioner.condition(kWanted, 0.004, kPeriod, fastDevice(), patience).wrench.force,
              glm::dvec3(0.0));
  }
}

TEST(WrenchConditioner, PatienceWithoutEndNeverFades) {
  WrenchConditioner conditioner = sending(kWanted, fastDevice());
  const PoseFade endless{0.005, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(conditioner.condition(kWanted, 1e6, kPeriod, fastDevice(), endless).wrench.force, kWanted.force);
}

TEST(WrenchConditioner, RecoversFromStaleInputByARamp) {
  WrenchConditioner conditioner = sending(kWanted, fastDevice());
  EXPECT_EQ(conditioner.condition(kWanted, 1.0, kPeriod, fastDevice()).wrench.force, glm::dvec3(0.0));
  double last = 0.0;
  const int ticks = static_cast<int>(std::lround(WrenchConditioner::kRecoveryTime / kPeriod));
  for (int i = 0; i < ticks; ++i) {
    const double force = glm::length(conditioner.condition(kWanted, 0.0, kPeriod, fastDevice()).wrench.force);
    EXPECT_NEAR(force - last, 5.0 / ticks, 1e-9);
    last = force;
  }
  EXPECT_NEAR(last, 5.0, 1e-9);
}

TEST(WrenchConditioner, AgeThatIsNoNumberIsStale) {
  WrenchConditioner conditioner = sending(kWanted, fastDevice());
  EXPECT_EQ(conditioner.condition(kWanted, kNan, kPeriod, fastDevice()).wrench.force, glm::dvec3(0.0));
}

TEST(WrenchConditioner, AgeFromTheFutureIsFresh) {
  WrenchConditioner conditioner = sending(kWanted, fastDevice());
  EXPECT_EQ(conditioner.condition(kWanted, -1.0, kPeriod, fastDevice()).wrench.force, kWanted.force);
}

TEST(WrenchConditioner, DisengagingLetsGoAtThePaceOfTheSlewLimit) {
  WrenchConditioner conditioner = sending({{10.0, 0.0, 0.0}, {}}, {});
  conditioner.disengage();
  for (int i = 4; i >= 0; --i) {
    const Wrench w = conditioner.condition({{10.0, 0.0, 0.0}, {}}, 0.0, kPeriod, {}).wrench;
    EXPECT_NEAR(w.force.x, 2.0 * i, 1e-12);
  }
}

TEST(WrenchConditioner, EngagingAgainRampsFromNothing) {
  WrenchConditioner conditioner = sending(kWanted, fastDevice());
  conditioner.disengage();
  conditioner.condition(kWanted, 0.0, kPeriod, fastDevice());
  conditioner.engage();
  EXPECT_EQ(conditioner.condition(kWanted, 0.0, kPeriod, fastDevice()).wrench.force, glm::dvec3(0.0));
}

TEST(WrenchConditioner, WhatIsNotFiniteGivesZeroAtOnceAndDoesNotPoisonWhatFollows) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (int component = 0; component < 6; ++component) {
      WrenchConditioner conditioner = sending(kWanted, {});
      Wrench wanted = kWanted;
      (component < 3 ? wanted.force : wanted.torque)[component % 3] = bad;
      const ConditionedWrench r = conditioner.condition(wanted, 0.0, kPeriod, {});
      EXPECT_FALSE(r.isFinite);
      EXPECT_EQ(r.wrench.force, glm::dvec3(0.0));
      EXPECT_EQ(r.wrench.torque, glm::dvec3(0.0));
      // As after engaging.
      WrenchConditioner other = engaged();
      for (int i = 0; i < 300; ++i)
        EXPECT_EQ(conditioner.condition(kWanted, 0.0, kPeriod, {}).wrench.force,
                  other.condition(kWanted, 0.0, kPeriod, {}).wrench.force);
    }
  }
}

TEST(WrenchConditioner, WithoutTimeNothingChanges) {
  WrenchConditioner conditioner = sending(kWanted, {});
  for (const double period : {0.0, -1.0, kNan, kInfinity})
    EXPECT_EQ(conditioner.condition({{-9.0, 0.0, 0.0}, {}}, 0.0, period, {}).wrench.force, kWanted.force);
}

TEST(WrenchConditioner, LowerLimitsAreKeptAtOnce) {
  WrenchConditioner conditioner = sending(kWanted, {});
  DeviceLimits narrow;
  narrow.maxForce = 1.0;
  narrow.maxTorque = kNan;
  const Wrench w = conditioner.condition(kWanted, 0.0, kPeriod, narrow).wrench;
  EXPECT_NEAR(glm::length(w.force), 1.0, 1e-14);
  EXPECT_EQ(w.torque, glm::dvec3(0.0));
}

TEST(WrenchConditioner, RandomInputIsAlwaysFiniteWithinTheLimitsAndTheSlew) {
  std::mt19937 engine(31);
  std::uniform_real_distribution<> exponent(-320.0, 308.0), sign(-1.0, 1.0), unit(0.0, 1.0);
  const auto number = [&] {
    const double size = std::pow(10.0, exponent(engine));
    return std::copysign(size, sign(engine));
  };
  const auto vector = [&] { return glm::dvec3{number(), number(), number()}; };
  WrenchConditioner conditioner = engaged();
  Wrench last;
  for (int i = 0; i < 20'000; ++i) {
    if (unit(engine) < 0.01) conditioner.engage();
    if (unit(engine) < 0.003) conditioner.disengage();
    const double period = unit(engine) < 0.05 ? number() : kPeriod * (0.5 + unit(engine));
    const double age = unit(engine) < 0.05 ? number() : 0.0;
    const ConditionedWrench r = conditioner.condition({vector(), vector()}, age, period, {});
    ASSERT_TRUE(r.isFinite);
    ASSERT_LE(glm::length(r.wrench.force), 10.0 * (1.0 + 1e-12));
    ASSERT_LE(glm::length(r.wrench.torque), 1.0 * (1.0 + 1e-12));
    const double elapsed = std::max(period, 0.0);
    ASSERT_LE(glm::distance(r.wrench.force, last.force), 2000.0 * elapsed + 1e-12);
    ASSERT_LE(glm::distance(r.wrench.torque, last.torque), 200.0 * elapsed + 1e-12);
    last = r.wrench;
  }
}

}  // namespace
}  // namespace nearfit::wrench_conditioner_test
