#include "tests/bench/feel_report.h"

#include <vector>

#include <gtest/gtest.h>

namespace nearfit::bench::feel_report_test {
namespace {

TEST(FeelRow, SumsSamplesUpInItsUnit) {
  std::vector<double> samples;
  for (int i = 1; i <= 1000; ++i)
    samples.push_back(1e-3 * i);
  const FeelRow row = feelRow("group", "scene", "run", "way [mm]", samples, 1e3);
  EXPECT_EQ(row.samples, 1000U);
  EXPECT_NEAR(row.p50, 500.0, 1e-9);
  EXPECT_NEAR(row.p99, 990.0, 1e-9);
  EXPECT_NEAR(row.p999, 999.0, 1e-9);
  EXPECT_NEAR(row.max, 1000.0, 1e-9);
  EXPECT_NEAR(row.mean, 500.5, 1e-9);
}

TEST(FeelRow, WithoutSamplesIsZero) {
  const FeelRow row = feelRow("group", "scene", "run", "way", {});
  EXPECT_EQ(row.samples, 0U);
  EXPECT_EQ(row.max, 0.0);
}

TEST(FeelCsv, HasAColumnForEachNumber) {
  const std::vector<double> samples{2.0};
  EXPECT_EQ(feelCsvHeader(), "group,scene,run,quantity,samples,mean,p50,p99,p99_9,max\n");
  EXPECT_EQ(feelCsvLine(feelRow("g", "s", "r", "q [m]", samples)), "g,s,r,q [m],1,2,2,2,2,2\n");
}

}  // namespace
}  // namespace nearfit::bench::feel_report_test
