#pragma once

#include <cstddef>
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

/// A body that stands, and the part that moves: their trees, and where the body is in the frame that the
/// part's poses are given in.
struct TrackedPair {
  const NormalConeTree &scene, &part;
  RigidTransform worldFromScene;

  BodyPairQuery queryAt(const RigidTransform& worldFromPart, double cutoff) const noexcept {
    return {scene, part, (worldFromScene.inverse() * worldFromPart).normalized(), cutoff};
  }
};

/// What a list is made for.
struct ListPurpose {
  double cutoff = 0.0;       ///< [m]
  double planCutoff = 0.0;   ///< What the room for motion is measured by [m]: the cutoff, or a wider one.
  double relaxation = 0.0;   ///< As CandidateList::build has it.
  MotionBudget leastRoom{};  ///< For motion aside of what is foretold.
  /// How much a list for the whole plan may be, one for a part of it, and one for the least.
  CandidateList::Bounds whole{1U << 14, 1U << 14}, part{}, least{};

  /// @param level  As PlanMemory has it.
  const CandidateList::Bounds& boundsAt(std::size_t level) const noexcept;
  double roomToKeep = 0.0;  ///< Share of the room aside that must be left at a pose.
};

/// Whether a list is made for that cutoff, and will do now and in the first tick after a search from now.
bool willServe(const CandidateList& list, const TrackedPair& pair, const MotionForecast& forecast,
               const ListPurpose& purpose) noexcept;

/// For how much of a plan lists of two bodies were to be had of late: where surfaces lie along each other,
/// attempts at more cost many times what the list does that serves.
struct PlanMemory {
  std::size_t level = 0;  ///< 0 is the whole plan; less of it at each.
  unsigned builds = 0;
};

/// Builds a list for a plan: for all of it while that takes about half a tick, and for less, which is found
/// sooner, where it would take longer or the list would be too long. False when even the least is too much,
/// or was of late. For a thread that can take its time.
bool buildForPlan(CandidateList& list, const TrackedPair& pair, const MotionForecast& forecast,
                  const ListPurpose& purpose, LmdScratch& scratch, PlanMemory& memory);

/// When to renew the list of two bodies, where to search, and how far around. SceneTracker does the same for
/// a scene.
class LmdTracker {
 public:
  /// The trees outlive this.
  LmdTracker(const NormalConeTree& scene, const NormalConeTree& part) noexcept
      : pair_{scene, part, {}}, forecast_(part.centre(), 0.5 * part.size()) {}

  /// As MotionForecast has them.
  void observe(const RigidTransform& sceneFromPart, double ticks) noexcept {
    forecast_.observe(sceneFromPart, ticks);
  }
  void setLead(double ticks) noexcept { forecast_.setLead(ticks); }

  /// Whether a list will not do any more by the time that another would be there.
  bool isDue(const CandidateList& list, double cutoff) const noexcept {
    return !willServe(list, pair_, forecast_, {cutoff, cutoff});
  }

  /// Renews a list for the time to come. For a thread that can take its time.
  void refresh(CandidateList& list, double cutoff, LmdScratch& scratch) const;

 private:
  TrackedPair pair_;
  MotionForecast forecast_;
};

}  // namespace nearfit
