#include "core/proximity/tracking/lmd_tracker.h"

#include <algorithm>
#include <array>

#include <glm/geometric.hpp>

#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit {
namespace {

/// Beyond this turn, limits of direction no longer cull [rad].
constexpr double kMaxClearTurn = 0.5;

/// Share of a plan that a list is built for, by level.
constexpr std::array<double, 4> kShares{1.0, 0.5, 0.25, 0.1};
/// A list for part of a plan keeps this many times as much of the stretch as of the budget for deviation.
constexpr double kWayShare = 2.0;
/// After this many lists for less of a plan, or skipped attempts, more is tried; at once if a list holds less
/// than kFewPairs of the pairs that it may.
constexpr unsigned kBuildsBetweenTries = 16;
constexpr double kFewPairs = 1.0 / 8.0;

/// If the whole plan is too much, its stretch counts for more than deviation, which gets the min budget.
SearchPlan planFor(const MotionForecast& forecast, const ListPurpose& purpose, double share) noexcept {
  const MotionBudget least = share * purpose.leastRoom;
  if (share == 1.0 || !(least.travel > 0.0)) {
    SearchPlan plan = forecast.plan(purpose.planCutoff, share);
    plan.range.budget = {std::max(plan.range.budget.travel, least.travel),
                         std::max(plan.range.budget.turn, least.turn)};
    return plan;
  }
  SearchPlan plan = forecast.plan(purpose.planCutoff, std::min(1.0, kWayShare * share));
  plan.range.budget = least;
  return plan;
}

}  // namespace

MotionBudget clearance(double factor, const SearchPlan& plan, double radius) noexcept {
  const MotionRange& range = plan.range;
  const double spin = glm::length(range.stretch.spin);
  return {factor * (range.budget.travel + glm::length(range.stretch.shift) + spin * radius),
          std::min(factor * (range.budget.turn + spin), kMaxClearTurn)};
}

bool willServe(const CandidateList& list, const TrackedPair& pair, const MotionForecast& forecast,
               const ListPurpose& purpose) noexcept {
  const auto covers = [&](const RigidTransform& pose) {
    const RigidTransform at = pair.queryAt(pose, purpose.cutoff).sceneFromPart;
    return list.spent(at) <= 1.0 && list.roomLeft(at) >= purpose.roomToKeep;
  };
  return list.cutoff() == purpose.cutoff && covers(forecast.pose()) && covers(forecast.poseWhenReady());
}

const CandidateList::Bounds& ListPurpose::boundsAt(std::size_t level) const noexcept {
  return level == 0 ? whole : level + 1 < kShares.size() ? part : least;
}

bool buildForPlan(CandidateList& list, const TrackedPair& pair, const MotionForecast& forecast,
                  const ListPurpose& purpose, LmdScratch& scratch, PlanMemory& memory) {
  const glm::dquat sceneFromWorld = glm::conjugate(pair.worldFromScene.rotation);
  if (memory.level > 0 && ++memory.builds % kBuildsBetweenTries == 0) --memory.level;
  for (; memory.level < kShares.size(); ++memory.level) {
    const double share = kShares[memory.level];
    const SearchPlan plan = planFor(forecast, purpose, share);
    list.build(pair.queryAt(plan.pose, purpose.cutoff), turned(sceneFromWorld, plan.range), scratch,
               purpose.boundsAt(memory.level), purpose.relaxation);
    if (!list.isUsable()) continue;
    const auto most = memory.level > 0 ? static_cast<double>(purpose.boundsAt(memory.level - 1).pairs) : 0.0;
    if (static_cast<double>(list.size()) < kFewPairs * most) --memory.level;
    return true;
  }
  return false;
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
  PlanMemory memory;
  buildForPlan(list, pair_, forecast_, {cutoff, cutoff}, scratch, memory);
}

}  // namespace nearfit
