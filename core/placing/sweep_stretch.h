#pragma once

#include <cmath>
#include <limits>

namespace nearfit {

/// The part of a straight way on which nothing yet says that two convex things are apart.
struct SweepStretch {
  double from = 0.0, to = std::numeric_limits<double>::infinity();

  bool isEmpty() const noexcept { return from > to; }

  /// Cuts off where the moving one's shadow on an axis is apart from the other's.
  /// @param gap    From the fixed shadow's upper end to the moving one's lower end, at the start.
  /// @param depth  From the fixed one's lower end to the moving one's upper end.
  /// @param speed  Of the moving one along the axis.
  /// Whether this axis is now the one that says where they come together.
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
