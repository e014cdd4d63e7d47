#pragma once

#include <optional>

class QWidget;

namespace nearfit::ui {

/// Asks for the distance at the end of the colour scale of minima [m]; nullopt if the user cancels.
/// @param now  Shown at first [m].
std::optional<double> askForColourRange(double now, QWidget* parent);

}  // namespace nearfit::ui
