#pragma once

#include <cmath>
#include <limits>

namespace nearfit {

/// The range of a straight motion on which no tested axis separates two convex bodies.
struct SweepStretch {
  /// Travel along the direction [m].
  double from = 0.0, to = std::numeric_limits<double>::infinity();

  bool isEmpty() const noexcept { return from > to; }

  /// Removes the range on which an axis separates them.
  /// @param gap    From the fixed body's upper end on the axis to the moving one's lower end, at the start.
  /// @param depth  From the fixed body's lower end to the moving one's upper end.
  /// @param speed  Of the moving body along the axis.
  /// @return True if this axis now determines where they touch.
  bool cut(double gap, double depth, double speed) noexcept {
    if (speed == 0.0) {
      if (gap > 0.0 || depth < 0.0) to = -1.0;
      return false;
    }
    const double enter = speed < 0.0 ? -gap / speed : -depth / speed;
    const double leave = speed < 0.0 ? -depth / speed : -gap / speed;
    to = std::fmin(to, leave);
    if (!(enter > from)) return false;
    from = enter;
    return true;
  }
};

}  // namespace nearfit
