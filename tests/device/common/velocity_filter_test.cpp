#include "device/common/velocity_filter.h"

#include <gtest/gtest.h>

namespace nearfit::velocity_filter_test {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;

TEST(VelocityFilter, AStandingHandleHasNone) {
  VelocityFilter filter;
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(filter.update({0.1, 0.2, 0.3}, i * kMillisecond), glm::dvec3(0.0));
}

TEST(VelocityFilter, SteadyMotionIsMeasuredWhateverTheRate) {
  for (const Nanoseconds period : {kMillisecond / 4, kMillisecond, 7 * kMillisecond}) {
    VelocityFilter filter;
    glm::dvec3 velocity(0.0);
    // Twenty times its lag: nothing is left of the beginning but e^-20.
    for (Nanoseconds t = 0; t < 80 * kMillisecond; t += period)
      velocity = filter.update({0.5 * toSeconds(t), 0.0, 0.0}, t);
    EXPECT_NEAR(velocity.x, 0.5, 1e-8) << period;
  }
}

TEST(VelocityFilter, ReportsThatComeAllAtOnceDoNotLookFast) {
  VelocityFilter filter;
  // A metre a second, but eight reports at a time, every eight milliseconds.
  double most = 0.0;
  for (int burst = 0; burst < 50; ++burst) {
    for (int i = 0; i < 8; ++i) {
      const double x = 1e-3 * (8 * burst + i);
      most = std::fmax(most, filter.update({x, 0.0, 0.0}, Nanoseconds{burst} * 8 * kMillisecond).x);
    }
  }
  // A burst of eight millimetres over the lag of four milliseconds, and what was left of the one before:
  // 2 / (1 - e^-2).
  EXPECT_LE(most, 2.32);
}

TEST(VelocityFilter, AClockThatStandsOrGoesBackDoesNotMakeItInfinite) {
  VelocityFilter filter;
  filter.update({0.0, 0.0, 0.0}, 5 * kMillisecond);
  EXPECT_NEAR(filter.update({1e-3, 0.0, 0.0}, 5 * kMillisecond).x, 1e-3 / VelocityFilter::kTime, 1e-12);
  EXPECT_TRUE(std::isfinite(filter.update({2e-3, 0.0, 0.0}, 4 * kMillisecond).x));
}

TEST(VelocityFilter, ForgetsWhenReset) {
  VelocityFilter filter;
  filter.update({0.0, 0.0, 0.0}, 0);
  filter.update({1.0, 0.0, 0.0}, kMillisecond);
  filter.reset();
  EXPECT_EQ(filter.update({9.0, 0.0, 0.0}, 2 * kMillisecond), glm::dvec3(0.0));
}

}  // namespace
}  // namespace nearfit::velocity_filter_test
