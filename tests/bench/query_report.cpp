#include "tests/bench/query_report.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "tests/bench/statistics.h"
#include "tests/bench/units.h"

namespace nearfit::bench {
namespace {

ReportRow rowOf(const PreparedScene& scene, const MethodRun& run, bool isBest) {
  ReportRow row;
  row.scene = scene.meshes.name;
  row.method = run.method->name;
  row.sceneTriangles = scene.meshes.scene.triangles().size();
  row.partTriangles = scene.meshes.part.triangles().size();
  row.poses = run.poses.size();
  row.preemptions = run.preemptions;
  const SampleSummary times(isBest ? bestOfRounds(run.times, run.poses.size()) : run.times);
  row.p50 = kMicro * times.percentile(0.5);
  row.p90 = kMicro * times.percentile(0.9);
  row.p99 = kMicro * times.percentile(0.99);
  row.p999 = kMicro * times.percentile(0.999);
  row.max = kMicro * times.max();
  row.mean = kMicro * times.mean();
  std::vector<double> counts;
  for (const Answer& answer : run.answers)
    counts.push_back(static_cast<double>(answer.count));
  const SampleSummary minima(counts);
  row.countMedian = static_cast<std::size_t>(minima.percentile(0.5));
  row.countMax = static_cast<std::size_t>(minima.max());
  return row;
}

}  // namespace

std::vector<ReportRow> reportRows(const PreparedScene& scene, std::span<const MethodRun> runs,
                                  const std::string& baseline, bool bestOfRounds) {
  std::vector<ReportRow> rows;
  const std::vector<Agreement> agreements = compareRuns(runs, scene.cutoff, scene.size);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].poses.empty()) continue;
    rows.push_back(rowOf(scene, runs[i], bestOfRounds));
    rows.back().agreement = agreements[i];
  }
  const auto base =
      std::find_if(rows.begin(), rows.end(), [&](const ReportRow& row) { return row.method == baseline; });
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double base50 = base != rows.end() ? base->p50 : nan, base99 = base != rows.end() ? base->p99 : nan;
  for (ReportRow& row : rows) {
    row.ratio50 = base50 / row.p50;
    row.ratio99 = base99 / row.p99;
  }
  return rows;
}

std::string tableOf(const PreparedScene& scene, std::span<const ReportRow> rows,
                    const std::string& baseline) {
  std::string out = fmt::format("\n{}: {} and {} triangles, cutoff {:.4g} m; times in us, ratios to {}\n",
                                scene.meshes.name, scene.meshes.scene.triangles().size(),
                                scene.meshes.part.triangles().size(), scene.cutoff, baseline);
  out += fmt::format("{:<16}{:>7}{:>10}{:>10}{:>10}{:>10}{:>11}{:>10}{:>9}{:>9}{:>9}{:>9}{:>10}\n", "method",
                     "poses", "p50", "p90", "p99", "p99.9", "max", "mean", "count", "max", "p50 x", "p99 x",
                     "differs");
  for (const ReportRow& r : rows) {
    out += fmt::format(
        "{:<16}{:>7}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.1f}{:>11.1f}{:>10.1f}{:>9}{:>9}{:>9.2f}{:>9.2f}{:>10.1e}"
        "\n",
        r.method, r.poses, r.p50, r.p90, r.p99, r.p999, r.max, r.mean, r.countMedian, r.countMax, r.ratio50,
        r.ratio99, r.agreement.worstDistance);
  }
  return out;
}

std::string describePath(const PreparedScene& scene, std::span<const MethodRun> runs) {
  if (runs.empty() || runs.front().answers.empty()) return {};
  const MethodRun& reference = referenceOf(runs);
  double least = std::numeric_limits<double>::infinity();
  std::size_t within = 0;
  for (const Answer& answer : reference.answers) {
    least = std::min(least, answer.distance);
    within += answer.distance <= scene.cutoff ? 1 : 0;
  }
  return fmt::format(
      "The bodies are within the cutoff at {:.1f} % of the poses; least distance {:.2f} % of it.\n",
      100.0 * static_cast<double>(within) / static_cast<double>(reference.answers.size()),
      100.0 * least / scene.cutoff);
}

std::string csvHeader() {
  return "scene,scene_triangles,part_triangles,method,poses,p50_us,p90_us,p99_us,p99_9_us,max_us,mean_us,"
         "count_median,count_max,p50_ratio,p99_ratio,worst_difference_m,preemptions\n";
}

std::string csvLine(const ReportRow& r) {
  return fmt::format(
      "{},{},{},{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{},{:.3f},{:.3f},{:.3g},{}\n", r.scene,
      r.sceneTriangles, r.partTriangles, r.method, r.poses, r.p50, r.p90, r.p99, r.p999, r.max, r.mean,
      r.countMedian, r.countMax, r.ratio50, r.ratio99, r.agreement.worstDistance, r.preemptions);
}

std::string samplesCsv(const PreparedScene& scene, std::span<const MethodRun> runs) {
  std::string out;
  for (const MethodRun& run : runs) {
    for (std::size_t i = 0; i < run.times.size(); ++i) {
      out += fmt::format("{},{},{},{},{:.3f}\n", scene.meshes.name, run.method->name, i / run.poses.size(),
                         run.poses[i % run.poses.size()], kMicro * run.times[i]);
    }
  }
  return out;
}

std::vector<std::string> disagreements(std::span<const ReportRow> rows) {
  std::vector<std::string> sentences;
  for (const ReportRow& r : rows) {
    if (r.agreement.holds) continue;
    sentences.push_back(fmt::format(
        "{}: {} differs from the reference by {:.3g} m at pose {}, is incomplete at {} poses, has another "
        "number of minima at {}; the bodies touch at {}",
        r.scene, r.method, r.agreement.worstDistance, r.agreement.worstPose, r.agreement.incomplete,
        r.agreement.differentCounts, r.agreement.touching));
  }
  return sentences;
}

}  // namespace nearfit::bench
