#pragma once

#include <span>
#include <string>
#include <vector>

#include "tests/bench/agreement.h"
#include "tests/bench/interleaved_run.h"

namespace nearfit::bench {

/// Figures of one method on one scene; times in microseconds.
struct ReportRow {
  std::string scene, method;
  std::size_t sceneTriangles = 0, partTriangles = 0, poses = 0;
  double p50 = 0.0, p90 = 0.0, p99 = 0.0, p999 = 0.0, max = 0.0, mean = 0.0;
  std::size_t countMedian = 0, countMax = 0;
  /// Times that the baseline takes as long; NaN without a baseline.
  double ratio50 = 0.0, ratio99 = 0.0;
  long preemptions = 0;
  Agreement agreement;
};

/// @param baseline      Name of the method that ratios refer to; need not be among the runs.
/// @param bestOfRounds  Take each pose's least time of all rounds, not all times.
std::vector<ReportRow> reportRows(const PreparedScene& scene, std::span<const MethodRun> runs,
                                  const std::string& baseline, bool bestOfRounds);

/// The rows of one scene for a reader, with a headline.
std::string tableOf(const PreparedScene& scene, std::span<const ReportRow> rows, const std::string& baseline);

/// A line on how near the path comes, by the answers of the reference.
std::string describePath(const PreparedScene& scene, std::span<const MethodRun> runs);

std::string csvHeader();
std::string csvLine(const ReportRow& row);

/// Every time measured: scene, method, round, pose, us.
std::string samplesCsv(const PreparedScene& scene, std::span<const MethodRun> runs);

/// A sentence for each row whose answers are not the reference's.
std::vector<std::string> disagreements(std::span<const ReportRow> rows);

}  // namespace nearfit::bench
