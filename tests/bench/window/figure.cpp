#include "tests/bench/window/figure.h"

#include <fmt/format.h>

#include "tests/bench/statistics.h"

namespace nearfit::bench {
namespace {

std::string goalText(const Figure& f) {
  if (f.goal <= 0.0) return {};
  const double value = f.goalOf == "max" ? f.max : f.goalOf == "p99" ? f.p99 : f.p50;
  return fmt::format("{} <= {:g}: {}", f.goalOf, f.goal, value <= f.goal ? "met" : "MISSED");
}

}  // namespace

Figure figureOf(std::string name, std::string way, std::string unit, const std::vector<double>& samples) {
  const SampleSummary summary(samples);
  Figure figure{std::move(name), std::move(way), std::move(unit)};
  figure.count = samples.size();
  figure.p50 = summary.percentile(0.5);
  figure.p99 = summary.percentile(0.99);
  figure.p999 = summary.percentile(0.999);
  figure.max = summary.max();
  return figure;
}

std::string figureTableHeader() {
  return fmt::format("{:<12}{:<34}{:<5}{:>7}{:>11}{:>11}{:>11}{:>11}  {:<22}{}\n", "figure", "way", "unit",
                     "count", "p50", "p99", "p99.9", "max", "goal", "remark");
}

std::string figureTableLine(const Figure& f) {
  return fmt::format("{:<12}{:<34}{:<5}{:>7}{:>11.3f}{:>11.3f}{:>11.3f}{:>11.3f}  {:<22}{}\n", f.name, f.way,
                     f.unit, f.count, f.p50, f.p99, f.p999, f.max, goalText(f), f.remark);
}

std::string figureCsvHeader() {
  return "figure,way,unit,count,p50,p99,p999,max,goal_of,goal,remark\n";
}

std::string figureCsvLine(const Figure& f) {
  return fmt::format("{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{},{:g},{}\n", f.name, f.way, f.unit, f.count,
                     f.p50, f.p99, f.p999, f.max, f.goalOf, f.goal, f.remark);
}

}  // namespace nearfit::bench
