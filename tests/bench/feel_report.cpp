#include "tests/bench/feel_report.h"

#include <utility>

#include <fmt/format.h>

#include "tests/bench/statistics.h"

namespace nearfit::bench {

FeelRow feelRow(std::string group, std::string scene, std::string run, std::string quantity,
                std::span<const double> samples, double scale) {
  FeelRow row;
  row.group = std::move(group);
  row.scene = std::move(scene);
  row.run = std::move(run);
  row.quantity = std::move(quantity);
  row.samples = samples.size();
  if (samples.empty()) return row;
  const SampleSummary s(std::vector<double>(samples.begin(), samples.end()));
  row.mean = scale * s.mean();
  row.p50 = scale * s.percentile(0.5);
  row.p99 = scale * s.percentile(0.99);
  row.p999 = scale * s.percentile(0.999);
  row.max = scale * s.max();
  return row;
}

std::string feelTable(std::span<const FeelRow> rows) {
  std::string out = fmt::format("{:<24}{:<26}{:<26}{:>8}{:>12}{:>12}{:>12}{:>12}{:>12}\n", "scene", "run",
                                "quantity", "samples", "mean", "p50", "p99", "p99.9", "max");
  std::string scene, run;
  for (const FeelRow& r : rows) {
    const bool isSame = r.scene == scene && r.run == run;
    out += fmt::format("{:<24}{:<26}{:<26}{:>8}{:>12.4g}{:>12.4g}{:>12.4g}{:>12.4g}{:>12.4g}\n",
                       r.scene == scene ? "" : r.scene, isSame ? "" : r.run, r.quantity, r.samples, r.mean,
                       r.p50, r.p99, r.p999, r.max);
    scene = r.scene;
    run = r.run;
  }
  return out;
}

std::string feelCsvHeader() {
  return "group,scene,run,quantity,samples,mean,p50,p99,p99_9,max\n";
}

std::string feelCsvLine(const FeelRow& r) {
  return fmt::format("{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", r.group, r.scene, r.run,
                     r.quantity, r.samples, r.mean, r.p50, r.p99, r.p999, r.max);
}

}  // namespace nearfit::bench
