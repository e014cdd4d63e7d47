#pragma once

#include <algorithm>

#include "core/haptics/step_program.h"

namespace nearfit {

/// Finds s in [0, 1] at which a continuous, nearly linear function that is zero or small at s = 0 lies
/// within [kMinShare, 1] of a bound; s = 1 if it is below the bound there. Regula falsi, with halving
/// when it stalls. The caller evaluates: until isDone(), compute the value at scale() and report() it.
/// Real-time safe.
class TrustSearch {
 public:
  static constexpr double kMinShare = 0.9;
  /// Share of the bound that is aimed at: rounding and kinks may put the value beside it.
  static constexpr double kAim = 0.95;
  /// After this many values, all above the bound, s = 0 is tried whatever the last two predict.
  static constexpr unsigned kPatience = 4;

  /// @param mostValues  Max values to evaluate.
  TrustSearch(double bound, unsigned mostValues) noexcept : bound_(bound), mostValues_(mostValues) {}

  /// The s to evaluate next.
  double scale() const noexcept { return scale_; }
  bool isDone() const noexcept { return isDone_; }

  /// Records the value at scale(). Returns true if it is the best so far: within the bound, at the
  /// largest such s.
  bool report(double value) noexcept {
    ++values_;
    const bool isWithin = value <= bound_;
    if (isWithin) {
      low_ = scale_;
      lowValue_ = value;
    } else {
      // No value within the bound is known: extrapolate the last two to s = 0.
      if (low_ < 0.0 && values_ > 1)
        lowValue_ = std::max(0.0, value - scale_ * (highValue_ - value) / (high_ - scale_));
      high_ = scale_;
      highValue_ = value;
    }
    const bool isEnough = isWithin && (scale_ == 1.0 || value >= kMinShare * bound_);
    isDone_ = isEnough || values_ == mostValues_ || high_ <= std::max(low_, 0.0);
    repeats_ = isWithin == lastWasWithin_ ? repeats_ + 1 : 0;
    lastWasWithin_ = isWithin;
    if (!isDone_) scale_ = next();
    return isWithin;
  }

 private:
  double next() const noexcept {
    if (low_ < 0.0 && (values_ == kPatience || lowValue_ >= kAim * bound_)) return 0.0;
    const double from = std::max(low_, 0.0);
    if (low_ >= 0.0 && repeats_ >= 2) return 0.5 * (from + high_);
    const double share = (kAim * bound_ - lowValue_) / (highValue_ - lowValue_);
    return from + std::clamp(share, 0.0, 1.0) * (high_ - from);
  }

  double bound_, scale_ = 1.0;
  double low_ = -1.0, lowValue_ = 0.0;  ///< low_ is negative while no value within the bound is known.
  double high_ = 1.0, highValue_ = 0.0;
  unsigned mostValues_, values_ = 0, repeats_ = 0;
  bool lastWasWithin_ = false, isDone_ = false;
};

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
