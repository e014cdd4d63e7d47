#pragma once

#include "core/haptics/step_program.h"
#include "core/haptics/trust_search.h"

namespace nearfit {

/// Of a step at one scale of the goal: its displacement, and the active rows of the solver.
StepSolution describeStep(const DualStepSolver& solver, const DualStepSolver::Point& point,
                          const StepGoal& goal, double scale) noexcept;

/// Shortens the way from standing still, which all rows allow since they allow both its ends, until the step
/// is within the reach. A step that is not finite becomes standing still.
void shortenToReach(StepSolution& step, const DualStepSolver::Point& still, double reach) noexcept;

/// Standing still, for a goal that is not usable.
StepSolution standStill(const StepRows& rows) noexcept;

/// Solves for one scale of the goal after another until the step fits the reach.
/// @param solver  After begin().
/// @param solve   Gives the Point for a scaled goal y0 and its scale.
/// @param mostSolves  Scales that are tried at most.
/// @param keep    Is told that the point given last is the best so far.
template <class Solve, class Keep>
StepSolution searchStep(const DualStepSolver& solver, const StepGoal& goal, unsigned mostSolves, Solve solve,
                        Keep keep) noexcept {
  StepSolution best;
  unsigned solves = 0;
  bool isFound = false;
  for (TrustSearch search(goal.reach, mostSolves); !search.isDone();) {
    const double scale = search.scale();
    StepVector wanted = goal.wanted;
    for (double& y : wanted)
      y *= scale;
    const StepSolution here = describeStep(solver, solve(wanted, scale), goal, scale);
    ++solves;
    const bool isWithin = search.report(here.displacement);
    // Without one within the reach, the last is shortened.
    if (isWithin || !isFound) {
      best = here;
      keep();
    }
    isFound = isFound || isWithin;
  }
  shortenToReach(best, solver.standing(), goal.reach);
  best.solves = solves;
  best.changes = solver.changes();
  return best;
}

}  // namespace nearfit
