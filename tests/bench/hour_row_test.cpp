#include "tests/bench/hour_row.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace nearfit::hour_row_test {
namespace {

using bench::HourRow;

std::vector<std::uint64_t> steady(std::size_t count) {
  return std::vector<std::uint64_t>(count, 200'000'000U);
}

TEST(HourRow, AWindowThatFillsItsCachesAtFirstDoesNotGrow) {
  std::vector<std::uint64_t> resident = steady(60);
  for (std::size_t i = 0; i < 6; ++i)
    resident[i] = 100'000'000U + 15'000'000U * i;
  EXPECT_EQ(bench::growthOf(resident), 0);
}

TEST(HourRow, ALeakGrowsAndOneSpikeDoesNot) {
  std::vector<std::uint64_t> resident = steady(60);
  resident.back() = 900'000'000U;
  EXPECT_EQ(bench::growthOf(resident), 0);
  for (std::size_t i = 0; i < resident.size(); ++i)
    resident[i] = 200'000'000U + 1'000'000U * i;
  // Rows 54 to 59 against rows 6 to 11.
  EXPECT_EQ(bench::growthOf(resident), 48'000'000);
  EXPECT_GT(bench::growthOf(resident), bench::kMaxHourGrowth);
}

TEST(HourRow, AShortRunSaysNothingOfGrowth) {
  std::vector<std::uint64_t> resident = steady(bench::kMinRowsOfGrowth - 1);
  resident.back() = resident[resident.size() - 2] = 900'000'000U;
  EXPECT_EQ(bench::growthOf(resident), 0);
}

TEST(HourRow, ALineHasAColumnForEachName) {
  HourRow row;
  row.minute = 1.0;
  row.resident = 123'456'000;
  row.ticks = 60'000;
  row.overruns = 3;
  row.lateness.record(50e-6);
  row.tickTime.record(20e-6);
  row.contactShare = 0.5;
  row.pictures = 1200;
  const std::string line = bench::hourCsvLine(row), header = bench::hourCsvHeader();
  EXPECT_EQ(line, "1.000,123.456,60000,3,50.0,50.0,50.0,50.0,20.0,20.0,20.0,0.500,1200\n");
  EXPECT_EQ(std::count(line.begin(), line.end(), ','), std::count(header.begin(), header.end(), ','));
}

}  // namespace
}  // namespace nearfit::hour_row_test
