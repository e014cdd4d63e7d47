#pragma once

#include <cstdint>
#include <vector>

#include "core/proximity/query/contact_query.h"
#include "core/proximity/tracking/candidate_list.h"
#include "core/servo/many_pairs.h"
#include "core/servo/servo_scene.h"

namespace nearfit {

/// Contacts count up to this many margins away where pairs are thousands: no farther than a part in contact needs to keep
/// its margin (kSight in proxy.cpp). Within 1.75 there are a fifth more, for steps as long.
constexpr double kReachOfThousands = 1.5;
/// The same in metres. @param contactReach  SearchReach::contact [m].
double reachOfThousands(double contactReach) noexcept;

/// Returns the parameters of a look among thousands of pairs, but for the way.
/// @param reach         Max distance of contacts [m].
/// @param contactReach  SearchReach::contact [m].
ManyPairs::Asked askedAmongThousands(const ServoScene& scene, const ServoScene::Body& other,
                                     const RigidTransform& sceneFromPart, double reach,
                                     double contactReach) noexcept;

/// The pairs of a list of thousands, made ready beside the servo: each has its separation and its group.
///
/// SceneTracker makes them with the list. Once published, a single ContactFinder reads and changes them: the first that
/// claims them.
class PreparedPairs {
 public:
  /// Changes each time that they are made; 0 before.
  std::uint64_t serial() const noexcept { return serial_; }
  /// Max distance of contacts that they serve [m].
  double reach() const noexcept { return reach_; }
  /// The pairs, if this owner may use them; else null. Real-time safe.
  ManyPairs* claim(const void* owner) noexcept {
    if (owner_ == nullptr) owner_ = owner;
    return owner_ == owner ? &pairs_ : nullptr;
  }
  /// True if an owner that claimed `pairs` under that serial may go on with them.
  bool isStill(const ManyPairs* pairs, std::uint64_t serial, const void* owner) const noexcept {
    return pairs == &pairs_ && serial == serial_ && owner == owner_;
  }

 private:
  friend class PairPreparer;
  ManyPairs pairs_;
  std::uint64_t serial_ = 0;
  double reach_ = 0.0;
  const void* owner_ = nullptr;
};

/// Makes the prepared pairs of one body after the other's list, and keeps what it finds out about pairs for the next. For a
/// thread beside the servo: it allocates.
class PairPreparer {
 public:
  /// Forgets what it knows: other bodies follow.
  void forget() noexcept { pairs_.forget(); }
  /// @param list           At most ManyPairs::kMax pairs that span contacts, of the moving part and the body.
  /// @param sceneFromPart  Pose at which the pairs will be claimed: their separations are the best there.
  /// @param serial         Of the result; not 0.
  void prepare(const ServoScene& scene, const ServoScene::Body& body, const CandidateList& list,
               const RigidTransform& sceneFromPart, double contactReach, std::uint64_t serial,
               PreparedPairs& out);

 private:
  ManyPairs pairs_;
  RigidTransform pose_;  ///< Of the last call, sceneFromPart.
  std::vector<LeafPair> listed_;
  std::vector<ContactPair> contacts_;
};

}  // namespace nearfit
