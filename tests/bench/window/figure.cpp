#include "tests/bench/window/figure.h"

#include <fmt/format.h>

#include "tests/bench/statistics.h"

namespace nearfit::bench {
namespace {

std::string saidOf(const std::string& what, double goal, double value) {
  return fmt::format("{} <= {:g}: {}", what, goal, value <= goal ? "met" : "MISSED");
}

std::string goalText(const Figure& f) {
  std::string text;
  if (f.goal > 0.0)
    text = saidOf(f.goalOf, f.goal, f.goalOf == "max" ? f.max : f.goalOf == "p99" ? f.p99 : f.p50);
  if (f.goalP999 > 0.0) text += "; " + saidOf("p99.9", f.goalP999, f.p999);
  if (f.leftOut && f.maxLeftOut)
    text += "; " + saidOf("left out", static_cast<double>(*f.maxLeftOut), static_cast<double>(*f.leftOut));
  return text;
}

std::string countText(const std::optional<std::uint64_t>& count) {
  return count ? fmt::format("{}", *count) : std::string();
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
  return fmt::format("{:<12}{:<34}{:<5}{:>7}{:>11}{:>11}{:>11}{:>11}  {:<22}  {}\n", "figure", "way", "unit",
                     "count", "p50", "p99", "p99.9", "max", "goal", "remark");
}

std::string figureTableLine(const Figure& f) {
  return fmt::format("{:<12}{:<34}{:<5}{:>7}{:>11.3f}{:>11.3f}{:>11.3f}{:>11.3f}  {:<22}  {}\n", f.name,
                     f.way, f.unit, f.count, f.p50, f.p99, f.p999, f.max, goalText(f), f.remark);
}

std::string figureCsvHeader() {
  return "figure,way,unit,count,p50,p99,p999,max,goal_of,goal,remark,goal_p999,left_out,goal_left_out\n";
}

std::string figureCsvLine(const Figure& f) {
  return fmt::format("{},{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{},{:g},{},{:g},{},{}\n", f.name, f.way, f.unit,
                     f.count, f.p50, f.p99, f.p999, f.max, f.goalOf, f.goal, f.remark, f.goalP999,
                     countText(f.leftOut), countText(f.maxLeftOut));
}

}  // namespace nearfit::bench
