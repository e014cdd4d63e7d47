#include "core/proximity/lmd_tracker.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "core/proximity/normal_cone_tree.h"

namespace nearfit {
namespace {

/// Beyond this turn the limits on directions say nothing any more [rad].
constexpr double kMostClearTurn = 0.5;

}  // namespace

MotionBudget clearance(double factor, const SearchPlan& plan, double radius) noexcept {
  const MotionRange& range = plan.range;
  const double spin = glm::length(range.stretch.spin);
  return {factor * (range.budget.travel + glm::length(range.stretch.shift) + spin * radius),
          std::min(factor * (range.budget.turn + spin), kMostClearTurn)};
}

bool LmdTracker::isDue(const CandidateList& list, double cutoff) const noexcept {
  return list.cutoff() != cutoff || !(list.spent(forecast_.pose()) <= 1.0) ||
         !(list.spent(forecast_.poseWhenReady()) <= 1.0);
}

void LmdTracker::refresh(CandidateList& list, double cutoff, LmdScratch& scratch) const {
  const SearchPlan plan = forecast_.plan(cutoff);
  const BodyPairQuery query{scene_, part_, plan.pose, cutoff};
  for (const double factor : kWideClearances) {
    const MotionBudget wide = clearance(factor, plan, 0.5 * part_.size());
    if (!isClearWithin(query, wide, scratch, kClearNodePairs)) continue;
    list.build(query, {{}, wide}, scratch);
    return;
  }
  for (const double share : kPlanShares) {
    const SearchPlan part = forecast_.plan(cutoff, share);
    list.build({scene_, part_, part.pose, cutoff}, part.range, scratch,
               share == 1.0 ? kWorthwhile : CandidateList::Bounds{});
    if (list.isUsable()) return;
  }
}

}  // namespace nearfit
