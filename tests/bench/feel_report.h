#pragma once

#include <span>
#include <string>
#include <vector>

namespace nearfit::bench {

/// Samples of one quantity in one run, summed up.
struct FeelRow {
  std::string group;  ///< smoothness, cost, sliding, free, tessellation, dense or curved.
  std::string scene;
  std::string run;       ///< What of the group: mode, refinement, speed.
  std::string quantity;  ///< With its unit.
  std::size_t samples = 0;
  double mean = 0.0, p50 = 0.0, p99 = 0.0, p999 = 0.0, max = 0.0;
};

/// @param scale  Into the unit that `quantity` names. All zero where there are no samples.
FeelRow feelRow(std::string group, std::string scene, std::string run, std::string quantity,
                std::span<const double> samples, double scale = 1.0);

/// A line each, with the scene's name where it changes.
std::string feelTable(std::span<const FeelRow> rows);
std::string feelCsvHeader();
std::string feelCsvLine(const FeelRow& row);

}  // namespace nearfit::bench
