#pragma once

#include <cstddef>
#include <cstdint>

#include "core/proximity/query/lmd_query.h"
#include "core/proximity/tracking/candidate_list.h"
#include "core/proximity/tracking/motion_forecast.h"

namespace nearfit {

/// Max work to find two bodies clear of each other, in pairs of nodes; beyond it, a list is built.
constexpr std::uint64_t kClearNodePairs = 64;
/// Factors of a plan's motion within which bodies may be found clear of each other, tried from the largest:
/// distant bodies are then checked rarely.
constexpr double kWideClearances[] = {512.0, 64.0};

/// Returns the motion within which a part must be clear of a body: `factor` times what a plan may move it,
/// its turn limited to where limits of direction still cull.
/// @param radius  Radius of the part about its centre [m].
MotionBudget clearance(double factor, const SearchPlan& plan, double radius) noexcept;

/// A body at rest and the moving part: their trees, and the body's pose in the frame of the part's poses.
struct TrackedPair {
  const NormalConeTree &scene, &part;
  RigidTransform worldFromScene;

  BodyPairQuery queryAt(const RigidTransform& worldFromPart, double cutoff) const noexcept {
    return {scene, part, (worldFromScene.inverse() * worldFromPart).normalized(), cutoff};
  }
};

/// Requirements of a list.
struct ListPurpose {
  double cutoff = 0.0;       ///< [m]
  double planCutoff = 0.0;   ///< Bounds the budget for deviation [m]: the cutoff, or a wider one.
  double relaxation = 0.0;   ///< As in CandidateList::build [rad].
  MotionBudget leastRoom{};  ///< Min budget for deviation from the forecast.
  bool isAlong = false;      ///< The list is to serve long along the forecast's way and little aside,
  double begin = 0.0;        ///< and to begin so many ticks from now.
  /// Bounds of a list for the whole plan, for a part of it, and for the smallest part.
  CandidateList::Bounds whole{1U << 14, 1U << 14}, part{}, least{};

  /// @param level  As in PlanMemory.
  const CandidateList::Bounds& boundsAt(std::size_t level) const noexcept;
  double roomToKeep = 0.0;  ///< Min share of the budget for deviation to be left at a pose.
};

/// True if a list was built for the purpose's cutoff and serves both now and in the first tick after a search
/// that starts now.
bool willServe(const CandidateList& list, const TrackedPair& pair, const MotionForecast& forecast,
               const ListPurpose& purpose) noexcept;

/// How much of a plan recent lists of two bodies could cover. Where surfaces lie along each other, attempts
/// at more cost many times as much as the list that serves.
struct PlanMemory {
  std::size_t level = 0;  ///< 0 is the whole plan; each further level covers less.
  unsigned builds = 0;    ///< Attempts to build above level 0.
};

/// Builds a list for a plan: for all of it if that takes about half a tick at most, else for less of it,
/// which is found sooner and gives a shorter list. False if even the smallest part is too much, or was
/// recently. Allocates; not for the servo thread.
bool buildForPlan(CandidateList& list, const TrackedPair& pair, const MotionForecast& forecast,
                  const ListPurpose& purpose, LmdScratch& scratch, PlanMemory& memory);

/// Decides when to renew the list of two bodies, where to search, and how far around. SceneTracker does so for
/// a scene, by the functions above.
class LmdTracker {
 public:
  /// @param scene, part  Must outlive the tracker.
  LmdTracker(const NormalConeTree& scene, const NormalConeTree& part) noexcept
      : pair_{scene, part, {}}, forecast_(part.centre(), 0.5 * part.size()) {}

  /// See MotionForecast.
  void observe(const RigidTransform& sceneFromPart, double ticks) noexcept {
    forecast_.observe(sceneFromPart, ticks);
  }
  void setLead(double ticks) noexcept { forecast_.setLead(ticks); }

  /// True if the list will no longer serve by the time a new one could be ready.
  bool isDue(const CandidateList& list, double cutoff) const noexcept {
    return !willServe(list, pair_, forecast_, {cutoff, cutoff});
  }

  /// Renews a list for the ticks to come. Allocates; not for the servo thread.
  void refresh(CandidateList& list, double cutoff, LmdScratch& scratch) const;

 private:
  TrackedPair pair_;
  MotionForecast forecast_;
};

}  // namespace nearfit
