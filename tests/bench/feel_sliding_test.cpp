#include "tests/bench/feel_sliding.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace nearfit::bench::feel_sliding_test {
namespace {

TEST(RunSliding, ABoxKeepsUpWithASlowHand) {
  SlidingOptions options;
  options.seconds = 0.2;
  const SlidingRun run = runSliding(0.1, options);
  ASSERT_EQ(run.lag.size(), 200U);
  EXPECT_EQ(run.ticksInContact, 200U);
  EXPECT_GT(run.poses.size(), 200U);
  // Within what the hand goes in a tick.
  for (const double lag : run.lag)
    EXPECT_NEAR(lag, 0.0, 1e-4);
}

TEST(RunSliding, AHandTooFastForTheSubStepsLeavesThePartBehind) {
  SlidingOptions options;
  options.seconds = 0.2;
  // More than 24 sub-steps of two margins and their reach in each tick.
  const SlidingRun run = runSliding(20.0, options);
  EXPECT_GT(*std::ranges::max_element(run.lag), 0.1);
  EXPECT_EQ(*std::ranges::max_element(run.subSteps), 24.0);
}

TEST(RunFree, NothingIsFeltAtRest) {
  const FreeRun run = runFree();
  EXPECT_GT(run.moving.size(), 1900U);
  EXPECT_GT(run.resting.size(), 400U);
  // The filter of the twists forgets the roundings of the way; then there is nothing at all.
  for (const double felt : run.resting)
    EXPECT_LT(felt, 1e-12);
  EXPECT_EQ(run.resting.back(), 0.0);
  for (const double felt : run.moving)
    EXPECT_LT(felt, 1e-12);
}

}  // namespace
}  // namespace nearfit::bench::feel_sliding_test
