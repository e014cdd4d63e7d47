#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/proximity/query/lmd_query.h"
#include "core/proximity/tracking/lmd_tracker.h"
#include "core/proximity/tracking/motion_forecast.h"
#include "core/servo/prepared_pairs.h"
#include "core/servo/servo_snapshot.h"
#include "core/servo/tracked_scene.h"

namespace nearfit {

/// Facts of a tick that a search ahead uses. All but the last have no default, so that GCC refuses to leave one out:
/// a proxy that starves unnoticed stands still for good. Without the last, lists are only renewed more often.
struct TickObservation {
  RigidTransform worldFromPart;  ///< Pose of the moving part.
  /// Pose where the hand wants the part, if known. A part that waits for lists is then expected to go on as
  /// the hand does.
  std::optional<RigidTransform> worldFromHand;
  bool isWaiting;  ///< The proxy waits until it is known what it overlaps.
  /// Lists of contacts fell short of where the proxy would go. They are then renewed around it, unless they
  /// were made there, and tried again where none could be made.
  bool isStarved;
  /// So many pairs of features are near that lists of contacts are to serve long along the part's way and little aside.
  bool isCrowded = false;
};

/// Returns what a search ahead needs from a tick. Real-time safe.
TickObservation observationOf(const ServoSnapshot& snapshot) noexcept;

/// Keeps a TrackedScene ahead of the motion of its moving part. For a thread beside the servo: it allocates,
/// and its work is not bounded.
///
/// Each near body has its own list, which is searched anew only when it will soon no longer serve. Other
/// bodies are looked at again when the motion could have brought one near. A late search costs the servo a
/// cold query, never the exactness of the set.
class SceneTracker {
 public:
  SceneTracker() = default;

  /// Replaces the scene. Lists stay in use for bodies whose geometry, and that of the moving part,
  /// are unchanged.
  void setScene(std::shared_ptr<const ServoScene> scene);

  /// Records the newest tick; earlier ones may be skipped. Real-time safe.
  /// @param ticks  Servo ticks since the last call; > 0.
  void update(const TickObservation& tick, double ticks) noexcept;
  /// See MotionForecast::setLead().
  void setLead(double ticks) noexcept { forecast_.setLead(ticks); }

  /// True if the known data will no longer serve when a search that starts now has ended.
  bool isDue(const SearchReach& reach) const noexcept;

  /// Renews what is due for the time ahead, and copies everything to `out`.
  /// @param reach  searchReach() of the settings.
  void refresh(const SearchReach& reach, TrackedScene& out);

 private:
  bool willServe(const TrackedScene::Near& entry, const SearchReach& reach) const noexcept;
  bool willServe(const TriangleList& list, std::uint32_t body, const SearchReach& reach) const noexcept;
  bool hasContacts(std::uint32_t body, const SearchReach& reach) const noexcept;
  bool hasTriangles(std::uint32_t body, const SearchReach& reach) const noexcept;
  ListPurpose forMinima(const SearchReach& reach) const noexcept;
  ListPurpose forContacts(const SearchReach& reach) const noexcept;
  bool isClearanceDue(const SearchReach& reach) const noexcept;
  bool isClearOf(std::uint32_t body, double cutoff) noexcept;
  bool isAllClear(double cutoff, const std::vector<TrackedScene::Near>& former) noexcept;
  void findNear(const SearchReach& reach, const std::vector<TrackedScene::Near>& former);
  std::shared_ptr<const CandidateList> renewed(const std::shared_ptr<const CandidateList>& former,
                                               std::uint32_t body, const ListPurpose& purpose,
                                               PlanMemory& memory);
  std::shared_ptr<const TriangleList> renewedTriangles(const std::shared_ptr<const TriangleList>& former,
                                                       std::uint32_t body, const SearchReach& reach,
                                                       double& share);
  /// A body's preparer; null if all are others'.
  PairPreparer* preparerOf(std::uint32_t body);
  /// The pairs of a list, if they are thousands.
  /// @param claimed  Pose of the part at which they will be claimed.
  std::shared_ptr<PreparedPairs> prepared(std::uint32_t body, const CandidateList* list,
                                          const RigidTransform& claimed, const SearchReach& reach);
  /// Renews the list of a body's contacts, and their pairs, where it is due.
  void renewContacts(TrackedScene::Near& entry, const TrackedScene::Near& old, const SearchReach& reach);
  /// Ticks from now until the part has come so far on the way of a list; at least 1, and 1 if it is not on that way.
  double ticksTo(double share, const CandidateList& list, std::uint32_t body) const noexcept;
  TrackedPair pairOf(std::uint32_t body) const noexcept;

  TrackedScene current_;
  /// For each body of the scene: how much of a plan its recent lists could cover.
  struct Memory {
    PlanMemory minima, contacts, along;
    bool isSearchLong = false;  ///< The last search for contacts took long, or found no list.
    double triangles = 1.0;     ///< Share of a plan's motion that the last list of triangles covers.
  };
  std::vector<Memory> memory_;
  std::uint64_t lastSerial_ = 0;  ///< Of the last clearance.
  double clearanceAge_ = 0.0;     ///< [ticks]
  bool isWaiting_ = false, isStarved_ = false;
  /// Lists of contacts are to serve long along the part's way and little aside: it is crowded, or searches take long.
  bool isAlong_ = false;
  MotionForecast forecast_, hand_;
  MotionForecast steady_, steadyHand_;  ///< The same where lists serve long: MotionForecast::steady().
  LmdScratch scratch_;
  /// Lists return here, with their storage, when the last TrackedScene that uses them is overwritten.
  std::vector<std::shared_ptr<CandidateList>> lists_;
  std::vector<std::shared_ptr<TriangleList>> triangleLists_;
  std::vector<std::shared_ptr<PreparedPairs>> preparedPairs_;
  /// For bodies with thousands of pairs, at most kMaxPrepared.
  struct BodyPreparer {
    std::optional<std::uint32_t> body;
    std::unique_ptr<PairPreparer> preparer;
  };
  std::vector<BodyPreparer> preparers_;
};

}  // namespace nearfit
