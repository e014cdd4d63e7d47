#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/haptics/contact_thinning.h"
#include "core/proximity/query/contact_query.h"
#include "core/proximity/query/lmd_query.h"
#include "core/proximity/surface/surface_contacts.h"
#include "core/servo/tracked_scene.h"

namespace nearfit {

/// Contacts and distances around the part at a pose.
struct Surroundings {
  std::size_t count = 0;  ///< Contacts found.
  /// Lower bound on the distance to every body that the part does not overlap [m]; 0 if the allowed work
  /// was too little. Of the meshes that are searched, like the distances of contacts.
  double distance = 0.0;
  /// Every contact nearer than this is included, or one that constrains about the same motion [m]. Less than
  /// asked for if there are thousands of contacts or too little room.
  double completeTo = 0.0;
  /// Distance searched [m]; less than asked for if more pairs are near than fit.
  double reach = 0.0;
  /// The bodies themselves may be nearer than the meshes that are searched by this much [m].
  double deviation = 0.0;
};

/// Finds the contacts of the moving part with all bodies around it.
///
/// Near pairs of features come from the lists of a tracked scene where they cover the pose, else from a
/// search. The pairs then serve for small motions around that pose, so most poses cost only the exact tests
/// of some hundred pairs.
class ContactFinder {
 public:
  /// Max contacts kept for a pose. Of more, those that constrain about the same motion as a nearer
  /// one are dropped.
  static constexpr std::size_t kMaxContacts = ContactThinning::kMaxKept;
  /// Max work per tick: nodes opened, pairs listed and pairs tested; some 1.5 ms on a slow core.
  /// Never exceeded: work that would exceed it is not started or is abandoned, and nothing is then
  /// known of the pose.
  static constexpr std::uint64_t kMaxWork = 1U << 15;
  /// Part of kMaxWork for new searches, some 0.7 ms. If it is too little, a list will soon be ready.
  static constexpr std::uint64_t kMaxSearchWork = 1U << 14;
  /// Part of kMaxWork for unsided surfaces, some 0.3 ms. They have no lists, so a part among them would use
  /// all the work in every tick. With this limit it moves past them more slowly, but ticks are on time. If it
  /// is too little to see anything, the next ticks may use all of kMaxWork.
  static constexpr std::uint64_t kMaxSurfaceWork = 1U << 13;
  /// Max bodies near the part at a time; with more, the part stands still.
  static constexpr std::size_t kMaxBodies = 1024;

  /// Allocates all work space.
  ContactFinder();

  /// Starts a tick with the full allowance of work.
  void beginTick() noexcept;
  /// Discards the pairs held. To be called when the scene or the set of overlapping bodies changes.
  void forget() noexcept { isHoldingPairs_ = false; }

  /// Finds the contacts at a pose. Bodies that the tracked scene's clearance lists as
  /// overlapping are ignored.
  /// @param worldFromPart  Pose of the moving part.
  /// @param reach          Max distance of contacts [m]; > 0.
  /// @param way            Expected travel of the part from there in this tick [m].
  /// @param out            Room for kMaxContacts; filled in no order, in world coordinates.
  /// Real-time safe.
  Surroundings find(const TrackedScene& tracked, const RigidTransform& worldFromPart, double reach,
                    double way, std::span<BodyContact> out) noexcept;

  /// Number of times since beginTick() that no list covered the pose of a near body.
  std::uint32_t lateBodies() const noexcept { return lateBodies_; }
  /// True if no work is left for contacts or surfaces, or what was left was too little for something needed.
  bool isWorkSpent() const noexcept { return isWorkSpent_ || workLeft_ == 0 || surfaceWorkLeft_ == 0; }
  /// Work done since beginTick(); at most kMaxWork.
  std::uint64_t work() const noexcept { return kMaxWork - workLeft_; }

 private:
  struct HeldBody {
    std::uint32_t body = 0;                  ///< Index in ServoScene::bodies.
    std::size_t first = 0, count = 0;        ///< Range in pairs_, or in triangles_ for an unsided surface.
    double within = 0.0;                     ///< Every pair of triangles nearer than this is held [m].
    std::size_t firstBlock = 0, blocks = 0;  ///< Range in edgePairs_, for its first pairs.
  };

