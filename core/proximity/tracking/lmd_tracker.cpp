#include "core/proximity/tracking/lmd_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit {
namespace {

/// Beyond this turn, limits of direction no longer cull [rad].
constexpr double kMaxClearTurn = 0.5;

/// Shares of a plan's way and of its budget for deviation that a list covers, by level. A list for part of a plan keeps
/// more of the way, if there is a min budget.
struct PlanPart {
  double way, aside;
};
constexpr std::array<PlanPart, 4> kParts{{{1.0, 1.0}, {1.0, 0.5}, {0.5, 0.25}, {0.2, 0.1}}};
/// The same where a list is to serve long along the way: lengths of the way, in min budgets for deviation, and shares of that
/// budget. How many pairs there are depends on the length, whatever the speed: a part that waited will go faster. The first
/// is for a part that is loose: few pairs are so near.
constexpr std::array<PlanPart, kParts.size()> kPartsAlong{{{8.0, 0.5}, {6.0, 0.12}, {4.5, 0.12}, {2.5, 0.1}}};
/// Such a list is for no more ticks than these.
constexpr double kMostTicks = 64.0;
/// It is renewed after this time on its way, since steps look ahead; earlier if its end is no more leads away than these.
constexpr double kTimeToRenew = 0.0, kLeadsToSpare = 1.5;
/// After this many lists for less of a plan, or skipped attempts, more is tried; at once if a list holds less
/// than kFewPairs of the pairs that it may.
constexpr unsigned kBuildsBetweenTries = 16;
constexpr double kFewPairs = 1.0 / 8.0;

SearchPlan planFor(const MotionForecast& forecast, const ListPurpose& purpose, std::size_t level) noexcept {
  if (purpose.isAlong) {
    const double way = kPartsAlong[level].way * purpose.leastRoom.travel, speed = forecast.speed();
    SearchPlan plan = forecast.planOfTicks(purpose.planCutoff, purpose.begin,
                                           way < kMostTicks * speed ? way / speed : kMostTicks);
    // Where there is hardly a way, there is room for more aside.
    const bool isSlow = kMostTicks * speed < purpose.leastRoom.travel;
    plan.range.budget = (isSlow ? kParts : kPartsAlong)[level].aside * purpose.leastRoom;
    return plan;
  }
  const PlanPart& part = kParts[level];
  if (!(purpose.leastRoom.travel > 0.0)) return forecast.plan(purpose.planCutoff, part.aside);
  SearchPlan plan = forecast.plan(purpose.planCutoff, part.way);
  const MotionBudget least = part.aside * purpose.leastRoom;
  plan.range.budget = level == 0 ? MotionBudget{std::max(plan.range.budget.travel, least.travel),
                                                std::max(plan.range.budget.turn, least.turn)}
                                 : least;
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
  if (list.cutoff() != purpose.cutoff || !covers(forecast.pose()) || !covers(forecast.poseWhenReady()))
    return false;
  if (!purpose.isAlong) return true;
  const auto timeAfter = [&](double ticks) {
    return list.timeAt(pair.queryAt(forecast.poseAfterwards(ticks), purpose.cutoff).sceneFromPart);
  };
  const double now = timeAfter(1.0);
  if (std::abs(timeAfter(kLeadsToSpare * forecast.lead())) > 1.0) return false;
  const bool isGoingBack = timeAfter(2.0) < now;
  // One that hardly moves stays within the list for long, whichever way it goes.
  return (isGoingBack ? -now : now) <= kTimeToRenew || std::abs(timeAfter(0.5 * kMostTicks)) <= 1.0;
}

const CandidateList::Bounds& ListPurpose::boundsAt(std::size_t level) const noexcept {
  return level == 0 ? whole : level + 1 < kParts.size() ? part : least;
}

bool buildForPlan(CandidateList& list, const TrackedPair& pair, const MotionForecast& forecast,
                  const ListPurpose& purpose, LmdScratch& scratch, PlanMemory& memory) {
  const glm::dquat sceneFromWorld = glm::conjugate(pair.worldFromScene.rotation);
  if (memory.level > 0 && ++memory.builds % kBuildsBetweenTries == 0) --memory.level;
  MotionRange failed;
  for (; memory.level < kParts.size(); ++memory.level) {
    const SearchPlan plan = planFor(forecast, purpose, memory.level);
    // A way that is cut short may be the same at two levels.
    if (plan.range == failed) continue;
    failed = plan.range;
    list.build(pair.queryAt(plan.pose, purpose.cutoff), turned(sceneFromWorld, plan.range), scratch,
               purpose.boundsAt(memory.level), purpose.relaxation, !purpose.isAlong);
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
