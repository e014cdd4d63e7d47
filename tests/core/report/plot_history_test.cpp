#include "core/report/plot_history.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "tests/support/random_values.h"

namespace nearfit::plot_history_test {
namespace {

constexpr PlotChannel kForce = PlotChannel::Force;

PlotSample sampleOf(double time, float force) {
  PlotSample sample;
  sample.time = time;
  sample.values.fill(force);
  return sample;
}

/// A noisy line at 1 kHz with rare peaks of one sample.
PlotHistory noisyHistory(std::size_t count, std::size_t capacity, std::vector<PlotSample>& all) {
  test::RandomValues random(5);
  PlotHistory history(capacity);
  for (std::size_t i = 0; i < count; ++i) {
    const double peak = random.flip(1e-3) ? random.in(-50.0, 50.0) : 0.0;
    all.push_back(sampleOf(1e-3 * static_cast<double>(i), static_cast<float>(random.in(-1.0, 1.0) + peak)));
    history.add(all.back());
  }
  return history;
}

TEST(PlotHistory, TheNewestAreKeptInOrderAndInBoundedMemory) {
  std::vector<PlotSample> all;
  const PlotHistory history = noisyHistory(2500, 1000, all);
  ASSERT_EQ(history.size(), 1000U);
  for (std::size_t i = 0; i < 1000; ++i)
    EXPECT_EQ(history.at(i).time, all[1500 + i].time);
  EXPECT_EQ(history.beginTime(), all[1500].time);
  EXPECT_EQ(history.endTime(), all.back().time);
  for (const double time : {-1.0, 1.5, 1.7, 1.70001, 2.499, 9.0}) {
    std::size_t expected = 0;
    while (expected < 1000 && history.at(expected).time < time)
      ++expected;
    EXPECT_EQ(history.indexFrom(time), expected) << time;
  }
}

TEST(PlotHistory, NoPeakIsLostHoweverNarrowThePlot) {
  std::vector<PlotSample> all;
  const PlotHistory history = noisyHistory(40'000, 30'000, all);
  std::vector<PlotPoint> points;
  for (const std::size_t columns : {std::size_t{1}, std::size_t{7}, std::size_t{400}}) {
    const double from = 15.0003, to = 35.0007, width = (to - from) / static_cast<double>(columns);
    history.envelope(kForce, from, to, columns, points);
    EXPECT_LE(points.size(), 3 * columns + 4);
    EXPECT_TRUE(std::ranges::is_sorted(points, {}, &PlotPoint::time));
    std::vector<double> low(columns, 1e9), high(columns, -1e9), drawnLow = low, drawnHigh = high;
    const auto place = [&](double time) {
      return std::min(static_cast<std::size_t>((time - from) / width), columns - 1);
    };
    for (const PlotSample& sample : all) {
      if (sample.time < from || sample.time >= to) continue;
      const double value = static_cast<double>(sample.value(kForce));
      low[place(sample.time)] = std::min(low[place(sample.time)], value);
      high[place(sample.time)] = std::max(high[place(sample.time)], value);
    }
    for (const PlotPoint& point : points) {
      if (point.time < from || point.time >= to) continue;
      drawnLow[place(point.time)] = std::min(drawnLow[place(point.time)], point.value);
      drawnHigh[place(point.time)] = std::max(drawnHigh[place(point.time)], point.value);
    }
    EXPECT_EQ(drawnLow, low);
    EXPECT_EQ(drawnHigh, high);
  }
}

TEST(PlotHistory, FewSamplesAreDrawnAsTheyAreWithThoseBesideTheSpan) {
  PlotHistory history;
  for (int i = 0; i < 10; ++i)
    history.add(sampleOf(i, static_cast<float>(i * i)));
  std::vector<PlotPoint> points;
  history.envelope(kForce, 2.5, 5.5, 100, points);
  ASSERT_EQ(points.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(points[i].time, static_cast<double>(i + 2));
    EXPECT_EQ(points[i].value, static_cast<double>((i + 2) * (i + 2)));
  }
  history.envelope(kForce, 20.0, 30.0, 100, points);
  EXPECT_EQ(points.size(), 1U) << "the one before";
  PlotHistory().envelope(kForce, 0.0, 1.0, 100, points);
  EXPECT_TRUE(points.empty());
}

TEST(PlotHistory, WhereThereIsNoValueTheLineIsBroken) {
  PlotHistory history;
  MotionRow row;
  for (int i = 0; i < 3000; ++i) {
    row.time = 1e-3 * i;
    row.distance = i / 1000 == 1 ? std::numeric_limits<double>::infinity() : 0.002;
    history.add(plotSample(row));
  }
  std::vector<PlotPoint> points;
  for (const std::size_t columns : {std::size_t{10}, std::size_t{5000}}) {
    history.envelope(PlotChannel::Clearance, 0.0, 3.0, columns, points);
    for (const PlotPoint& point : points)
      EXPECT_EQ(std::isnan(point.value), point.time >= 1.0 && point.time < 2.0) << point.time;
    EXPECT_TRUE(std::ranges::any_of(points, [](const PlotPoint& p) { return std::isnan(p.value); }));
  }
}

TEST(PlotHistory, ANewRunForgetsTheOldOne) {
  PlotHistory history;
  history.add(sampleOf(5.0, 1.0F));
  const std::uint64_t before = history.serial();
  history.add(sampleOf(0.0, 2.0F));
  EXPECT_EQ(history.size(), 1U);
  EXPECT_NE(history.serial(), before);
  EXPECT_EQ(history.endTime(), 0.0);
}

TEST(PlotHistory, AGapBreaksTheLineAndForgetsNothing) {
  PlotHistory history;
  history.addGap();
  EXPECT_TRUE(history.isEmpty());
  history.add(sampleOf(0.0, 1.0F));
  history.addGap();
  history.add(sampleOf(0.002, 3.0F));
  std::vector<PlotPoint> points;
  history.envelope(PlotChannel::Force, -1.0, 1.0, 100, points);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0].value, 1.0);
  EXPECT_TRUE(std::isnan(points[1].value));
  EXPECT_EQ(points[2].value, 3.0);
}

