#pragma once

#include <cstddef>
#include <limits>

#include "core/haptics/active_rows.h"
#include "core/haptics/step_rows.h"

namespace nearfit {

/// Cost of a step: 1/2 |y - y0|^2 + 1/2 weight (t - margin)^2, subject to t >= floor.
struct ClearanceCost {
  double margin = 0.0;  ///< Wanted clearance [m].
  double weight = 1.0;  ///< Weight of clearance against motion; > 0.
  double floor = 0.0;   ///< Min clearance allowed [m]; -infinity for none.
};

/// Solves the program of a step for a sequence of goals y0. Finds the point nearest to the unconstrained
/// optimum, in seven dimensions (y, and t scaled by the root of its weight), that satisfies the floor and all
/// rows a_i . y - t >= -d_i.
///
/// Source: Goldfarb and Idnani, A numerically stable dual method for solving strictly convex quadratic
/// programs, 1983. Deviations: the Hessian is the identity, so only an orthogonal basis of the active normals
/// is factored; the point and the multipliers are recomputed from the active rows whenever a row becomes
/// active, so errors do not accumulate; a solve starts from the active rows of the last one, without those
/// whose multipliers have become negative. Real-time safe.
class DualStepSolver {
 public:
  /// Id of the floor among the active rows.
  static constexpr std::size_t kFloor = std::numeric_limits<std::size_t>::max();

  /// Rows hold to this fraction of the lengths involved (y0, margin, min distance) times the largest row
  /// norm: a hundred roundings.
  static constexpr double kRowTolerance = 2e-14;

  /// Multipliers negative by less than this fraction of the largest count as zero.
  static constexpr double kSignTolerance = 1e-9;

  /// Coefficients of a normal that are smaller than this fraction of its largest count as rounding.
  static constexpr double kPartTolerance = 1e-12;

  /// A step and its clearance.
  struct Point {
    StepVector y{};  ///< [m]
    double t = 0.0;  ///< [m]
    /// True if this is the optimum, to the tolerances. Otherwise it is as far as all rows allow on the way
    /// from standing still to where the method stopped.
    bool isExact = false;
  };

  /// Starts a program with no active rows.
  /// @param rows         Must stay alive and unchanged until the last solve().
  /// @param cost         A floor above the min distance is lowered to it, so that y = 0 is feasible.
  /// @param mostChanges  Max changes of the active rows, over all solves.
  void begin(const StepRows& rows, const ClearanceCost& cost, unsigned mostChanges) noexcept;

  /// Solves for the goal y0 [m]; finite.
  Point solve(const StepVector& y0) noexcept;

  /// Standing still, with the clearance available: at most the margin, at least the floor.
  Point standing() const noexcept;

  /// Active rows of the last solve; ids are row indices or kFloor.
  const ActiveRows& active() const noexcept { return active_; }
  /// Changes of the active rows since begin().
  unsigned changes() const noexcept { return changes_; }

 private:
  struct Violation {
    std::size_t id;
    double by;  ///< [m]
  };
  struct HalfSpace {
    ProgramVector n;
    double b;
  };

  HalfSpace halfSpace(std::size_t id) const noexcept;
  double clearanceOf(const ProgramVector& z) const noexcept;
  Violation mostViolated(const ProgramVector& z) const noexcept;
  ProgramVector restart(const ProgramVector& z0) noexcept;
  bool enter(const Violation& violation, const ProgramVector& z0, ProgramVector& z) noexcept;
  Point asFarAsAllowed(const StepVector& y, double t) const noexcept;

  const StepRows* rows_ = nullptr;
  ClearanceCost cost_;
  double inverseRoot_ = 1.0;  ///< 1 / sqrt(weight).
  double leastDistance_ = 0.0, tolerance_ = 0.0;
  unsigned changes_ = 0, mostChanges_ = 0;
  ActiveRows active_;
};

}  // namespace nearfit