  /// Parameters of gathering pairs.
  struct Gathering {
    MotionBudget slack;      ///< Motion for which the pairs must serve.
    std::size_t mostListed;  ///< Max pairs worth taking from lists.
  };

  Surroundings look(const TrackedScene& tracked, const RigidTransform& worldFromPart, double reach,
                    double way, std::span<BodyContact> out) noexcept;
  bool holdsFor(const ServoScene& scene, const RigidTransform& worldFromPart, double reach) const noexcept;
  bool hasWorkForAttempt() const noexcept;
  bool gatherPairs(const TrackedScene& tracked, const RigidTransform& worldFromPart, double reach,
                   double way) noexcept;
  bool gatherWithin(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                    const Gathering& gathering) noexcept;
  void packPairs(const ServoScene& scene) noexcept;
  bool gatherOne(const TrackedScene& tracked, std::uint32_t body, const TrackedScene::Near* known,
                 const RigidTransform& worldFromPart, const Gathering& gathering) noexcept;
  NearbyPairs pairsOf(const ServoScene::Body& other, const TrackedScene::Near* known, const ServoScene& scene,
                      const RigidTransform& worldFromPart, const Gathering& gathering) noexcept;
  bool gatherTriangles(const ServoScene& scene, std::uint32_t body, const RigidTransform& worldFromPart,
                       const MotionBudget& slack) noexcept;
  void testPairs(const ServoScene& scene, const HeldBody& held, const RigidTransform& worldFromPart,
                 Surroundings& around) noexcept;
  void testSurface(const ServoScene& scene, const HeldBody& held, const RigidTransform& worldFromPart,
                   Surroundings& around) noexcept;
  void testBodies(const ServoScene& scene, const RigidTransform& worldFromPart,
                  Surroundings& around) noexcept;
  void spend(std::uint64_t work) noexcept {
    assert(work <= workLeft_);
    workLeft_ -= work;
  }

  std::uint64_t leftForSurfaces() const noexcept { return std::min(workLeft_, surfaceWorkLeft_); }
  void spendOnSurface(std::uint64_t work) noexcept {
    spend(work);
    surfaceWorkLeft_ -= std::min(work, surfaceWorkLeft_);
  }

  LmdScratch scratch_;
  ContactThinning thinning_;
  std::vector<ContactPair> found_;            ///< Contacts of one body.
  std::vector<SurfaceContact> surfaceFound_;  ///< Contacts of one unsided surface.

  /// Pairs that can be contacts at poses within `holds_` of `pairsPose_`.
  std::vector<LeafPair> pairs_;
  /// The edge pairs among them, packed for tests of four at a time, as far as there is room.
  std::vector<EdgePairs> edgePairs_;
  EdgePairKernel edgePairKernel_;
  /// For unsided surfaces instead: pairs of triangles that come near within `holds_`.
  std::vector<TrianglePair> triangles_;
  std::size_t pairCount_ = 0, triangleCount_ = 0;
  std::array<HeldBody, kMaxBodies> bodies_;
  std::size_t bodyCount_ = 0;
  RigidTransform pairsPose_, testedPose_;
  /// Reach asked for, and reach that the pairs were gathered for [m].
  double askedReach_ = 0.0, pairsReach_ = 0.0;
  MotionBudget holds_;
  bool isHoldingPairs_ = false;
  /// Level of the room for motion that pairs are gathered with; higher levels have less room.
  std::size_t roomLevel_ = 0;
  std::size_t tickLevel_ = 0;  ///< The same for the rest of this tick, which has less work left.
  unsigned gatherings_ = 0;
  bool isSurfaceNear_ = false;  ///< An unsided surface was searched.
  bool isUncovered_ = false;    ///< A list too long to be replaced by a search does not cover the pose.

  /// Pose of the first look in the last tick, and how far that was from the one before [m].
  RigidTransform tickPose_;
  double tickTravel_ = 0.0;
  bool isFirstLook_ = false;

  std::uint64_t workLeft_ = kMaxWork, searchWorkLeft_ = 0, surfaceWorkLeft_ = 0;
  bool isBlind_ = false;        ///< Nothing is known of any pose of this tick.
  unsigned generousTicks_ = 0;  ///< Ticks left in which surfaces may use all the work.
  bool isWorkSpent_ = false;    ///< The work left was too little for something needed.
  std::uint32_t lateBodies_ = 0;
};

}  // namespace nearfit
