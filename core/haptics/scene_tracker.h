#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/haptics/servo_snapshot.h"
#include "core/haptics/tracked_scene.h"
#include "core/proximity/lmd_query.h"
#include "core/proximity/lmd_tracker.h"
#include "core/proximity/motion_forecast.h"

namespace nearfit {

/// Keeps a TrackedScene ahead of the motion of its moving part. For a thread beside the servo: it allocates,
/// and its work is not bounded.
///
/// Each near body has a list of its own and is searched anew only when that will soon not do any more; the
/// others are looked at again when the motion could have brought one near. A search that comes late
/// costs the servo a cold query, never the exactness of the set.
class SceneTracker {
 public:
  SceneTracker() = default;

  /// Another scene: lists of bodies whose geometry, like that of the moving part, is the same stay of use.
  void setScene(std::shared_ptr<const ServoScene> scene);

  /// Takes note of where the moving part is now.
  /// @param ticks  Servo ticks since the last call; > 0.
  void observe(const RigidTransform& worldFromPart, double ticks) noexcept {
    forecast_.observe(worldFromPart, ticks);
  }
  /// Takes note of where the hand would have it. Where that is known, a part that waits for lists is
  /// expected to go on as the hand does.
  void observeHand(const RigidTransform& worldFromPart, double ticks) noexcept {
    hand_.observe(worldFromPart, ticks);
  }
  /// All that a tick tells of where its part and its hand are, and of what the proxy waits for. Whoever runs
  /// ticks passes each on by this: a proxy that starves unheard stands still for good.
  void observeTick(const ServoSnapshot& snapshot, double ticks) noexcept;
  /// As MotionForecast::setLead().
  void setLead(double ticks) noexcept { forecast_.setLead(ticks); }

  /// Whether the servo's proxy waits to know what it overlaps where it is now.
  void setWaiting(bool isWaiting) noexcept { isWaiting_ = isWaiting; }
  /// Whether lists of contacts do not reach where the proxy would go from where it was seen last: they are
  /// then renewed around it, unless they were made there, and tried again where there were none to be had.
  void setStarved(bool isStarved) noexcept {
    isStarved_ = isStarved;
    if (isStarved) forecast_.goAs(hand_);
  }

  /// Whether what is known will not do any more by the time that a search from now has ended.
  bool isDue(const SearchReach& reach) const noexcept;

  /// Renews what is due for the time to come, and writes the whole to `out`.
  void refresh(const SearchReach& reach, TrackedScene& out);

 private:
  bool willServe(const TrackedScene::Near& entry, const SearchReach& reach) const noexcept;
  bool hasContacts(std::uint32_t body, const SearchReach& reach) const noexcept;
  ListPurpose forMinima(const SearchReach& reach) const noexcept;
  ListPurpose forContacts(const SearchReach& reach) const noexcept;
  bool isClearanceDue(const SearchReach& reach) const noexcept;
  bool isClearOf(std::uint32_t body, double cutoff) noexcept;
  bool isAllClear(double cutoff, const std::vector<TrackedScene::Near>& former) noexcept;
  void findNear(const SearchReach& reach, const std::vector<TrackedScene::Near>& former);
  std::shared_ptr<const CandidateList> renewed(const std::shared_ptr<const CandidateList>& former,
                                               std::uint32_t body, const ListPurpose& purpose,
                                               PlanMemory& memory);
  std::shared_ptr<CandidateList> spareList();
  TrackedPair pairOf(std::uint32_t body) const noexcept;

  TrackedScene current_;
  /// Of each body of the scene: what its lists were made for of late.
  struct Memory {
    PlanMemory minima, contacts;
  };
  std::vector<Memory> memory_;
  std::uint64_t lastSerial_ = 0;  ///< Of a clearance.
  bool isWaiting_ = false, isStarved_ = false;
  MotionForecast forecast_, hand_;
  LmdScratch scratch_;
  /// Lists that come back here when the last TrackedScene that shows them is overwritten, with their storage.
  std::vector<std::shared_ptr<CandidateList>> pool_;
};

}  // namespace nearfit
