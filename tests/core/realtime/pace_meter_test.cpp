#include "core/realtime/pace_meter.h"

#include <gtest/gtest.h>

namespace nearfit::pace_meter_test {
namespace {

TEST(PaceMeter, KnowsNothingBeforeTheSecond) {
  PaceMeter meter;
  EXPECT_EQ(meter.interval(), 0.0);
  meter.see(5.0);
  EXPECT_EQ(meter.interval(), 0.0);
  EXPECT_EQ(meter.jitter(), 0.0);
}

TEST(PaceMeter, AClockHasNoJitter) {
  PaceMeter meter;
  for (int i = 0; i < 1000; ++i)
    meter.see(7.0 + 1e-3 * i);
  EXPECT_NEAR(meter.interval(), 1e-3, 1e-12);
  EXPECT_NEAR(meter.jitter(), 0.0, 1e-12);
}

TEST(PaceMeter, WhatComesEarlyAndLateInTurnIsOffByThat) {
  PaceMeter meter;
  for (int i = 0; i < 1000; ++i)
    meter.see(1e-3 * i + (i % 2 == 0 ? 5e-5 : 0.0));
  // Intervals are 0.95 and 1.05 ms.
  EXPECT_NEAR(meter.interval(), 1e-3, 2e-6);
  EXPECT_NEAR(meter.jitter(), 5e-5, 2e-6);
}

TEST(PaceMeter, ForgetsHowItWasBefore) {
  PaceMeter meter;
  for (int i = 0; i < 100; ++i)
    meter.see(1e-3 * i);
  for (int i = 0; i < 1000; ++i)
    meter.see(1.0 + 2e-3 * i);
  EXPECT_NEAR(meter.interval(), 2e-3, 1e-6);
}

TEST(PaceMeter, OneSeenTwiceIsOne) {
  PaceMeter meter;
  for (int i = 0; i < 100; ++i) {
    meter.see(1e-3 * i);
    meter.see(1e-3 * i);
    meter.see(1e-3 * i - 1e-4);
  }
  EXPECT_NEAR(meter.interval(), 1e-3, 1e-12);
}

}  // namespace
}  // namespace nearfit::pace_meter_test
