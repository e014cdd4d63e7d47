#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/report/html/html_writer.h"

namespace nearfit {

/// Max number of curves that a plot draws, the nearest parts, and of points on each.
constexpr std::size_t kMaxPlotCurves = 8, kMaxPlotPoints = 400;

/// The clearance of what moves on a path to one other part.
struct PlotCurve {
  std::string name;
  std::span<const double> distances;  ///< By time [m]; infinity beyond the range of the plot.
};

struct ClearancePlot {
  std::span<const double> times;     ///< Ascending [s].
  std::vector<PlotCurve> curves;     ///< One with a distance for each time.
  double range = 0.0;                ///< Distances were searched for up to this [m]; > 0.
  std::optional<double> separation;  ///< Kept all along the path, as a certificate says [m].
};

struct ClearancePlotPoint {
  double time = 0.0, distance = 0.0;
};

/// Points of a curve thinned to kMaxPlotPoints: of each stretch of times the place of its least distance, so that no
/// narrow place is lost.
std::vector<ClearancePlotPoint> thinnedCurve(std::span<const double> times,
                                             std::span<const double> distances);

/// The curves to draw: those that come nearest, the nearest first.
std::vector<PlotCurve> nearestCurves(const ClearancePlot& plot);

/// Writes the plot as SVG: distance in mm over time in s, with a legend and the separation as a line.
void putClearancePlot(const ClearancePlot& plot, HtmlWriter& html);

}  // namespace nearfit
