#include "core/haptics/friction_program.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/haptics/step_search.h"

namespace nearfit {
namespace {

bool isUsableProgram(const StepRows& rows, const FrictionGoal& goal) noexcept {
  const auto isShort = [](const glm::dvec3& arm) {
    return std::abs(arm.x) <= kLongestStep && std::abs(arm.y) <= kLongestStep &&
           std::abs(arm.z) <= kLongestStep;
  };
  if (!nearfit::isUsable(goal.step) || !(goal.coefficient >= 0.0) || !std::isfinite(goal.coefficient))
    return false;
  if (!goal.directions.empty() && goal.directions.size() != rows.size()) return false;
  return goal.coefficient == 0.0 ||
         (goal.arms.size() == rows.size() && std::all_of(goal.arms.begin(), goal.arms.end(), isShort));
}

/// Length scale that changes of pushes are compared with [m].
double lengthOf(const StepVector& y, double margin) noexcept {
  double squared = margin * margin;
  for (const double value : y)
    squared += value * value;
  return std::sqrt(squared);
}

}  // namespace

DualStepSolver::Point FrictionProgram::alternate(const StepRows& rows, const FrictionGoal& goal,
                                                 const StepVector& wanted, Attempt& best) noexcept {
  const ArmMetric metric{goal.principalFromStep, goal.step.gyration, goal.locked};
  const glm::dvec3* const directions = goal.directions.empty() ? nullptr : goal.directions.data();
  const double length = lengthOf(wanted, goal.step.cost.margin);
  best.unsettled = std::numeric_limits<double>::infinity();
  for (unsigned sweep = 1; sweep <= kMaxSweeps; ++sweep) {
    Attempt attempt{contacts_};
    const DualStepSolver::Point point = solver_.solve(contacts_.pushed(wanted));
    ++sweeps_;
    const bool isOneGone = contacts_.follow(rows, solver_.active(), goal.arms.data(), directions, metric);
    const double share = sweep < kDampedSweep ? 1.0 : 0.5;
    attempt.unsettled = contacts_.relax(solver_.active(), point.y, goal.coefficient, length, share);
    // A push whose row is no longer active counts in full.
    if (isOneGone) attempt.unsettled = std::max(attempt.unsettled, attempt.applied.largest());
    attempt.isSettled = point.isExact && attempt.unsettled <= kSettled * length;
    const bool isExact = attempt.isSettled && attempt.unsettled <= FrictionContacts::kRounding * length;
    const bool isBest = attempt.unsettled < best.unsettled;
    if (isBest || isExact) best = attempt;
    if (isExact || (isBest && attempt.isSettled && sweep >= kPatience)) return point;
    if (best.isSettled && sweep >= kPatience) break;
  }
  ++sweeps_;
  contacts_ = best.applied;
  return solver_.solve(contacts_.pushed(wanted));
}

FrictionSolution FrictionProgram::solve(const StepRows& rows, const FrictionGoal& goal) noexcept {
  FrictionSolution out;
  if (!isUsableProgram(rows, goal)) {
    out.step = standStill(rows);
    return out;
  }
  solver_.begin(rows, goal.step.cost, kMaxChanges);
  contacts_.clear();
  sweeps_ = 0;
  Kept attempts;
  double lastScale = 1.0;
  out.step = searchStep(
      solver_, goal.step, kMaxScales,
      [&](const StepVector& wanted, double scale) noexcept {
        // Pushes are roughly proportional to the goal.
        contacts_.scale(lastScale > 0.0 ? scale / lastScale : 0.0);
        lastScale = scale;
        return alternate(rows, goal, wanted, attempts.last);
      },
      attempts);
  const Attempt& best = attempts.chosen;
  for (std::size_t i = 0; i < best.applied.size(); ++i)
    out.pushes[out.pushCount++] = {best.applied[i].row, best.applied[i].pushVector()};
  out.sweeps = sweeps_;
  out.unsettled = best.unsettled;
  out.isSettled = best.isSettled;
  return out;
}

}  // namespace nearfit
