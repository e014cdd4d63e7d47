#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include <glm/vec3.hpp>

#include "core/haptics/dual_step_solver.h"
#include "core/haptics/step_rows.h"

namespace nearfit {

/// The motion that is wanted of the part, and what bounds it.
struct StepGoal {
  StepVector wanted{};       ///< y0 [m]; at most `kLongestStep` long.
  ClearanceCost cost;        ///< Margin, its weight (50 to 1e6), and the least clearance.
  double radius = 0.0;       ///< Of a sphere about the centre of mass that holds the part [m]; >= 0.
  glm::dvec3 gyration{1.0};  ///< Radii of gyration about the principal axes [m]; >= kShortestGyration.
  /// No point of the part may move farther than this in the step [m]; >= 0, infinity for no bound.
  double reach = std::numeric_limits<double>::infinity();
};

/// Goals that are wanted farther away are refused [m]: no such motion is meant, and squares stay finite.
inline constexpr double kLongestStep = 1e9;

/// Less than any body's [m]; keeps a rotation finite.
inline constexpr double kShortestGyration = 1e-12;

/// A pair that holds the part back.
struct ActivePair {
  std::size_t row = 0;      ///< Of the StepRows.
  double multiplier = 0.0;  ///< >= 0; the step is s y0 + sum of multiplier a_row [m].
};

struct StepSolution {
  StepVector y{};      ///< The step [m].
  double t = 0.0;      ///< Clearance that all rows keep, to first order [m].
  double scale = 0.0;  ///< s: y is the optimum for s y0.
  std::array<ActivePair, ActiveRows::kMost> active{};
  std::size_t activeCount = 0;
  double floorMultiplier = 0.0;  ///< Of the floor, scaled as those of rows; >= 0.
  double displacement = 0.0;     ///< mu(y): no point of the part moves farther [m].
  unsigned changes = 0;          ///< Of the set of active rows, in all solves.
  unsigned solves = 0;
  /// How much of the way from standing still to the optimum for s y0 is gone; below 1 where no scale was
  /// found at which the step fits the reach and is worth while: the recovery of the margin alone (s = 0)
  /// would move a point beyond the reach, or only next to nothing of the goal would not.
  double share = 1.0;
  /// Whether that optimum is one. Otherwise y and t still keep all rows, the floor and the reach.
  bool isExact = false;

  std::span<const ActivePair> pairs() const noexcept { return {active.data(), activeCount}; }
};

/// |v| + radius |w| of a step: an upper bound of how far a point of the part moves [m], to first order in the
/// rotation (a rotation vector w moves a point by at most radius |w|, so it holds for any angle).
double displacementOf(const StepVector& y, const StepGoal& goal) noexcept;

/// Whether all numbers of a goal are within what the members say.
bool isUsable(const StepGoal& goal) noexcept;

/// The step of the 6-DOF proxy:
///
///     minimise 1/2 |y - y0|^2 + 1/2 W (t - m)^2   subject to   a_i . y - t >= -d_i,   t >= floor
///
/// with t elastic: contradicting rows, as in a gap narrower than two margins, lower the clearance, and
/// standing still is always allowed. Where y would move a point farther than the reach, y0 is shortened to
/// s y0 until it does not: y(s) is continuous and piecewise linear in s. (A bound on |y| itself would be a
/// multiplier l of |y|^2 / 2, hence y0 / (1 + l), and W shrunk likewise; W is kept here, so that
/// clearance does not give way to a far hand.)
///
/// Exact: rows hold to DualStepSolver::kRowTolerance; y and t differ from the optimum by what so
/// small a change of the d_i makes of it. Changes of the active set are bounded, solves too, and each change
/// costs a scan of the rows. Deterministic. Real-time safe.
///
/// Source: Ortega, Redon and Coquillart, A six degree-of-freedom god-object method, 2007 (the metric);
/// Goldfarb and Idnani 1983 (the method).
class StepProgram {
 public:
  /// Changes of the active rows in a call; problems of contact take some ten.
  static constexpr unsigned kMostChanges = 256;
  /// Times that the program is solved in a call, for values of s.
  static constexpr unsigned kMostSolves = 10;

  /// For a goal that is not usable the part stands still, and the result is not exact.
  StepSolution solve(const StepRows& rows, const StepGoal& goal) noexcept;

 private:
  DualStepSolver solver_;
};

}  // namespace nearfit
