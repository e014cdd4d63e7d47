#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace nearfit::bench {

/// Samples of one quantity, summed up: a line of `nearfit-bench paper --csv`.
struct PaperFigure {
  std::string part;      ///< Of the command: appendix, cutoff, triangles, judge or arguments.
  std::string scene;     ///< Row of the appendix, or body.
  std::string setting;   ///< Cutoff or triangles, in sweeps; else empty.
  std::string method;    ///< Who answered.
  std::string quantity;  ///< With its unit.
  std::size_t samples = 0;
  double mean = 0.0, p50 = 0.0, p90 = 0.0, p99 = 0.0, p999 = 0.0, max = 0.0;  ///< NaN without samples.
};

/// What the figures of one measurement have in common.
struct FigureHead {
  std::string part, scene, setting;
};

/// @param scale  Into the unit that `quantity` names.
PaperFigure paperFigure(const FigureHead& head, std::string method, std::string quantity,
                        std::vector<double> samples, double scale = 1.0);
/// Of one number.
PaperFigure paperFigure(const FigureHead& head, std::string method, std::string quantity, double value);

/// A line each, with a headline where scene or setting changes.
std::string paperFigureTable(std::span<const PaperFigure> figures);
std::string paperFigureCsvHeader();
std::string paperFigureCsvLine(const PaperFigure& figure);

}  // namespace nearfit::bench
