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

bool willServe(const CandidateList& list, const TrackedPair& pair, const MotionForecast& forecast,
               const ListPurpose& purpose) noexcept {
  const auto covers = [&](const RigidTransform& pose) {
    const RigidTransform at = pair.queryAt(pose, purpose.cutoff).sceneFromPart;
    return list.spent(at) <= 1.0 && list.roomLeft(at) >= purpose.roomToKeep;
  };
  return list.cutoff() == purpose.cutoff && covers(forecast.pose()) && covers(forecast.poseWhenReady());
}

void buildForPlan(CandidateList& list, const TrackedPair& pair, const MotionForecast& forecast,
                  const ListPurpose& purpose, LmdScratch& scratch) {
  const glm::dquat sceneFromWorld = glm::conjugate(pair.worldFromScene.rotation);
  for (const double share : {1.0, 0.5, 0.25, 0.1}) {
    SearchPlan plan = forecast.plan(purpose.planCutoff, share);
    plan.range.budget.travel = std::max(plan.range.budget.travel, share * purpose.leastRoom.travel);
    plan.range.budget.turn = std::max(plan.range.budget.turn, share * purpose.leastRoom.turn);
    list.build(pair.queryAt(plan.pose, purpose.cutoff), turned(sceneFromWorld, plan.range), scratch,
               share == 1.0 ? purpose.whole : purpose.part, purpose.relaxation);
    if (list.isUsable()) return;
  }
}

void LmdTracker::refresh(CandidateList& list, double cutoff, LmdScratch& scratch) const {
  const SearchPlan plan = forecast_.plan(cutoff);
  const BodyPairQuery query = pair_.queryAt(plan.pose, cutoff);
  for (const double factor : kWideClearances) {
    const MotionBudget wide = clearance(factor, plan, 0.5 * pair_.part.size());
    if (!isClearWithin(query, wide, scratch, kClearNodePairs)) continue;
    list.build(query, {{}, wide}, scratch);
    return;
  }
  buildForPlan(list, pair_, forecast_, {cutoff, cutoff}, scratch);
}

}  // namespace nearfit
