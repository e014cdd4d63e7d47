#include "tests/bench/tick_report.h"

#include <fmt/format.h>

#include "tests/bench/statistics.h"
#include "tests/bench/units.h"

namespace nearfit::bench {
namespace {

TimeFigures figuresOf(const std::vector<double>& seconds) {
  if (seconds.empty()) return {};
  const SampleSummary s(seconds);
  return {kMicro * s.percentile(0.5),   kMicro * s.percentile(0.9), kMicro * s.percentile(0.99),
          kMicro * s.percentile(0.999), kMicro * s.max(),           kMicro * s.mean()};
}

std::string columnsOf(const TimeFigures& t) {
  return fmt::format("{:>10.2f}{:>10.2f}{:>10.2f}{:>10.2f}{:>11.2f}{:>10.2f}", t.p50, t.p90, t.p99, t.p999,
                     t.max, t.mean);
}

std::string csvOf(const TimeFigures& t) {
  return fmt::format("{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f}", t.p50, t.p90, t.p99, t.p999, t.max, t.mean);
}

}  // namespace

std::vector<TickRow> tickRows(const std::string& scene, std::span<const TickRun> runs, std::size_t rounds,
                              bool isBest) {
  std::vector<TickRow> rows;
  for (const TickRun& run : runs) {
    const std::size_t ticks = run.tickTimes.size();
    TickRow row;
    row.scene = scene;
    row.name = run.name;
    row.parts = run.parts;
    row.ticks = ticks;
    row.refreshes = run.refreshTimes.size();
    row.tick = figuresOf(isBest && ticks > 0 ? bestOfRounds(run.tickTimes, ticks / rounds) : run.tickTimes);
    row.refresh = figuresOf(run.refreshTimes);
    const TimeFigures& base = rows.empty() ? row.tick : rows.front().tick;
    row.ratio50 = row.tick.p50 / base.p50;
    row.ratio99 = row.tick.p99 / base.p99;
    row.ratioMean = row.tick.mean / base.mean;
    row.lateTicks = run.lateTicks;
    row.mostNear = run.mostNear;
    row.isSame = !firstDifference(runs.front(), run);
    rows.push_back(row);
  }
  return rows;
}

std::string tickTable(std::span<const TickRow> rows) {
  std::string out =
      fmt::format("{:<12}{:<9}{:>8}{:>10}{:>10}{:>10}{:>10}{:>11}{:>10}{:>9}{:>9}{:>9}{:>7}{:>6}{:>6}\n",
                  "parts", "", "times", "p50", "p90", "p99", "p99.9", "max", "mean", "p50 x", "p99 x",
                  "mean x", "late", "near", "same");
  for (const TickRow& r : rows) {
    out += fmt::format("{:<12}{:<9}{:>8}{}{:>9.3f}{:>9.3f}{:>9.3f}{:>7}{:>6}{:>6}\n", r.name, "tick", r.ticks,
                       columnsOf(r.tick), r.ratio50, r.ratio99, r.ratioMean, r.lateTicks, r.mostNear,
                       r.isSame ? "yes" : "NO");
    out += fmt::format("{:<12}{:<9}{:>8}{}\n", "", "refresh", r.refreshes, columnsOf(r.refresh));
  }
  return out;
}

std::string tickCsvHeader() {
  return "scene,parts,other_parts,ticks,tick_p50_us,tick_p90_us,tick_p99_us,tick_p99_9_us,tick_max_us,"
         "tick_mean_us,p50_ratio,p99_ratio,mean_ratio,refreshes,refresh_p50_us,refresh_p90_us,refresh_p99_us,"
         "refresh_p99_9_us,refresh_max_us,refresh_mean_us,late_ticks,most_near,same\n";
}

std::string tickCsvLine(const TickRow& r) {
  return fmt::format("{},{},{},{},{},{:.4f},{:.4f},{:.4f},{},{},{},{},{}\n", r.scene, r.name, r.parts,
                     r.ticks, csvOf(r.tick), r.ratio50, r.ratio99, r.ratioMean, r.refreshes, csvOf(r.refresh),
                     r.lateTicks, r.mostNear, r.isSame ? 1 : 0);
}

}  // namespace nearfit::bench
