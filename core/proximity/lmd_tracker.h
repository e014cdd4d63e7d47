#pragma once

#include <cstdint>

#include "core/proximity/candidate_list.h"
#include "core/proximity/lmd_query.h"
#include "core/proximity/motion_forecast.h"

namespace nearfit {

/// Work to find that two bodies are clear of each other; more than that, and a list is made.
constexpr std::uint64_t kClearNodePairs = 64;
/// How much farther than a plan goes bodies may be found clear of each other, the farthest first: what is
/// far away is looked at again rarely.
constexpr double kWideClearances[] = {512.0, 64.0};

/// How far a part must be clear of a body: so many times what a plan may take it, with the turn held to where
/// limits on directions still say something.
MotionBudget clearance(double factor, const SearchPlan& plan, double radius) noexcept;

/// Shares of a plan that a list is tried for: all of it while that takes half a tick, and less where it would
/// be too long.
constexpr double kPlanShares[] = {1.0, 0.5, 0.25, 0.1};

/// What a list may be at the first of these shares: what takes longer than about half a tick is worth a
/// shorter plan, which is found sooner.
constexpr CandidateList::Bounds kWorthwhile{1U << 14, 1U << 14};

/// When to renew the list of two bodies, where to search, and how far around. SceneTracker does the same for
/// a scene.
class LmdTracker {
 public:
  /// The trees outlive this.
  LmdTracker(const NormalConeTree& scene, const NormalConeTree& part) noexcept
      : scene_(scene), part_(part), forecast_(part.centre(), 0.5 * part.size()) {}

  /// As MotionForecast has them.
  void observe(const RigidTransform& sceneFromPart, double ticks) noexcept {
    forecast_.observe(sceneFromPart, ticks);
  }
  void setLead(double ticks) noexcept { forecast_.setLead(ticks); }

  /// Whether a list will not do any more by the time that another would be there.
  bool isDue(const CandidateList& list, double cutoff) const noexcept;

  /// Renews a list for the time to come. For a thread that can take its time.
  void refresh(CandidateList& list, double cutoff, LmdScratch& scratch) const;

 private:
  const NormalConeTree &scene_, &part_;
  MotionForecast forecast_;
};

}  // namespace nearfit
