#include "tests/bench/statistics.h"

#include <gtest/gtest.h>

namespace nearfit::bench::statistics_test {
namespace {

TEST(SampleSummary, PercentilesAreNearestRank) {
  std::vector<double> samples;
  for (int i = 1000; i >= 1; --i)
    samples.push_back(i);
  const SampleSummary summary(samples);
  EXPECT_EQ(summary.percentile(0.5), 500.0);
  EXPECT_EQ(summary.percentile(0.99), 990.0);
  EXPECT_EQ(summary.percentile(0.999), 999.0);
  EXPECT_EQ(summary.max(), 1000.0);
  EXPECT_DOUBLE_EQ(summary.mean(), 500.5);
}

TEST(SampleSummary, OneSampleIsEveryPercentile) {
  const SampleSummary summary({3.0});
  EXPECT_EQ(summary.percentile(0.001), 3.0);
  EXPECT_EQ(summary.percentile(1.0), 3.0);
}

TEST(BestOfRounds, KeepsTheLeastTimeOfEachPose) {
  const std::vector<double> samples{5.0, 1.0, 9.0, 4.0, 2.0, 8.0};
  EXPECT_EQ(bestOfRounds(samples, 3), (std::vector<double>{4.0, 1.0, 8.0}));
}

}  // namespace
}  // namespace nearfit::bench::statistics_test
