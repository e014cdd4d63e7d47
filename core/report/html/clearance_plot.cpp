#include "core/report/html/clearance_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

#include "core/math/round_number.h"
#include "core/text/utf8.h"

namespace nearfit {
namespace {

/// Size of the plot, and of its frame's rims, in units of SVG that are pixels on a screen.
constexpr double kWidth = 720.0, kHeight = 300.0, kLeft = 64.0, kRight = 12.0, kTop = 12.0, kBottom = 44.0;
constexpr double kLegendLine = 18.0;
/// Ticks of an axis that are aimed at.
constexpr double kTicks = 6.0;
constexpr double kMillimetres = 1e3;
/// Width of the separation's label as a share of the plot's.
constexpr double kSeparationShare = 0.3;
/// Names are cut in the legend to what fits [bytes]; tables have them whole.
constexpr std::size_t kLegendBytes = 60;

/// Dark on white, and different with the common forms of colour blindness. Source: P. Tol, Colour schemes, 2021, "bright"
/// and "muted".
constexpr std::array<const char*, kMaxPlotCurves> kCurveColours{"#4477AA", "#EE6677", "#228833", "#AA3377",
                                                                "#66CCEE", "#999933", "#332288", "#882255"};

double leastOfCurve(const PlotCurve& curve) {
  return curve.distances.empty() ? std::numeric_limits<double>::infinity()
                                 : *std::ranges::min_element(curve.distances);
}

/// One axis: values to places.
struct Axis {
  double from, to;    ///< Values.
  double start, end;  ///< Places.

  double placeOf(double value) const { return start + (end - start) * (value - from) / (to - from); }
  /// Values of the ticks, on round numbers.
  std::vector<double> ticks() const {
    std::vector<double> values;
    const double step = roundedUp((to - from) / kTicks);
    for (double i = std::ceil(from / step - 1e-9); i * step <= to + 1e-9 * step; i += 1.0)
      values.push_back(i * step);
    return values;
  }
};

/// Multiples of a step are counted down to zero from below, too.
std::string tickText(double value) {
  return fmt::format("{:.6g}", value == 0.0 ? 0.0 : value);
}

std::string placeText(double place) {
  return fmt::format("{:.2f}", place);
}

std::string legendName(const std::string& name) {
  return name.size() > kLegendBytes ? truncatedUtf8(name, kLegendBytes) + "…" : name;
}

class PlotWriter {
 public:
  PlotWriter(const ClearancePlot& plot, HtmlWriter& html)
      : plot_(plot),
        html_(html),
        curves_(nearestCurves(plot)),
        legend_(kLegendLine * static_cast<double>(curves_.size())) {
    double most = plot.separation.value_or(0.0);
    for (const PlotCurve& curve : curves_) {
      for (const double distance : curve.distances)
        if (std::isfinite(distance)) most = std::max(most, distance);
    }
    const double first = plot.times.empty() ? 0.0 : plot.times.front();
    const double last = plot.times.empty() ? 1.0 : plot.times.back();
    time_ = {first, last > first ? last : first + 1.0, kLeft, kWidth - kRight};
    distance_ = {0.0, kMillimetres * (most > 0.0 ? 1.05 * most : plot.range), kHeight - kBottom, kTop};
  }

  void write() {
    const std::string height = placeText(kHeight + legend_);
    html_.element("svg",
                  {{"viewBox", fmt::format("0 0 {} {}", kWidth, height)},
                   {"width", placeText(kWidth)},
                   {"height", height},
                   {"role", "img"},
                   {"aria-label", "Clearance along the path over time"},
                   {"font-family", "sans-serif"},
                   {"font-size", "12"}},
                  [&] {
                    writeAxes();
                    for (std::size_t i = 0; i < curves_.size(); ++i)
                      writeCurve(i);
                    writeSeparation();
                  });
  }

 private:
  void line(double x1, double y1, double x2, double y2, const char* colour, const char* dashes = "none") {
    html_.add("path",
              {{"d", fmt::format("M{} {}L{} {}", placeText(x1), placeText(y1), placeText(x2), placeText(y2))},
               {"stroke", colour},
               {"stroke-dasharray", dashes},
               {"fill", "none"}},
              "");
  }
  void label(double x, double y, const char* anchor, std::string_view text) {
    html_.add("text", {{"x", placeText(x)}, {"y", placeText(y)}, {"text-anchor", anchor}}, text);
  }

