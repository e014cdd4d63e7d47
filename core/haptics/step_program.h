#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include <glm/vec3.hpp>

#include "core/haptics/dual_step_solver.h"
#include "core/haptics/step_rows.h"

namespace nearfit {

/// The motion wanted of the part, and its limits.
struct StepGoal {
  StepVector wanted{};  ///< y0 [m]; no component beyond `kLongestStep`.
  ClearanceCost cost;   ///< Margin, its weight (50 to 1e6), and the min clearance.
  double radius = 0.0;  ///< Radius of a sphere about the centre of mass that contains the part [m]; >= 0.
  glm::dvec3 gyration{1.0};  ///< Radii of gyration about the principal axes [m]; >= kShortestGyration.
  /// Max travel of any point of the part in the step [m]; >= 0, infinity for no limit.
  double reach = std::numeric_limits<double>::infinity();
};

/// Goals with larger components are refused [m]: no such motion is meant, and squares stay finite.
inline constexpr double kLongestStep = 1e9;

/// Min radius of gyration [m], less than any body's; keeps rotations finite.
inline constexpr double kShortestGyration = 1e-12;

/// A pair that holds the part back.
struct ActivePair {
  std::size_t row = 0;      ///< Index in the StepRows.
  double multiplier = 0.0;  ///< >= 0; the step is s y0 + sum of multiplier a_row [m].
};

/// A step, and how it came about.
struct StepSolution {
  StepVector y{};      ///< The step [m].
  double t = 0.0;      ///< Clearance that all rows keep, to first order [m].
  double scale = 0.0;  ///< s: y is the optimum for s y0.
  std::array<ActivePair, ActiveRows::kMax> active{};
  std::size_t activeCount = 0;
  double floorMultiplier = 0.0;  ///< Multiplier of the floor, on the scale of those of rows; >= 0.
  double displacement = 0.0;     ///< displacementOf(y): no point of the part moves farther [m].
  unsigned changes = 0;          ///< Changes of the active rows, in all solves.
  unsigned solves = 0;           ///< Programs solved.
  /// Share of the way from standing still to the optimum for s y0 that the step takes. Below 1 if no scale
  /// was found at which the step both fits the reach and is worthwhile: recovering the margin alone (s = 0)
  /// would exceed the reach, or only a negligible part of the goal would fit it.
  double share = 1.0;
  /// True if that optimum is exact. y and t keep all rows, the floor and the reach in any case.
  bool isExact = false;

  /// The entries of `active` in use.
  std::span<const ActivePair> pairs() const noexcept { return {active.data(), activeCount}; }
};

/// Upper bound |v| + radius |w| on the travel of any point of the part in a step [m]. It holds for rotations
/// of any angle: a rotation vector w moves a point by at most radius |w|.
double displacementOf(const StepVector& y, const StepGoal& goal) noexcept;

/// True if all numbers of a goal are within the ranges that its members state.
bool isUsable(const StepGoal& goal) noexcept;

/// The step of the 6-DOF proxy:
///
///     minimise 1/2 |y - y0|^2 + 1/2 W (t - m)^2   subject to   a_i . y - t >= -d_i,   t >= floor
///
/// The clearance t is elastic: contradicting rows, as in a gap narrower than two margins, lower it, and
/// standing still is always allowed. If y would move a point farther than the reach, y0 is shortened to s y0
/// until it does not; y(s) is continuous and piecewise linear in s. (A bound on |y| itself would add
/// l |y|^2 / 2 with a multiplier l. That shrinks y0 to y0 / (1 + l), and W likewise. Here W is kept, so that
/// clearance does not give way to a far hand.)
///
/// Exact: rows hold to DualStepSolver::kRowTolerance, and y and t differ from the optimum only by the effect
/// of so small a change of the d_i. Changes of the active set and solves are bounded; each change costs one
/// scan of the rows. Deterministic. Real-time safe.
///
/// Source: Ortega, Redon and Coquillart, A six degree-of-freedom god-object method, 2007 (the metric);
/// Goldfarb and Idnani 1983 (the method).
class StepProgram {
 public:
  /// Max changes of the active rows in a call; contact problems take some ten.
  static constexpr unsigned kMaxChanges = 256;
  /// Max solves in a call, for different values of s.
  static constexpr unsigned kMaxSolves = 10;

  /// Finds the step for a goal. If the goal is not usable, the part stands still and the result is not exact.
  /// @param mostChanges  Max changes of the active rows; if they are too few, the result is not exact.
  StepSolution solve(const StepRows& rows, const StepGoal& goal, unsigned mostChanges = kMaxChanges) noexcept;

 private:
  DualStepSolver solver_;
};

}  // namespace nearfit
