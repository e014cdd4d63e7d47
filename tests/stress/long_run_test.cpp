#include "tests/stress/long_run.h"

#include <gtest/gtest.h>

namespace nearfit::stress {
namespace {

TEST(LongRun, NeitherDriftsNorGrowsInMinutes) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  constexpr double kSeconds = 60.0;
#else
  constexpr double kSeconds = 300.0;
#endif
  const LongRunResult result = runLong(kSeconds);
  EXPECT_EQ(result.freeDrift, 0.0);
  EXPECT_LE(result.contactDrift, kMostDrift);
  EXPECT_LE(result.forceDrift, 1e-3);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  // Sanitizers keep what was freed.
  EXPECT_LE(result.memoryGrowth, kMostGrowth);
#endif
}

}  // namespace
}  // namespace nearfit::stress
