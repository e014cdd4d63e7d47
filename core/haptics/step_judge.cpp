#include "core/haptics/step_judge.h"

#include <algorithm>

namespace nearfit {
namespace {

/// Share of the distance that a step may use; below 1, since distances are rounded. The distance at the
/// step's end proves nothing: minima give the distance only for bodies that do not overlap.
constexpr double kProved = 1.0 - 1e-9;
/// A step may halve the distance at most, and only down to this share of the margin, or of the initial
/// distance if that was less: halving on and on would end in rounding.
constexpr double kFloor = 1.0 / 64.0, kFloorOfFirst = 0.25;
/// Error of distances, as a fraction of the lengths involved.
constexpr double kRounding = 1e-11;
/// Min share to which a step is shortened at a time.
constexpr double kMinShare = 1.0 / 64.0;

}  // namespace

StepTrial::StepTrial(const StepGoal& goal, const StepSolution& solution, double distance) noexcept
    : wanted_(goal.wanted), step_(solution.y), cost_(goal.cost), distance_(distance) {
  double along = 0.0;
  for (std::size_t k = 0; k < step_.size(); ++k)
    along += wanted_[k] * step_[k];
  const double lack = std::max(0.0, cost_.margin - distance_);
  const double lackAfter = std::max(0.0, cost_.margin - solution.t);
  slope_ = 2.0 * (cost_.weight * lack * (lackAfter - lack) - along);
}

bool StepTrial::isGain(double distance) noexcept {
  double before = 0.0, after = 0.0;
  for (std::size_t k = 0; k < step_.size(); ++k) {
    const double rest = wanted_[k] - step_[k];
    before += wanted_[k] * wanted_[k];
    after += rest * rest;
  }
  const double lackHere = std::max(0.0, cost_.margin - distance_);
  const double lackThere = std::max(0.0, cost_.margin - distance);
  before += cost_.weight * lackHere * lackHere;
  after += cost_.weight * lackThere * lackThere;
  // Lowest point of the parabola through both costs that has the program's slope here.
  const double bend = after - before - slope_;
  const double best = bend > 0.0 ? -slope_ / (2.0 * bend) : StepJudge::kHalf;
  bestShare_ = std::clamp(best, kMinShare, StepJudge::kHalf);
  return after < before;
}

void StepTrial::shorten(double share) noexcept {
  for (double& y : step_)
    y *= share;
  slope_ *= share;
}

StepJudge::Verdict StepJudge::judge(const Way& way, StepTrial* trial) const noexcept {
  const double held = std::min(way.here, way.margin);
  const bool isProved = way.travel < kProved * (way.here - way.deviation) || way.onWay > way.deviation;
  const double least = (way.travel < way.here ? kHalf : kLongKeeps) * held;
  const bool isAllowed = way.there >= way.here || way.there >= std::max(least, floor_ + way.deviation);
  if (!isProved || !isAllowed) return Verdict::NotProved;
  return trial != nullptr && !trial->isGain(way.there) ? Verdict::NoGain : Verdict::Taken;
}

void StepJudge::raiseFloor(double distance, double margin, double lengths) noexcept {
  const double highest = kFloor * margin;
  floor_ = std::min(std::max({floor_, kFloorOfFirst * distance, kRounding * lengths}), highest);
}

}  // namespace nearfit
