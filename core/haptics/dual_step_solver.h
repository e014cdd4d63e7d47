#pragma once

#include <cstddef>
#include <limits>

#include "core/haptics/active_rows.h"
#include "core/haptics/step_rows.h"

namespace nearfit {

/// What a step costs: 1/2 |y - y0|^2 + 1/2 weight (t - margin)^2, with t >= floor.
struct ClearanceCost {
  double margin = 0.0;  ///< Clearance that is wanted [m].
  double weight = 1.0;  ///< Of clearance against motion; > 0.
  double floor = 0.0;   ///< Least clearance allowed [m]; -infinity for none.
};

/// The program of a step for one y0 after another: the nearest point in seven dimensions (y, and t scaled by
/// the root of its weight) to the unconstrained one, under all rows a_i . y - t >= -d_i and the floor.
///
/// Source: Goldfarb and Idnani, A numerically stable dual method for solving strictly convex quadratic
/// programs, 1983. Deviations: the Hessian is the identity, so that an orthogonal basis of the active normals
/// is all that is factored; the point and the multipliers are computed anew from the active rows whenever a
/// row has become active, so that errors do not add up; a solve starts from the active rows of the last, less
/// those whose multipliers have become negative. Real-time safe.
class DualStepSolver {
 public:
  /// Id of the floor among the active rows.
  static constexpr std::size_t kFloor = std::numeric_limits<std::size_t>::max();

  /// Rows hold to this fraction of the lengths in play (y0, margin, least distance) times the largest row:
  /// a hundred roundings.
  static constexpr double kRowTolerance = 2e-14;

  /// Multipliers that are negative by less than this fraction of the largest are zero with rounding.
  static constexpr double kSignTolerance = 1e-9;

  /// Parts of a normal that are smaller than this fraction of its largest are rounding.
  static constexpr double kPartTolerance = 1e-12;

  struct Point {
    StepVector y{};
    double t = 0.0;
    /// It is the optimum, to the tolerances. Otherwise the way from standing still to where the method stood
    /// was gone as far as all rows allow.
    bool isExact = false;
  };

  /// Forgets the active rows. @param rows  Must stay as they are until the last solve.
  /// A floor above the least distance is lowered to it: y = 0 must be allowed.
  /// @param mostChanges  Of the active rows, in all solves together.
  void begin(const StepRows& rows, const ClearanceCost& cost, unsigned mostChanges) noexcept;

  /// @param y0  Finite.
  Point solve(const StepVector& y0) noexcept;

  /// Standing still, with the clearance that there is, at most the margin (or the floor).
  Point standing() const noexcept;

  const ActiveRows& active() const noexcept { return active_; }
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
  double inverseRoot_ = 1.0;  ///< Of the weight.
  double leastDistance_ = 0.0, tolerance_ = 0.0;
  unsigned changes_ = 0, mostChanges_ = 0;
  ActiveRows active_;
};

}  // namespace nearfit
