// Parts of the commands that need neither a device nor a process of their own.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "app/cli/device_monitor.h"
#include "app/cli/rate_options.h"
#include "core/base/error.h"

namespace nearfit::cli::cli_parts_test {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

/// The last force against a handle that goes along x at a speed for two seconds.
Wrench against(double speed, bool isArmed = true, double age = 0.0) {
  MonitorDamping damping;
  Wrench wrench;
  for (int i = 1; i <= 2000; ++i) {
    HandleInput handle;
    handle.pose.translation.x = speed * 1e-3 * i;
    handle.age = age;
    wrench = damping.step(handle, isArmed, i * kMillisecond);
  }
  return wrench;
}

TEST(MonitorDamping, ResistsInProportionToSpeedAndNeverMoreThanItsMost) {
  EXPECT_NEAR(against(0.1).force.x, -0.2, 1e-9);
  EXPECT_NEAR(against(-0.1).force.x, 0.2, 1e-9);
  EXPECT_NEAR(against(0.35).force.x, -0.5, 1e-9) << "0.7 N would be too much";
  EXPECT_EQ(against(0.1).force.y, 0.0);
  EXPECT_EQ(against(0.0).force.x, 0.0);
}

TEST(MonitorDamping, WhatIsFastOrStaleOrNotArmedIsLeftAlone) {
  EXPECT_NEAR(against(0.5).force.x, -0.25, 1e-9) << "half way between where it fades and where it ends";
  EXPECT_EQ(against(0.61).force.x, 0.0);
  EXPECT_EQ(against(0.1, false).force.x, 0.0);
  EXPECT_EQ(against(0.1, true, 0.006).force.x, 0.0);
  EXPECT_EQ(against(std::numeric_limits<double>::quiet_NaN()).force.x, 0.0);
}

TEST(MonitorDamping, FadesInOverASecondEachTimeThatTheDeviceBeginsToPush) {
  MonitorDamping damping;
  HandleInput handle;
  const auto at = [&](int i, bool isPushing) {
    handle.pose.translation.x = 1e-4 * i;
    handle.isArmed = isPushing;
    return damping.step(handle, true, i * kMillisecond).force.x;
  };
  double half = 0.0;
  for (int i = 1; i <= 501; ++i)
    half = at(i, true);
  EXPECT_NEAR(half, -0.1, 1e-9);
  EXPECT_EQ(at(502, false), 0.0);
  EXPECT_EQ(at(503, true), 0.0);
  EXPECT_NEAR(at(504, true), -0.2e-3, 1e-9);
}

TEST(RateOptions, AxesAreThoseThatAreNamed) {
  RateSettings settings;
  takeAxes("x,-rz", settings);
  EXPECT_EQ(settings.isEnabled, (std::array<bool, 6>{true, false, false, false, false, true}));
  EXPECT_EQ(settings.isInverted, (std::array<bool, 6>{false, false, false, false, false, true}));
  for (const char* wrong : {"", "w", "x,x", "x,-x", "x y", "x,", "--x"})
    EXPECT_THROW(takeAxes(wrong, settings), UsageError) << wrong;
}

TEST(RateOptions, WhatIsNotSaidStaysAsUsual) {
  RateOptions options;
  EXPECT_FALSE(options.isGiven());
  EXPECT_EQ(rateSettings(options), RateSettings{});
  options.deadZone = 0.2;
  EXPECT_TRUE(options.isGiven());
  RateSettings expected;
  expected.deadZone = 0.2;
  EXPECT_EQ(rateSettings(options), expected);
  options.exponent = 0.5;
  EXPECT_THROW(rateSettings(options), UsageError);
}

}  // namespace
}  // namespace nearfit::cli::cli_parts_test
