#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/haptics/step_rows.h"

namespace nearfit {

/// Motions that joints lock at a pose, to first order, in the mass metric; and the step that leads back to where they
/// hold. Real-time safe.
class LockedMotions {
 public:
  static constexpr std::size_t kMax = 6;
  /// A row counts as dependent on those before it if less than this share of it is independent. Features that are
  /// picked as parallel are so to far better than this, and a correction along a row that is independent by less would
  /// be a thousand times as long as what is amiss.
  static constexpr double kDependence = 1e-3;

  bool isEmpty() const noexcept { return count_ == 0; }
  /// Orthonormal.
  std::span<const StepVector> directions() const noexcept { return {directions_.data(), count_}; }
  /// The least step y with a . y = b for all rows that were locked [m].
  const StepVector& correction() const noexcept { return correction_; }

  /// Locks the row a: the part should move by a . y = b. Rows that are dependent add nothing, whatever their b.
  void lock(const StepVector& a, double b) noexcept;

  /// The step without what it has along the locked directions.
  StepVector freePart(StepVector y) const noexcept;

 private:
  std::array<StepVector, kMax> directions_{};
  std::array<double, kMax> amounts_{};  ///< Of each direction in the correction.
  StepVector correction_{};
  std::size_t count_ = 0;
};

}  // namespace nearfit
