#include "core/haptics/step_program.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/haptics/step_search.h"

namespace nearfit {
namespace {

/// Keeps a step that was shortened to the reach below it despite rounding.
constexpr double kInside = 1.0 - 1e-12;

}  // namespace

double displacementOf(const StepVector& y, const StepGoal& goal) noexcept {
  const glm::dvec3 v(y[0], y[1], y[2]);
  const glm::dvec3 w = glm::dvec3(y[3], y[4], y[5]) / goal.gyration;
  return glm::length(v) + goal.radius * glm::length(w);
}

bool isUsable(const StepGoal& goal) noexcept {
  const auto isShort = [](double value) { return std::abs(value) <= kLongestStep; };
  const ClearanceCost& cost = goal.cost;
  const bool isCostUsable =
      isShort(cost.margin) && cost.weight > 0.0 && std::isfinite(cost.weight) && cost.floor <= kLongestStep;
  const auto isRadius = [&](double value) { return value >= kShortestGyration && isShort(value); };
  const bool isBodyUsable = goal.radius >= 0.0 && isShort(goal.radius) && isRadius(goal.gyration.x) &&
                            isRadius(goal.gyration.y) && isRadius(goal.gyration.z);
  return isCostUsable && isBodyUsable && goal.reach >= 0.0 &&
         std::all_of(goal.wanted.begin(), goal.wanted.end(), isShort);
}

StepSolution describeStep(const DualStepSolver& solver, const DualStepSolver::Point& point,
                          const StepGoal& goal, double scale) noexcept {
  StepSolution out;
  out.y = point.y;
  out.t = point.t;
  out.scale = scale;
  out.isExact = point.isExact;
  out.displacement = displacementOf(point.y, goal);
  const ActiveRows& active = solver.active();
  for (std::size_t i = 0; i < active.size(); ++i) {
    const double multiplier = std::max(0.0, active.multiplier(i));
    if (active.id(i) == DualStepSolver::kFloor)
      out.floorMultiplier = multiplier;
    else
      out.active[out.activeCount++] = {active.id(i), multiplier};
  }
  return out;
}

void shortenToReach(StepSolution& step, const DualStepSolver::Point& still, double reach) noexcept {
  if (!std::isfinite(step.displacement) || !std::isfinite(step.t)) {
    step = {};
    step.t = still.t;
    return;
  }
  if (step.displacement <= reach) return;
  const double factor = kInside * reach / step.displacement;
  for (double& y : step.y)
    y *= factor;
  step.t = still.t + factor * (step.t - still.t);
  step.displacement *= factor;
  step.share = factor;
}

StepSolution standStill(const StepRows& rows) noexcept {
  StepSolution out;
  out.t = rows.size() > 0 ? rows.leastClearance({}).clearance : 0.0;
  return out;
}

StepSolution StepProgram::solve(const StepRows& rows, const StepGoal& goal, unsigned mostChanges) noexcept {
  if (!isUsable(goal)) return standStill(rows);
  solver_.begin(rows, goal.cost, mostChanges);
  return searchStep(
      solver_, goal, kMaxSolves,
      [this](const StepVector& wanted, double) noexcept { return solver_.solve(wanted); }, KeepNothing{});
}

}  // namespace nearfit
