#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/realtime/latency_histogram.h"

namespace nearfit::bench {

/// Figures of an open window over one stretch of time: a line of `nearfit-bench-window hour --csv`.
struct HourRow {
  double minute = 0.0;         ///< Since the servo started, at the end of the stretch.
  std::uint64_t resident = 0;  ///< Memory of the process [bytes]; nothing is given back to the system first.
  std::uint64_t ticks = 0, overruns = 0;
  LatencyHistogram lateness, tickTime;
  double contactShare = 0.0;  ///< Share of the snapshots shown whose part is in contact; 0 without any.
  int pictures = 0;
};

std::string hourCsvHeader();
std::string hourCsvLine(const HourRow& row);

/// Fewer rows say nothing of growth: caches and plots fill at first.
constexpr std::size_t kMinRowsOfGrowth = 20;
/// Allocators and drivers may take on so much in an hour [bytes]; a leak of 200 bytes a picture would take more.
constexpr std::int64_t kMaxHourGrowth = std::int64_t{16} << 20U;

/// Median of the last tenth less that of the second tenth, by when the window's caches and plots are full [bytes]; 0 for
/// fewer than kMinRowsOfGrowth rows.
/// @param resident  HourRow::resident of each row, in order.
std::int64_t growthOf(std::span<const std::uint64_t> resident);

}  // namespace nearfit::bench
