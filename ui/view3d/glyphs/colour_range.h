#pragma once

#include <span>

#include "core/servo/servo_snapshot.h"

namespace nearfit::ui {

/// The distance at the end of the colour scale of minima: chosen by the user, or found from the minima that are
/// drawn. The found one is 1, 2 or 5 times a power of ten and at least twice their median, so that a few far minima
/// do not make all others red. It changes only once the minima have left it well behind, so that colours do not
/// flicker, or once the hand has rested, and is at least a few margins, so that contact is red.
class ColourRange {
 public:
  /// @param chosen  [m]; 0: to be found.
  void choose(double chosen) noexcept { chosen_ = chosen; }
  /// Takes in the minima that are drawn; keeps the range if there are none.
  /// @param margin  Distance in contact [m].
  /// @param time    That of the minima [s].
  void see(std::span<const SnapshotLmd> minima, double margin, double time = 0.0);
  /// True if the hand has rested until a time [s]: the range changes although the minima are the same.
  bool isDue(double time) const noexcept;
  /// Forgets the minima seen so far.
  void forget() noexcept { hasFound_ = false; }
  /// Returns the distance at the end of the scale [m]; > 0.
  double end() const noexcept { return chosen_ > 0.0 ? chosen_ : found_; }

 private:
  /// True if this rest has not been taken into account.
  bool hasRested(double time) const noexcept;

  double chosen_ = 0.0, found_ = 0.01;  ///< [m]
  double wanted_ = 0.0;                 ///< By the minima seen last [m].
  double restWanted_ = 0.0,
         restFrom_ = 0.0;  ///< Range wanted, and time, when the hand came to rest [m], [s].
  bool hasFound_ = false, isRestSeen_ = false;
};

}  // namespace nearfit::ui
