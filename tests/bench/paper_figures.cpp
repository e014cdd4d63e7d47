#include "tests/bench/paper_figures.h"

#include <limits>
#include <utility>

#include <fmt/format.h>

#include "tests/bench/statistics.h"

namespace nearfit::bench {

PaperFigure paperFigure(const FigureHead& head, std::string method, std::string quantity,
                        std::vector<double> samples, double scale) {
  PaperFigure figure{head.part,         head.scene,          head.setting,
                     std::move(method), std::move(quantity), samples.size()};
  for (double& sample : samples)
    sample *= scale;
  const SampleSummary summary(std::move(samples));
  figure.mean = figure.samples > 0 ? summary.mean() : std::numeric_limits<double>::quiet_NaN();
  figure.p50 = summary.percentile(0.5);
  figure.p90 = summary.percentile(0.9);
  figure.p99 = summary.percentile(0.99);
  figure.p999 = summary.percentile(0.999);
  figure.max = summary.max();
  return figure;
}

PaperFigure paperFigure(const FigureHead& head, std::string method, std::string quantity, double value) {
  return paperFigure(head, std::move(method), std::move(quantity), std::vector{value});
}

std::string paperFigureTable(std::span<const PaperFigure> figures) {
  std::string out, last;
  for (const PaperFigure& f : figures) {
    const std::string title = f.setting.empty() ? fmt::format("{}, {}", f.part, f.scene)
                                                : fmt::format("{}, {}, {}", f.part, f.scene, f.setting);
    if (title != last) {
      out += fmt::format("\n{:<70}{:>8}{:>12}{:>12}{:>12}{:>12}{:>12}{:>12}\n", title, "samples", "mean",
                         "p50", "p90", "p99", "p99.9", "max");
    }
    last = title;
    out += fmt::format("{:<22}{:<48}{:>8}{:>12.4g}{:>12.4g}{:>12.4g}{:>12.4g}{:>12.4g}{:>12.4g}\n", f.method,
                       f.quantity, f.samples, f.mean, f.p50, f.p90, f.p99, f.p999, f.max);
  }
  return out;
}

std::string paperFigureCsvHeader() {
  return "part,scene,setting,method,quantity,samples,mean,p50,p90,p99,p99_9,max\n";
}

std::string paperFigureCsvLine(const PaperFigure& f) {
  return fmt::format("{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", f.part, f.scene,
                     f.setting, f.method, f.quantity, f.samples, f.mean, f.p50, f.p90, f.p99, f.p999, f.max);
}

}  // namespace nearfit::bench
