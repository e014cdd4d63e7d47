#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/haptics/contact_thinning.h"
#include "core/haptics/tracked_scene.h"
#include "core/proximity/contact_query.h"
#include "core/proximity/lmd_query.h"
#include "core/proximity/surface_contacts.h"

namespace nearfit {

/// What is around the part at a pose.
struct Surroundings {
  std::size_t count = 0;  ///< Contacts.
  /// No body but those that the part overlaps is nearer [m]; 0 when the work allowed did not suffice.
  double distance = 0.0;
  /// Every contact nearer than this is there, or one that says about the same [m]: less than was asked for
  /// where there are thousands, or no room.
  double completeTo = 0.0;
  double reach = 0.0;  ///< How far was looked [m]: less than asked for where more pairs are near than fit.
};

/// Finds the contacts of the moving part with all bodies around it.
///
/// Pairs of features that are near are taken from the lists of a tracked scene where they cover the pose,
/// else by a search; they then serve for a little motion around, so that most poses cost the exact tests of
/// some hundred pairs.
class ContactFinder {
 public:
  /// Contacts that are kept for a pose; of more, those that say about the same as a nearer one are left out.
  static constexpr std::size_t kMaxContacts = ContactThinning::kMaxKept;
  /// Work of a tick: nodes opened, pairs listed and pairs tested, some 1.5 ms on a slow core. Never passed:
  /// what would is not begun, or left off, and the pose counts as one of which nothing is known.
  static constexpr std::uint64_t kMaxWork = 1U << 15;
  /// Of it, for searches anew, some 0.7 ms: where that does not suffice, a list will soon be there.
  static constexpr std::uint64_t kMaxSearchWork = 1U << 14;
  /// Of it, for surfaces without sides, some 0.3 ms: they have no lists, so that a part among them would take
  /// all of it in every tick. With less a part passes them more slowly, and ticks are not late. Where that is
  /// too little to see anything, the ticks that follow may take all.
  static constexpr std::uint64_t kMaxSurfaceWork = 1U << 13;
  /// Bodies that can be in contact at a time; with more the part stands still.
  static constexpr std::size_t kMaxBodies = 1024;

  ContactFinder();

  /// Gives the work of a new tick.
  void beginTick() noexcept;
  /// Forgets the pairs at hand: the scene is another, or what overlaps.
  void forget() noexcept { isHoldingPairs_ = false; }

  /// Bodies that the tracked scene's clearance names as overlapping are left out.
  /// @param reach  How far contacts are looked for [m].
  /// @param way    How far the part will probably go from there in this tick [m].
  /// @param out    Room for kMaxContacts.
  /// Real-time safe.
  Surroundings find(const TrackedScene& tracked, const RigidTransform& worldFromPart, double reach,
                    double way, std::span<BodyContact> out) noexcept;

  /// Bodies that were searched anew since the tick began.
  std::uint32_t lateBodies() const noexcept { return lateBodies_; }
  bool isWorkSpent() const noexcept { return isWorkSpent_ || workLeft_ == 0 || surfaceWorkLeft_ == 0; }
  /// All work since the tick began; at most kMaxWork.
  std::uint64_t work() const noexcept { return kMaxWork - workLeft_; }

 private:
  struct HeldBody {
    std::uint32_t body = 0;
    std::size_t first = 0, count = 0;  ///< Of pairs_, or of triangles_ where it is a surface without sides.
    double within = 0.0;               ///< What triangles are all there [m].
    std::size_t firstBlock = 0, blocks = 0;  ///< Of edgePairs_: its first pairs.
  };

  /// How pairs are gathered: for which motion, and of how many that lists have it is no use.
  struct Gathering {
    MotionBudget slack;
    std::size_t mostListed;
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
  std::vector<ContactPair> found_;            ///< Of one body.
  std::vector<SurfaceContact> surfaceFound_;  ///< Of one that is a surface without sides.

  /// Pairs that can be contacts within `holds_` of `pairsPose_`.
  std::vector<LeafPair> pairs_;
  /// Those of edges, ready to be tested four at a time, as far as there is room.
  std::vector<EdgePairs> edgePairs_;
  EdgePairKernel edgePairKernel_;
  /// The same of surfaces without sides: the triangles that come near within it.
  std::vector<TrianglePair> triangles_;
  std::size_t pairCount_ = 0, triangleCount_ = 0;
  std::array<HeldBody, kMaxBodies> bodies_;
  std::size_t bodyCount_ = 0;
  RigidTransform pairsPose_, testedPose_;
  double askedReach_ = 0.0, pairsReach_ = 0.0;  ///< What was wanted, and what they are gathered for [m].
  MotionBudget holds_;
  bool isHoldingPairs_ = false;
  std::size_t roomLevel_ = 0;  ///< Of the room that pairs are gathered with: less at each level.
  std::size_t tickLevel_ = 0;  ///< The same for the rest of this tick, whose work is less.
  unsigned gatherings_ = 0;
  bool isSurfaceNear_ = false;  ///< A surface without sides was searched.
  bool isUncovered_ = false;    ///< A list that is longer than a search could be does not hold there.

  /// Where contacts were first looked for in the last tick, and how far that was from the one before [m].
  RigidTransform tickPose_;
  double tickTravel_ = 0.0;
  bool isFirstLook_ = false;

  std::uint64_t workLeft_ = kMaxWork, searchWorkLeft_ = 0, surfaceWorkLeft_ = 0;
  bool isBlind_ = false;        ///< Nothing is known of any pose of this tick.
  unsigned generousTicks_ = 0;  ///< That surfaces may have all the work in.
  bool isWorkSpent_ = false;    ///< What is left did not do for what was to be done.
  std::uint32_t lateBodies_ = 0;
};

}  // namespace nearfit
