#pragma once

#include <QString>

#include "core/servo/servo_snapshot.h"

namespace nearfit::ui {

/// Min distance of the moving part, as shown.
struct MinDistance {
  /// [m]; infinity if nothing is within the cutoff, or no minimum of a part that is not overlapped is known; NaN if it is
  /// not known.
  double distance = 0.0;
  bool isBound = false;   ///< Only a lower bound is known.
  bool isOfRest = false;  ///< The part overlaps others, which are left out.
};

/// Returns the min distance in `snapshot` to the parts that the moving one does not overlap: minima between meshes that
/// pass through each other are no distance of the parts. NaN if it overlaps more parts than the snapshot names.
MinDistance minDistanceOf(const ServoSnapshot& snapshot) noexcept;

/// Formats it in the user's unit: "0.26 mm", "at least 0.26 mm", "9.40 mm to others", "– (overlapping)".
QString formatMinDistance(const MinDistance& shown);

}  // namespace nearfit::ui
