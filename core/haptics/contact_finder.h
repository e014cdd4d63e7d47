#pragma once

#include <array>
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
  /// Every contact nearer than this is there, or one that says about the same [m].
  double completeTo = 0.0;
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
  /// Work of a tick: nodes opened, pairs listed and pairs tested, some 1.5 ms on a slow core.
  static constexpr std::uint64_t kMaxWork = 1U << 15;
  /// Of it, for searches anew, some 0.7 ms: where that does not suffice, a list will soon be there.
  static constexpr std::uint64_t kMaxSearchWork = 1U << 14;
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
  bool isWorkSpent() const noexcept { return workLeft_ == 0; }

 private:
  struct HeldBody {
    std::uint32_t body = 0;
    std::size_t first = 0, count = 0;  ///< Of pairs_; none where the body is a surface without sides.
  };

  bool holdsFor(const ServoScene& scene, const RigidTransform& worldFromPart, double reach) const noexcept;
  bool gatherPairs(const TrackedScene& tracked, const RigidTransform& worldFromPart, double reach,
                   double way) noexcept;
  bool gatherWithin(const TrackedScene& tracked, const RigidTransform& worldFromPart, double reach,
                    const MotionBudget& slack) noexcept;
  bool gatherOne(const TrackedScene& tracked, std::uint32_t body, const TrackedScene::Near* known,
                 const RigidTransform& worldFromPart, const MotionBudget& slack) noexcept;
  std::size_t nextPair() const noexcept;
  void testPairs(const ServoScene& scene, const HeldBody& held, const RigidTransform& worldFromPart,
                 Surroundings& around) noexcept;
  void testSurface(const ServoScene& scene, const HeldBody& held, const RigidTransform& worldFromPart,
                   Surroundings& around) noexcept;
  void spend(std::uint64_t work) noexcept { workLeft_ -= work < workLeft_ ? work : workLeft_; }

  LmdScratch scratch_;
  ContactThinning thinning_;
  std::vector<ContactPair> found_;            ///< Of one body.
  std::vector<SurfaceContact> surfaceFound_;  ///< Of one that is a surface without sides.

  /// Pairs that can be contacts within `holds_` of `pairsPose_`.
  std::vector<LeafPair> pairs_;
  std::array<HeldBody, kMaxBodies> bodies_;
  std::size_t bodyCount_ = 0;
  RigidTransform pairsPose_;
  double pairsReach_ = 0.0;
  MotionBudget holds_;
  bool isHoldingPairs_ = false;
  std::size_t roomLevel_ = 0;  ///< Of the room for motion that pairs are gathered with: less at each level.
  unsigned gatherings_ = 0;

  std::uint64_t workLeft_ = 0, searchWorkLeft_ = 0;
  std::uint32_t lateBodies_ = 0;
};

}  // namespace nearfit