TEST(PlotHistory, ASampleIsTheMagnitudesAndTimesOfItsTick) {
  MotionRow row;
  row.time = 3.0;
  row.wrench = {{3.0, 4.0, 0.0}, {0.0, 0.0, -2.0}};
  row.distance = 0.5;
  row.tickTime = 1e-3;
  row.lateness = 2e-3;
  const PlotSample sample = plotSample(row);
  EXPECT_EQ(sample.value(PlotChannel::Force), 5.0F);
  EXPECT_EQ(sample.value(PlotChannel::Torque), 2.0F);
  EXPECT_EQ(sample.value(PlotChannel::Clearance), 0.5F);
  EXPECT_TRUE(std::isnan(sample.value(PlotChannel::AtLeast)));
  EXPECT_EQ(sample.value(PlotChannel::TickTime), 1e-3F);
  EXPECT_EQ(sample.value(PlotChannel::Lateness), 2e-3F);
}

TEST(PlotHistory, ABoundOnTheClearanceHasALineOfItsOwn) {
  MotionRow row;
  row.distance = 0.5;
  row.isDistanceBound = true;
  const PlotSample sample = plotSample(row);
  EXPECT_TRUE(std::isnan(sample.value(PlotChannel::Clearance)));
  EXPECT_EQ(sample.value(PlotChannel::AtLeast), 0.5F);
}

TEST(PlotHistory, ATableHasTheSamplesOfASpan) {
  PlotHistory history;
  for (int i = 0; i < 5; ++i)
    history.add(sampleOf(i, i == 2 ? std::numeric_limits<float>::quiet_NaN() : 0.5F));
  EXPECT_EQ(history.csv(1.0, 2.0),
            "t_s,force_N,torque_Nm,clearance_m,clearance_at_least_m,tick_s,lateness_s\n1,0.5,0.5,0.5,0.5,0.5,"
            "0.5\n2,,,,,,\n");
}

}  // namespace
}  // namespace nearfit::plot_history_test
