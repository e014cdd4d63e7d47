#include "device/common/rate_control.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/math/rotation_vector.h"

namespace nearfit::rate_control_test {
namespace {

constexpr RateSettings kLinear{.deadZone = 0.0, .exponent = 1.0, .fullSpeed = 0.1, .fullTurn = 1.0};

TEST(RateControl, FullDeflectionMovesAtFullSpeed) {
  RateControl control(5.0, 0.25);
  control.restart({});
  RigidTransform pose;
  for (int i = 0; i < 1000; ++i)
    pose = control.step({1.0, -0.5, 0.0, 0.0, 0.0, 0.0}, kLinear, {}, 1e-3);
  EXPECT_NEAR(pose.translation.x, 0.1, 1e-12);
  EXPECT_NEAR(pose.translation.y, -0.05, 1e-12);
}

TEST(RateControl, TurningIsAboutTheAxisAndStaysUnit) {
  RateControl control(5.0, 0.25);
  control.restart({});
  RigidTransform pose;
  for (int i = 0; i < 500'000; ++i)
    pose = control.step({0.0, 0.0, 0.0, 0.0, 0.0, 1.0}, kLinear, {}, 1e-3);
  EXPECT_NEAR(glm::length(pose.rotation), 1.0, 1e-12);
  // 500 rad less 79 turns and a bit.
  EXPECT_NEAR(rotationVector(pose.rotation).z, std::remainder(500.0, 2.0 * M_PI), 1e-9);
}

TEST(RateControl, WallForceStopsTheHandleAndLetsItGoBack) {
  RateControl control(5.0, 0.25);
  control.restart({});
  const Wrench wall{{-5.0, 0.0, 0.0}, {}};
  EXPECT_EQ(control.step({1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, kLinear, wall, 1e-3).translation.x, 0.0);
  EXPECT_GT(control.step({1.0, 1.0, 0.0, 0.0, 0.0, 0.0}, kLinear, wall, 1e-3).translation.y, 0.0)
      << "slides along it";
  EXPECT_NEAR(control.step({-1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, kLinear, wall, 1e-3).translation.x, -1e-4, 1e-15)
      << "comes away at full speed";
}

TEST(RateControl, AxesGoTheOtherWayOrNotAtAllAsTheyAreSet) {
  RateControl control(5.0, 0.25);
  control.restart({});
  RateSettings settings = kLinear;
  settings.isInverted = {true, false, false, false, false, true};
  settings.isEnabled = {true, false, true, true, true, true};
  const RigidTransform pose = control.step({1.0, 1.0, 1.0, 0.0, 0.0, 1.0}, settings, {}, 0.01);
  EXPECT_NEAR(pose.translation.x, -1e-3, 1e-15);
  EXPECT_EQ(pose.translation.y, 0.0);
  EXPECT_NEAR(pose.translation.z, 1e-3, 1e-15);
  EXPECT_NEAR(rotationVector(pose.rotation).z, -0.01, 1e-12);
}

TEST(RateControl, PausesAreNoJumps) {
  RateControl control(5.0, 0.25);
  control.restart({});
  EXPECT_NEAR(control.step({1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, kLinear, {}, 10.0).translation.x,
              0.1 * RateControl::kLongestStep, 1e-15);
  EXPECT_NEAR(control.step({1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, kLinear, {}, -1.0).translation.x,
              0.1 * RateControl::kLongestStep, 1e-15);
}

TEST(ShapedDeflection, IsOddContinuousAndRising) {
  const RateSettings settings;
  double last = -1.0;
  for (int i = -1000; i <= 1000; ++i) {
    const double value = shapedDeflection(i / 1000.0, settings);
    EXPECT_EQ(value, -shapedDeflection(-i / 1000.0, settings));
    EXPECT_GE(value, last);
    EXPECT_LT(value - last, 0.01);
    last = value;
  }
  EXPECT_EQ(shapedDeflection(settings.deadZone, settings), 0.0);
  EXPECT_EQ(shapedDeflection(1.0, settings), 1.0);
  EXPECT_EQ(shapedDeflection(7.0, settings), 1.0);
  EXPECT_EQ(shapedDeflection(std::nan(""), settings), 0.0);
}

TEST(RateSettings, WhatIsOutOfRangeIsNamed) {
  RateSettings settings;
  settings.exponent = 9.0;
  try {
    checkRateSettings(settings);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_EQ(error.where(), "curve");
  }
  settings = {};
  settings.deadZone = 1.0;
  EXPECT_THROW(checkRateSettings(settings), UsageError);
  settings = {};
  settings.fullSpeed = std::nan("");
  EXPECT_THROW(checkRateSettings(settings), UsageError);
}

}  // namespace
}  // namespace nearfit::rate_control_test