  void writeAxes() {
    for (const double value : time_.ticks()) {
      const double x = time_.placeOf(value);
      line(x, kTop, x, kHeight - kBottom, "#dddddd");
      label(x, kHeight - kBottom + 16.0, "middle", tickText(value));
    }
    for (const double value : distance_.ticks()) {
      const double y = distance_.placeOf(value);
      line(kLeft, y, kWidth - kRight, y, "#dddddd");
      label(kLeft - 6.0, y + 4.0, "end", tickText(value));
    }
    line(kLeft, kTop, kLeft, kHeight - kBottom, "#444444");
    line(kLeft, kHeight - kBottom, kWidth - kRight, kHeight - kBottom, "#444444");
    label(0.5 * (kLeft + kWidth - kRight), kHeight - 8.0, "middle", "time [s]");
    label(2.0, kTop + 2.0, "start", "mm");
  }

  void writeCurve(std::size_t index) {
    std::string d;
    bool isDown = false;
    for (const ClearancePlotPoint& point : thinnedCurve(plot_.times, curves_[index].distances)) {
      if (std::isfinite(point.distance))
        d += fmt::format("{}{} {}", isDown ? 'L' : 'M', placeText(time_.placeOf(point.time)),
                         placeText(distance_.placeOf(kMillimetres * point.distance)));
      isDown = std::isfinite(point.distance);
    }
    const char* colour = kCurveColours[index];
    if (!d.empty())
      html_.add("path", {{"d", d}, {"stroke", colour}, {"stroke-width", "1.5"}, {"fill", "none"}}, "");
    const double y = kHeight + kLegendLine * (static_cast<double>(index) + 0.5);
    line(kLeft, y, kLeft + 24.0, y, colour);
    const PlotCurve& curve = curves_[index];
    label(kLeft + 32.0, y + 4.0, "start",
          fmt::format("{}: at least {:.4g} mm", legendName(curve.name), kMillimetres * leastOfCurve(curve)));
  }

  /// Min distance [m] in a stretch of the plot's width: shares from its left end.
  double leastBetween(double from, double to) const {
    double least = std::numeric_limits<double>::infinity();
    const double first = time_.from, all = time_.to - time_.from;
    for (const PlotCurve& curve : curves_) {
      for (std::size_t i = 0; i < std::min(curve.distances.size(), plot_.times.size()); ++i) {
        const double share = (plot_.times[i] - first) / all;
        if (share >= from && share <= to) least = std::min(least, curve.distances[i]);
      }
    }
    return least;
  }

  void writeSeparation() {
    if (!plot_.separation) return;
    const double y = distance_.placeOf(kMillimetres * *plot_.separation);
    line(kLeft, y, kWidth - kRight, y, "#BB0000", "6 4");
    // A path into a tight place is near the line at its end, and one out of it at its start.
    const bool isAtStart = leastBetween(0.0, kSeparationShare) > leastBetween(1.0 - kSeparationShare, 1.0);
    label(isAtStart ? kLeft + 4.0 : kWidth - kRight - 4.0, y - 4.0, isAtStart ? "start" : "end",
          fmt::format("certified separation {:.4g} mm", kMillimetres * *plot_.separation));
  }

  const ClearancePlot& plot_;
  HtmlWriter& html_;
  std::vector<PlotCurve> curves_;
  double legend_;  ///< Height of the legend.
  Axis time_{}, distance_{};
};

}  // namespace

std::vector<ClearancePlotPoint> thinnedCurve(std::span<const double> times,
                                             std::span<const double> distances) {
  const std::size_t count = std::min(times.size(), distances.size());
  const std::size_t stretches = std::min(count, kMaxPlotPoints);
  std::vector<ClearancePlotPoint> points;
  for (std::size_t i = 0; i < stretches; ++i) {
    const std::size_t from = i * count / stretches, to = (i + 1) * count / stretches;
    std::size_t least = from;
    for (std::size_t k = from + 1; k < to; ++k) {
      if (distances[k] < distances[least]) least = k;
    }
    points.push_back({times[least], distances[least]});
  }
  return points;
}

std::vector<PlotCurve> nearestCurves(const ClearancePlot& plot) {
  std::vector<std::pair<double, const PlotCurve*>> near;
  for (const PlotCurve& curve : plot.curves) {
    const double least = leastOfCurve(curve);
    if (std::isfinite(least)) near.emplace_back(least, &curve);
  }
  std::ranges::stable_sort(near, {}, &std::pair<double, const PlotCurve*>::first);
  near.resize(std::min(near.size(), kMaxPlotCurves));
  std::vector<PlotCurve> curves;
  for (const auto& [least, curve] : near)
    curves.push_back(*curve);
  return curves;
}

void putClearancePlot(const ClearancePlot& plot, HtmlWriter& html) {
  PlotWriter(plot, html).write();
}

}  // namespace nearfit
