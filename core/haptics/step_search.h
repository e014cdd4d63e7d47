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

/// Where no scale was found at which a step uses as much of the reach, a step that is too long is shortened
/// instead: while a part turns flat, its way depends on the scale only where the scale is next to nothing.
inline constexpr double kLeastUse = 0.5;

/// For those that keep nothing of a point but the step.
struct KeepNothing {
  void best() const noexcept {}
  void above() const noexcept {}
  void useAbove() const noexcept {}
};

/// Solves for one scale of the goal after another until the step fits the reach.
/// @param solver  After begin().
/// @param solve   Gives the Point for a scaled goal y0 and its scale.
/// @param mostSolves  Scales that are tried at most.
/// @param keep    Is told of the point given last: best() that it is the best so far, above() that it is the
///                last that is too long; and useAbove() that this one is taken after all.
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
    // Without one within the reach, the last is shortened.
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
  if (hasAbove && best.displacement < kLeastUse * goal.reach) {
    best = above;
    keep.useAbove();
  }
  shortenToReach(best, solver.standing(), goal.reach);
  best.solves = solves;
  best.changes = solver.changes();
  return best;
}

}  // namespace nearfit
