#pragma once

#include <optional>
#include <utility>

class QWidget;

namespace nearfit::ui {

/// How a motion is saved as a path.
struct PathWishes {
  double from = 0.0, to = 0.0;  ///< On the timeline [s].
  std::optional<double> thin,
      smooth;               ///< Max distance that a point of the part may move [m]; no value: not at all.
  double separation = 0.0;  ///< Distance to other parts that thinning and smoothing keep [m].
};

/// Asks how to save a motion as a path.
/// @param range       Offered at first [s].
/// @param duration    Of the motion [s].
/// @param separation  Offered at first [m], rounded down to the digits that are shown.
/// @return std::nullopt if the user cancels.
std::optional<PathWishes> askForPathWishes(std::pair<double, double> range, double duration,
                                           double separation, QWidget* parent);

/// Asks for the separation that a path is certified with [m].
/// @param offered  At first [m], rounded down to the digits that are shown.
std::optional<double> askForSeparation(double offered, QWidget* parent);

/// Asks for the resolution of a swept volume [m].
/// @param offered  At first [m].
std::optional<double> askForResolution(double offered, QWidget* parent);

}  // namespace nearfit::ui
