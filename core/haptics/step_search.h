#pragma once

#include "core/haptics/step_program.h"
#include "core/haptics/trust_search.h"

namespace nearfit {

/// The solver's step at one scale of the goal, with its displacement and active rows.
StepSolution describeStep(const DualStepSolver& solver, const DualStepSolver::Point& point,
                          const StepGoal& goal, double scale) noexcept;

/// Shortens a step towards standing still until it is within the reach. All rows allow that, since they allow
/// both ends. A step that is not finite becomes standing still.
void shortenToReach(StepSolution& step, const DualStepSolver::Point& still, double reach) noexcept;

/// Standing still, for a goal that is not usable.
StepSolution standStill(const StepRows& rows) noexcept;

/// If no scale was found at which a step uses this share of the reach, a step that is too long is shortened
/// instead: while a part turns flat, its step depends on the scale only for scales near zero.
inline constexpr double kMinUse = 0.5;

/// The `keep` of callers that need nothing but the step.
struct KeepNothing {
  void best() const noexcept {}
  void above() const noexcept {}
  void useAbove() const noexcept {}
};

/// Solves for one scale of the goal after another until the step fits the reach.
/// @param solver      After begin().
/// @param mostSolves  Max scales tried.
/// @param solve       Returns the Point for a scaled goal y0 and its scale.
/// @param keep        Told about the last point: best() if it is the best so far, above() if it is too long.
///                    Finally useAbove() if the last point that was too long is used after all.
template <class Solve, class Keep>
StepSolution searchStep(const DualStepSolver& solver, const StepGoal& goal, unsigned mostSolves, Solve solve,
                        Keep&& keep) noexcept {
  StepSolution best, above;
  unsigned solves = 0;
  bool isFound = false, hasAbove = false;
  for (TrustSearch search(goal.reach, mostSolves); !search.isDone();) {
    const double scale = search.scale();
    StepVector wanted = goal.wanted;
    for (double& y : wanted)
      y *= scale;
    const StepSolution here = describeStep(solver, solve(wanted, scale), goal, scale);
    ++solves;
    const bool isWithin = search.report(here.displacement);
    // Until a step is within the reach, the last one is kept and shortened.
    if (isWithin || !isFound) {
      best = here;
      keep.best();
    }
    isFound = isFound || isWithin;
    if (!isWithin) {
      above = here;
      hasAbove = true;
      keep.above();
    }
  }
  if (hasAbove && best.displacement < kMinUse * goal.reach) {
    best = above;
    keep.useAbove();
  }
  shortenToReach(best, solver.standing(), goal.reach);
  best.solves = solves;
  best.changes = solver.changes();
  return best;
}

}  // namespace nearfit
