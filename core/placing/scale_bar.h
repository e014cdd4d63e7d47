#pragma once

namespace nearfit {

/// Returns the longest length for a scale bar that is at most `max`: 1, 2 or 5 times a power of ten units [m].
/// Returns 0 unless both lengths are finite and above 0.
/// @param max   Room for the bar [m].
/// @param unit  Length of the unit that the bar's label is in [m].
double scaleBarLength(double max, double unit) noexcept;

}  // namespace nearfit
