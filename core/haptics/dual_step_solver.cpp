#include "core/haptics/dual_step_solver.h"

#include <algorithm>
#include <cmath>

namespace nearfit {
namespace {

StepVector motionOf(const ProgramVector& z) noexcept {
  return {z[0], z[1], z[2], z[3], z[4], z[5]};
}

double lengthOf(const StepVector& y) noexcept {
  return std::sqrt(y[0] * y[0] + y[1] * y[1] + y[2] * y[2] + y[3] * y[3] + y[4] * y[4] + y[5] * y[5]);
}

/// How far the multipliers can move along -r until one of them is zero.
struct DualStep {
  double length = std::numeric_limits<double>::infinity();
  std::size_t leaving = 0;
};

DualStep dualStep(const ActiveRows& active, const ActiveRows::Split& split) noexcept {
  double largest = 0.0;
  for (std::size_t i = 0; i < active.size(); ++i)
    largest = std::max(largest, std::abs(split.r[i]));
  DualStep out;
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (!(split.r[i] > DualStepSolver::kPartTolerance * largest)) continue;
    const double length = active.multiplier(i) / split.r[i];
    if (length < out.length) out = {length, i};
  }
  return out;
}

}  // namespace

void DualStepSolver::begin(const StepRows& rows, const ClearanceCost& cost, unsigned mostChanges) noexcept {
  rows_ = &rows;
  cost_ = cost;
  inverseRoot_ = 1.0 / std::sqrt(cost.weight);
  leastDistance_ = rows.leastClearance({}).clearance;
  cost_.floor = std::min(cost.floor, leastDistance_);
  changes_ = 0;
  mostChanges_ = mostChanges;
  active_.clear();
}

DualStepSolver::Point DualStepSolver::standing() const noexcept {
  return {{}, std::max(cost_.floor, std::min(cost_.margin, leastDistance_)), false};
}

DualStepSolver::HalfSpace DualStepSolver::halfSpace(std::size_t id) const noexcept {
  HalfSpace out{{}, 0.0};
  if (id == kFloor) {
    out.n[6] = inverseRoot_;
    out.b = cost_.floor - cost_.margin;
    return out;
  }
  const StepVector a = rows_->row(id);
  std::copy(a.begin(), a.end(), out.n.begin());
  out.n[6] = -inverseRoot_;
  out.b = cost_.margin - rows_->distance(id);
  return out;
}

double DualStepSolver::clearanceOf(const ProgramVector& z) const noexcept {
  return cost_.margin + inverseRoot_ * z[6];
}

DualStepSolver::Violation DualStepSolver::mostViolated(const ProgramVector& z) const noexcept {
  const double t = clearanceOf(z);
  const StepRows::Least least = rows_->leastClearance(motionOf(z));
  const double below = cost_.floor - t;
  if (below > t - least.clearance) return {kFloor, below};
  return {least.row, t - least.clearance};
}

ProgramVector DualStepSolver::restart(const ProgramVector& z0) noexcept {
  for (;;) {
    const ProgramVector z = active_.project(z0);
    std::size_t least = 0;
    double largest = 0.0;
    for (std::size_t i = 0; i < active_.size(); ++i) {
      if (active_.multiplier(i) < active_.multiplier(least)) least = i;
      largest = std::max(largest, std::abs(active_.multiplier(i)));
    }
    if (active_.size() == 0 || active_.multiplier(least) >= -kSignTolerance * largest) return z;
    active_.remove(least);
    ++changes_;
  }
}

bool DualStepSolver::enter(const Violation& violation, const ProgramVector& z0, ProgramVector& z) noexcept {
  const HalfSpace row = halfSpace(violation.id);
  double missing = violation.by, multiplier = 0.0;
  while (changes_ < mostChanges_) {
    ++changes_;
    const ActiveRows::Split split = active_.split(row.n);
    const DualStep dual = dualStep(active_, split);
    const double primal =
        split.isDependent ? std::numeric_limits<double>::infinity() : missing / split.remainderSquared;
    const double step = std::min(primal, dual.length);
    // The row contradicts the active ones; only rounding can cause that.
    if (!std::isfinite(step)) return false;
    if (primal <= dual.length) {
      active_.add(violation.id, row.n, row.b, multiplier + primal, split);
      z = restart(z0);
      return true;
    }
    multiplier += step;
    for (std::size_t i = 0; i < active_.size(); ++i)
      active_.multiplier(i) = std::max(0.0, active_.multiplier(i) - step * split.r[i]);
    if (!split.isDependent) {
      z = along(z, step, split.remainder);
      missing -= step * split.remainderSquared;
    }
    active_.remove(dual.leaving);
  }
  return false;
}

DualStepSolver::Point DualStepSolver::solve(const StepVector& y0) noexcept {
  tolerance_ = kRowTolerance * rows_->largestNorm() *
               (lengthOf(y0) + std::abs(cost_.margin) + std::abs(std::min(cost_.margin, leastDistance_)));
  ProgramVector z0{};
  std::copy(y0.begin(), y0.end(), z0.begin());
  ProgramVector z = restart(z0);
  bool isExact = true, isCorrected = false;
  while (isExact) {
    const Violation worst = mostViolated(z);
    if (worst.by <= tolerance_) break;
    if (active_.holds(worst.id)) {
      // A rounding error that correct() does not remove will not go away by iterating.
      isExact = !isCorrected;
      active_.correct(z);
      isCorrected = true;
    } else {
      isExact = enter(worst, z0, z);
      isCorrected = false;
    }
  }
  active_.correct(z);
  if (!isExact) return asFarAsAllowed(motionOf(z), clearanceOf(z));
  return {motionOf(z), clearanceOf(z), true};
}

DualStepSolver::Point DualStepSolver::asFarAsAllowed(const StepVector& y, double t) const noexcept {
  const Point still = standing();
  double fraction = 1.0;
  const auto shorten = [&fraction](double before, double after) {
    if (after < 0.0) fraction = std::min(fraction, before / (before - after));
  };
  shorten(still.t - cost_.floor, t - cost_.floor);
  for (std::size_t i = 0; i < rows_->size(); ++i) {
    const StepVector a = rows_->row(i);
    double after = rows_->distance(i) - t;
    for (std::size_t k = 0; k < a.size(); ++k)
      after += a[k] * y[k];
    shorten(rows_->distance(i) - still.t, after);
  }
  Point out{{}, still.t + fraction * (t - still.t), false};
  for (std::size_t k = 0; k < y.size(); ++k)
    out.y[k] = fraction * y[k];
  return out;
}

}  // namespace nearfit
