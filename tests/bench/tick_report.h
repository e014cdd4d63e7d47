#pragma once

#include <span>
#include <string>
#include <vector>

#include "tests/bench/tick_run.h"

namespace nearfit::bench {

/// Percentiles in microseconds.
struct TimeFigures {
  double p50 = 0.0, p90 = 0.0, p99 = 0.0, p999 = 0.0, max = 0.0, mean = 0.0;
};

/// Figures of one number of parts; ratios are to the first of the rows.
struct TickRow {
  std::string scene, name;
  std::size_t parts = 0, ticks = 0, refreshes = 0;
  TimeFigures tick, refresh;
  double ratio50 = 0.0, ratio99 = 0.0, ratioMean = 0.0;
  std::size_t lateTicks = 0, mostNear = 0;
  bool isSame = true;  ///< Every tick gave what the first row's did, to the last bit.
};

/// @param rounds  That the times are of; with `isBest` a tick counts with its least time of all.
std::vector<TickRow> tickRows(const std::string& scene, std::span<const TickRun> runs, std::size_t rounds,
                              bool isBest);

/// A line for ticks and one for refreshes of each row.
std::string tickTable(std::span<const TickRow> rows);
std::string tickCsvHeader();
std::string tickCsvLine(const TickRow& row);

}  // namespace nearfit::bench
