#include "core/realtime/latency_histogram.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

namespace nearfit::latency_histogram_test {
namespace {

static_assert(std::is_trivially_copyable_v<LatencyHistogram>);

TEST(LatencyHistogram, AnEmptyOneHasNoDurations) {
  const LatencyHistogram h;
  EXPECT_EQ(h.count(), 0U);
  EXPECT_EQ(h.percentile(0.5), 0.0);
  EXPECT_EQ(h.max(), 0.0);
  EXPECT_EQ(h.mean(), 0.0);
}

TEST(LatencyHistogram, PercentilesAreUpperBoundsWithinOnePercentOfSortedData) {
  std::mt19937_64 random(7);
  std::lognormal_distribution<double> durations(std::log(30e-6), 1.5);
  LatencyHistogram h;
  std::vector<double> sorted;
  double sum = 0.0;
  for (int i = 0; i < 50000; ++i) {
    sorted.push_back(durations(random));
    sum += sorted.back();
    h.record(sorted.back());
  }
  std::sort(sorted.begin(), sorted.end());
  for (const double fraction : {0.001, 0.1, 0.5, 0.9, 0.99, 0.999, 0.9999}) {
    const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(sorted.size())));
    const double exact = sorted[rank - 1];
    EXPECT_GE(h.percentile(fraction), exact) << fraction;
    EXPECT_LE(h.percentile(fraction), std::max(exact * 1.0101, 1.01e-7)) << fraction;
  }
  EXPECT_EQ(h.percentile(1.0), sorted.back());
  EXPECT_EQ(h.max(), sorted.back());
  EXPECT_NEAR(h.mean(), sum / 50000.0, 1e-12);
  EXPECT_EQ(h.count(), 50000U);
}

TEST(LatencyHistogram, SinceHoldsWhatWasRecordedAfterTheCopyAlone) {
  LatencyHistogram h;
  for (int i = 0; i < 1000; ++i)
    h.record(5e-3);
  const LatencyHistogram earlier = h;
  EXPECT_EQ(h.since(earlier).count(), 0U);
  EXPECT_EQ(h.since(earlier).max(), 0.0);
  for (int i = 0; i < 99; ++i)
    h.record(20e-6);
  h.record(80e-6);
  const LatencyHistogram later = h.since(earlier);
  EXPECT_EQ(later.count(), 100U);
  EXPECT_NEAR(later.mean(), 20.6e-6, 1e-9);
  EXPECT_NEAR(later.percentile(0.99), 20e-6, 0.0101 * 20e-6);
  EXPECT_GE(later.max(), 80e-6);
  EXPECT_LE(later.max(), 1.0101 * 80e-6);
  h.record(9e-3);
  EXPECT_EQ(h.since(earlier).max(), 9e-3) << "the longest of all is known exactly";
}

TEST(LatencyHistogram, NoPercentileIsTooGoodForAnyDurationOfItsRange) {
  for (double duration = 1e-8; duration < 200.0; duration *= 1.0007) {
    LatencyHistogram h;
    h.record(duration);
    h.record(1e3);
    EXPECT_GE(h.percentile(0.5), duration);
    // Below 0.1 us everything is 0.1 us; beyond 100 s only the maximum is known.
    if (duration > 1e-7 && duration < 100.0) {
      EXPECT_LE(h.percentile(0.5), duration * 1.0101);
    }
  }
}

TEST(LatencyHistogram, BinEdgesAreNotTooGoodEither) {
  for (int i = 0; i < 2080; ++i) {
    const double edge = 1e-7 * std::pow(1.01, i);
    for (const double duration : {std::nextafter(edge, 0.0), edge, std::nextafter(edge, 1e9)}) {
      LatencyHistogram h;
      h.record(duration);
      h.record(1e3);
      EXPECT_GE(h.percentile(0.5), duration);
      EXPECT_LE(h.percentile(0.5), duration * 1.0101);
    }
  }
}

TEST(LatencyHistogram, ExtremesCountWithoutHarm) {
  LatencyHistogram h;
  h.record(-1.0);
  h.record(0.0);
  h.record(1e-300);
  h.record(1e6);
  h.record(std::numeric_limits<double>::infinity());
  h.record(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(h.count(), 5U) << "not a number is no duration";
  EXPECT_NEAR(h.percentile(0.6), 1e-7, 1e-12);
  EXPECT_EQ(h.max(), std::numeric_limits<double>::infinity());
  h.clear();
  EXPECT_EQ(h.count(), 0U);
  EXPECT_EQ(h.percentile(0.5), 0.0);
}

// Bins of 32 bits were full after 49 days at 1 kHz: from then on each percentile was the maximum.
TEST(LatencyHistogram, GoesOnCountingPast32Bits) {
  constexpr std::uint64_t kFull = std::numeric_limits<std::uint32_t>::max();
  LatencyHistogram h;
  h.record(1e-3, kFull - 2);
  for (int i = 0; i < 5; ++i)
    h.record(1e-3);
  h.record(1.0, kFull + 3);
  EXPECT_EQ(h.count(), 2 * kFull + 6);
  EXPECT_NEAR(h.percentile(0.5), 1e-3, 1e-5) << "half of them, to the last one";
  h.record(1.0);
  EXPECT_EQ(h.percentile(0.75), 1.0);
  EXPECT_NEAR(h.percentile(0.49), 1e-3, 1e-5);
  EXPECT_NEAR(h.mean(), 0.5005, 1e-6);
}

}  // namespace
}  // namespace nearfit::latency_histogram_test
