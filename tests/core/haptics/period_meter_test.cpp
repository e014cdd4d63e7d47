#include "core/haptics/period_meter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace nearfit::period_meter_test {
namespace {

TEST(PeriodMeter, StartsAtTheNominalPeriodAndStaysThereOnTime) {
  PeriodMeter meter(1e-3);
  EXPECT_EQ(meter.period(), 1e-3);
  for (int i = 0; i < 1000; ++i)
    meter.add(1e-3);
  EXPECT_EQ(meter.period(), 1e-3);
}

TEST(PeriodMeter, ShortTicksSayNothing) {
  PeriodMeter meter(1e-3);
  for (int i = 0; i < 1000; ++i)
    meter.add(2e-4);
  EXPECT_EQ(meter.period(), 1e-3);
}

TEST(PeriodMeter, OneHiccupIsOneSmallStep) {
  PeriodMeter meter(1e-3);
  meter.add(5.0);
  EXPECT_DOUBLE_EQ(meter.period(), 1e-3 * (1.0 + PeriodMeter::kRise));
}

TEST(PeriodMeter, SlowerServoIsKnownWithinFifteenTicksAndNotOverestimated) {
  PeriodMeter meter(1e-3);
  for (int i = 0; i < 15; ++i)
    meter.add(2e-3);
  EXPECT_EQ(meter.period(), 2e-3);  // 1.05^15 = 2.08.
  meter.add(2e-3);
  EXPECT_NEAR(meter.period(), 2e-3, 2e-6);
}

TEST(PeriodMeter, ComesBackSlowly) {
  PeriodMeter meter(1e-3);
  for (int i = 0; i < 100; ++i)
    meter.add(2e-3);
  for (int i = 0; i < 100; ++i)
    meter.add(1e-3);
  EXPECT_GT(meter.period(), 1.85e-3);
  for (int i = 0; i < 1400; ++i)
    meter.add(1e-3);
  EXPECT_EQ(meter.period(), 1e-3);
}

TEST(PeriodMeter, SettlesWhereOneTickInAHundredIsLater) {
  std::mt19937 engine(17);
  std::lognormal_distribution<> jitter(std::log(1.5e-3), 0.2);
  // Of a logarithmic normal distribution: exp(mu + 2.3263 sigma).
  const double p99 = 1.5e-3 * std::exp(2.3263 * 0.2);
  PeriodMeter meter(1e-3);
  std::vector<double> estimates;
  for (int i = 0; i < 40'000; ++i) {
    meter.add(jitter(engine));
    if (i > 5000) estimates.push_back(meter.period());
  }
  std::nth_element(estimates.begin(), estimates.begin() + static_cast<long>(estimates.size() / 2),
                   estimates.end());
  // Steps that end at the late tick itself are shorter than kRise, so it stays a few percent below.
  const double median = estimates[estimates.size() / 2];
  EXPECT_GT(median, 0.88 * p99);
  EXPECT_LT(median, 1.05 * p99);
}

TEST(PeriodMeter, NoTickChangesItByMoreThanTheStatedStep) {
  std::mt19937 engine(23);
  std::uniform_real_distribution<> exponent(-5.0, 1.0);
  PeriodMeter meter(1e-3);
  for (int i = 0; i < 10'000; ++i) {
    const double before = meter.period();
    meter.add(std::pow(10.0, exponent(engine)));
    EXPECT_LE(meter.period(), before * (1.0 + PeriodMeter::kRise) * (1.0 + 1e-15));
    EXPECT_GE(meter.period(), before * (1.0 - PeriodMeter::kRise));
    EXPECT_LE(meter.period(), PeriodMeter::kLongestPeriod);
  }
}

TEST(PeriodMeter, HeldPeriodIsSteadyWhereTheEstimateWanders) {
  // A hand that leant on a wall was kept moving by a servo that lost one tick in twenty: each late tick made
  // the wall a twentieth softer, and the hundred after it stiffer again.
  std::mt19937 engine(5);
  std::uniform_real_distribution<> jitter(0.7, 1.3), lost(0.0, 1.0);
  PeriodMeter meter(1e-3);
  double least = 1.0, most = 0.0, leastHeld = 1.0, mostHeld = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    meter.add(10e-3 * (jitter(engine) + (lost(engine) < 0.05 ? 1.0 : 0.0)));
    ASSERT_GE(meter.heldPeriod(), meter.period());
    ASSERT_LE(meter.heldPeriod(), (1.0 + PeriodMeter::kPlay) * meter.period());
    if (i < 10'000) continue;
    least = std::min(least, meter.period());
    most = std::max(most, meter.period());
    leastHeld = std::min(leastHeld, meter.heldPeriod());
    mostHeld = std::max(mostHeld, meter.heldPeriod());
  }
  EXPECT_GT(most / least, 1.0 + PeriodMeter::kRise) << "it does wander";
  EXPECT_LT((mostHeld / leastHeld - 1.0), 0.25 * (most / least - 1.0));
}

TEST(PeriodMeter, HeldPeriodForgetsAHiccup) {
  PeriodMeter meter(1e-3);
  meter.add(5e-3);
  EXPECT_DOUBLE_EQ(meter.heldPeriod(), 1.05e-3);
  for (int i = 0; i < 30'000; ++i)
    meter.add(1e-3);
  EXPECT_EQ(meter.heldPeriod(), 1e-3);
}

TEST(PeriodMeter, SenselessTimesAreLeftOut) {
  PeriodMeter meter(1e-3);
  for (const double bad :
       {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    meter.add(bad);
  EXPECT_EQ(meter.period(), 1e-3);
}

TEST(PeriodMeter, SenselessNominalPeriodsAreReplaced) {
  EXPECT_EQ(PeriodMeter(std::numeric_limits<double>::quiet_NaN()).period(), 1e-3);
  EXPECT_GT(PeriodMeter(0.0).period(), 0.0);
  EXPECT_GT(PeriodMeter(-1.0).period(), 0.0);
  EXPECT_EQ(PeriodMeter(10.0).period(), PeriodMeter::kLongestPeriod);
}

}  // namespace
}  // namespace nearfit::period_meter_test
