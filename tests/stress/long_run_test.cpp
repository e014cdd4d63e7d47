#include "tests/stress/long_run.h"

#include <gtest/gtest.h>

namespace nearfit::stress::long_run_test {
namespace {

TEST(LongRun, NeitherDriftsNorGrowsInMinutes) {
#ifdef NEARFIT_SANITIZED
  constexpr double kSeconds = 60.0;
#else
  constexpr double kSeconds = 300.0;
#endif
  const LongRunResult result = runLong(kSeconds);
  EXPECT_EQ(result.freeDrift, 0.0);
  EXPECT_LE(result.contactDrift, kMaxDrift);
  EXPECT_LE(result.forceDrift, 1e-3);
#ifndef NEARFIT_SANITIZED
  // Sanitizers keep what was freed.
  EXPECT_LE(result.memoryGrowth, kMaxGrowth);
#endif
}

TEST(LongRun, OnSpringsTheForceIsTheSameInEveryCycle) {
  for (const StressMode mode : {StressMode::Spring, StressMode::Printed, StressMode::Grouped}) {
    const LongRunResult result = runLong(60.0, mode);
    EXPECT_EQ(result.cycles, 6U) << nameOf(mode);
    EXPECT_EQ(result.freeDrift, 0.0) << nameOf(mode);
    EXPECT_LE(result.forceDrift, kMaxForceDrift) << nameOf(mode);
  }
}

}  // namespace
}  // namespace nearfit::stress::long_run_test
