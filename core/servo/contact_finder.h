#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/haptics/contact_thinning.h"
#include "core/proximity/query/contact_query.h"
#include "core/proximity/query/lmd_query.h"
#include "core/proximity/surface/surface_contacts.h"
#include "core/servo/many_pairs.h"
#include "core/servo/prepared_pairs.h"
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
  /// Lower bound on the distance of the searched meshes anywhere on the way from another pose [m]; 0 if unknown.
  double onWay = 0.0;
  /// The work allowed was spent: nothing is known yet, and looking at the same pose again goes on.
  bool isPending = false;
};

/// Finds the contacts of the moving part with all bodies around it.
///
/// Near pairs of features come from the lists of a tracked scene where they cover the pose, else from a
/// search. The pairs then serve for small motions around that pose, so most poses cost only the exact tests
/// of some hundred pairs. Where there are thousands, few of them are tested (ManyPairs), and a look at one pose
/// goes on from tick to tick.
class ContactFinder {
 public:
  /// Max contacts kept for a pose. Of more, those that constrain about the same motion as a nearer
  /// one are dropped.
  static constexpr std::size_t kMaxContacts = ContactThinning::kMaxKept;
  /// Max pairs of features held, and of those that are gathered with room for motion around a pose.
  static constexpr std::size_t kMaxPairs = ManyPairs::kMax, kManyPairs = 1U << 14;
  /// Work that a tick is usually allowed: nodes opened, pairs listed, held, packed and tested; some 0.15 ms. Holding
  /// pairs, and tests, stop when it is spent, and go on in the next tick.
  static constexpr std::uint64_t kUsualWork = 1U << 12;
  /// Max work of a tick. Gathering pairs, which cannot be left half done, may exceed what is allowed up to this:
  /// a pass over the longest list, some 0.5 ms. Never exceeded: pairs are gathered within it or not at all.
  static constexpr std::uint64_t kMaxWork = 1U << 15;
  /// Max work of a tick for new searches, some 0.3 ms. If it is too little, a list will soon be ready.
  static constexpr std::uint64_t kMaxSearchWork = 3U << 11;
  /// Max work of a tick for finding triangles of unsided surfaces, some 0.3 ms, where no list covers the pose. With this
  /// limit a part moves past them more slowly, but ticks are on time. If it is too little to see anything, the next
  /// ticks may use twice as much.
  static constexpr std::uint64_t kMaxSurfaceWork = 1U << 13;
  /// Max bodies near the part at a time; with more, the part stands still.
  static constexpr std::size_t kMaxBodies = 1024;

  /// Allocates all work space.
  ContactFinder();

  /// Work that looks may do beyond what is allowed.
  enum class Excess : std::uint8_t {
    None,     ///< Nothing: what would exceed it waits.
    ToGather  ///< Pairs may be gathered beyond it, up to kMaxWork in a tick.
  };

  /// Where a step comes from: straight as to the centre of mass.
  struct Step {
    RigidTransform from;  ///< worldFromPart
    bool isLong = false;  ///< Longer than the distance to the next body: `onWay` is asked for.
  };

  /// Starts a tick, in which no work is allowed yet.
  void beginTick() noexcept;
  /// Allows so much more work in this tick.
  void allow(std::uint64_t work, Excess excess) noexcept;
  /// Counts work of the caller's own as done.
  void spend(std::uint64_t work) noexcept { workDone_ += work; }
  /// Discards the pairs held, and the look that is pending. To be called when the scene or the set of
  /// overlapping bodies changes.
  void forget() noexcept;

  /// Finds the contacts at a pose. Bodies that the tracked scene's clearance lists as
  /// overlapping are ignored. If the work allowed is too little, the result says pending; looking again at
  /// the same pose goes on, in this tick or a later one, and looking at another starts anew.
  /// @param worldFromPart  Pose of the moving part.
  /// @param reach          Max distance of contacts [m]; > 0.
  /// @param way            Expected travel of the part from there in this tick [m].
  /// @param out            Room for kMaxContacts; filled in no order, in world coordinates.
  /// @param step           If not null, the step that would lead there.
  /// Real-time safe.
  Surroundings find(const TrackedScene& tracked, const RigidTransform& worldFromPart, double reach,
                    double way, std::span<BodyContact> out, const Step* step = nullptr) noexcept;

  /// Length of a step that the pairs held serve from end to end [m].
  double room() const noexcept { return isHoldingPairs_ ? holds_.travel + stretchTravel_ : 0.0; }
  /// Number of times since beginTick() that no list covered the pose of a near body.
  std::uint32_t lateBodies() const noexcept { return lateBodies_; }
  /// True if thousands of pairs of a body are held.
  bool isAmongThousands() const noexcept { return isCrowded_ || isHoldingMany(); }
  /// True while so many pairs are near that lists are to serve long along the way and little aside.
  bool isCrowded() const noexcept { return isCrowded_; }
  /// Work left of what was allowed.
  std::uint64_t workLeft() const noexcept { return allowed_ - std::min(allowed_, workDone_); }
  /// True if no work is left for contacts or surfaces.
  bool isWorkSpent() const noexcept { return workLeft() == 0 || surfaceWorkLeft_ == 0; }
  /// Work done since beginTick(); at most kMaxWork.
  std::uint64_t work() const noexcept { return workDone_; }

 private:
  /// Max bodies whose pairs are thousands.
  static constexpr std::size_t kMaxMany = 2;
  /// The pairs of a body, if they are thousands; kept while that body is near.
  struct ManyOfBody {
    ManyPairs pairs;
    std::optional<std::uint32_t> body{};  ///< Index in ServoScene::bodies.
    RigidTransform pose;                  ///< Of the part when it was last gathered around.
    bool isHeld = false;                  ///< It is one of bodies_.
  };
  struct HeldBody {
    std::uint32_t body = 0;                  ///< Index in ServoScene::bodies.
    std::size_t first = 0, count = 0;        ///< Range in pairs_, or in triangles_ for an unsided surface.
    double within = 0.0;                     ///< Every pair of triangles nearer than this is held [m].
    std::size_t firstBlock = 0, blocks = 0;  ///< Range in edgePairs_, for its first pairs.
    std::size_t packed = 0;                  ///< Blocks of that range that are filled.
    std::size_t many = kMaxMany;             ///< Index in many_, if it holds the pairs.
    ManyPairs* prepared = nullptr;     ///< Those that were prepared beside the servo, in place of its pairs,
    std::uint64_t preparedSerial = 0;  ///< and which they are.
    RigidTransform testedPose{};       ///< Of the part, where triangles were tested last.
  };

  /// A way of the part, straight as to its centre of mass: worldFromPart at both ends.
  struct Stretch {
    RigidTransform from, to;
  };
  /// Parameters of gathering pairs.
  struct Gathering {
    MotionBudget slack;                ///< Motion for which the pairs must serve.
    std::size_t mostListed;            ///< Max pairs worth taking from lists.
    bool isOfStep = false;             ///< A shorter step may do where a list does not cover the pose.
    std::optional<Stretch> stretch{};  ///< If set, that motion is from any pose of a stretch.
  };
  /// Outcome of gathering pairs.
  enum class Gathered : std::uint8_t {
    Held,
    TooMany,    ///< There is no room for the pairs.
    NoWork,     ///< The work left was too little.
    NoList,     ///< A list too long to be replaced by a search does not cover the pose.
    Postponed,  ///< The work left was too little, and a whole tick's may do.
  };
  /// State of a look: its pose, what it has found so far, and where its tests go on.
  struct Look {
    RigidTransform pose;
    std::optional<RigidTransform> from{};  ///< If the pairs held are all that matter on the way from there.
    double reach = 0.0;
    Surroundings around;
    std::size_t body = 0;     ///< Index in bodies_ where its tests go on,
    std::size_t pair = 0;     ///< and index among the pairs of that body.
    std::size_t surface = 0;  ///< The same index for unsided surfaces, which come last.
    bool isTestingSurface = false;
    bool isPending = false;
  };

  Surroundings look(const TrackedScene& tracked, const RigidTransform& worldFromPart, double reach,
                    double way, std::span<BodyContact> out, const Step* step) noexcept;
  bool holdsFor(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                double reach) const noexcept;
  /// Share of the motion for which the pairs are held that a pose spends; above 1 they do not serve.
  double spentOfHeld(const ServoScene& scene, const RigidTransform& worldFromPart) const noexcept;
  /// The way of a step and on, as far as all lists cover it; no value if they do not cover the step.
  std::optional<Stretch> stretchFor(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                                    const RigidTransform& from, const ContactReach& reach,
                                    const MotionBudget& slack) const noexcept;
  bool hasWorkForAttempt() const noexcept;
  /// Gathers pairs around a pose, with as much room for motion as there is work for.
  Gathered gatherPairs(const TrackedScene& tracked, const RigidTransform& worldFromPart, double reach,
                       double way, const Step* step) noexcept;
  Gathered gatherWithin(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                        const Gathering& gathering) noexcept;
  /// Gives the pairs of each body to ManyPairs, or moves its pairs of edges to the front, where blocks of them can be
  /// packed. False if the work ran out: called again, it goes on.
  bool arrangePairs(const ServoScene& scene) noexcept;
  /// The same for a body of thousands.
  bool holdMany(const ServoScene& scene, ManyOfBody& many, std::span<const LeafPair> pairs) noexcept;
  bool isHoldingMany() const noexcept {
    return std::any_of(many_.begin(), many_.end(), [](const ManyOfBody& many) { return many.isHeld; });
  }
  bool isHoldingPrepared() const noexcept {
    return std::any_of(bodies_.begin(), bodies_.begin() + static_cast<std::ptrdiff_t>(bodyCount_),
                       [](const HeldBody& held) { return held.prepared != nullptr; });
  }
  /// Finds out whether it is crowded, after pairs were gathered.
  void noteCrowd() noexcept;
  /// True if the prepared pairs that are held are those of the tracked scene, or those before. Others may be gone.
  bool arePreparedCurrent(const TrackedScene& tracked) const noexcept;
  /// Index in many_ for a body's pairs; kMaxMany if there are few of them, or no place.
  std::size_t manyFor(const HeldBody& held) noexcept;
  Gathered gatherOne(const TrackedScene& tracked, std::uint32_t body, const TrackedScene::Near* known,
                     const RigidTransform& worldFromPart, const Gathering& gathering) noexcept;
  Gathered gatherFeatures(const ServoScene::Body& other, std::uint32_t body, const TrackedScene::Near* known,
                          const ServoScene& scene, const RigidTransform& worldFromPart,
                          const Gathering& gathering) noexcept;
  Gathered gatherTriangles(const ServoScene& scene, std::uint32_t body, const TrackedScene::Near* known,
                           const RigidTransform& worldFromPart, const MotionBudget& slack) noexcept;
  /// Takes the pairs of triangles from a list; false if it does not serve the pose.
  bool takeListed(const TriangleList& list, std::uint32_t body, const RigidTransform& bodyFromPart,
                  const MotionBudget& slack) noexcept;
  /// Goes on with the pending look; false if the work ran out.
  bool testBodies(const ServoScene& scene) noexcept;
  void testPairs(const ServoScene& scene, HeldBody& held, std::size_t first, std::size_t count) noexcept;
  /// The same for a body of thousands; false if the work ran out.
  bool testMany(const ServoScene& scene, const HeldBody& held) noexcept;
  /// The same for an unsided surface.
  bool testSurface(const ServoScene& scene, HeldBody& held) noexcept;
  /// Leaves a look that is not finished.
  void giveUpLook() noexcept;
  void takeContacts(const ServoScene::Body& other, std::uint32_t body,
                    std::span<const ContactPair> contacts) noexcept;
  /// Work left for gathering pairs.
  std::uint64_t leftToGather() const noexcept {
    return excess_ == Excess::None ? workLeft() : kMaxWork - std::min(kMaxWork, workDone_);
  }
  std::uint64_t leftForSurfaces() const noexcept { return std::min(leftToGather(), surfaceWorkLeft_); }
  void spendOnSurface(std::uint64_t work) noexcept {
    spend(work);
    surfaceWorkLeft_ -= std::min(work, surfaceWorkLeft_);
  }

  LmdScratch scratch_;
  ContactThinning thinning_;
  std::vector<ContactPair> found_;            ///< Contacts of one body.
  std::vector<SurfaceContact> surfaceFound_;  ///< Contacts of one unsided surface.

  /// Pairs that can be contacts at poses within `holds_` of a stretch about `pairsPose_`.
  std::vector<LeafPair> pairs_;
  /// The edge pairs among them, packed for tests of eight at a time, as far as there is room.
  std::vector<EdgePairs> edgePairs_;
  EdgePairKernels edgePairKernels_;
  /// For unsided surfaces instead: pairs of triangles that come near within `holds_`.
  std::vector<TrianglePair> triangles_;
  TriangleTests triangleTests_;
  std::size_t pairCount_ = 0, triangleCount_ = 0;
  std::array<HeldBody, kMaxBodies> bodies_;
  std::array<ManyOfBody, kMaxMany> many_;
  std::size_t bodyCount_ = 0;
  RigidTransform pairsPose_;
  /// Reach asked for, and reach that the pairs were gathered for [m].
  double askedReach_ = 0.0, pairsReach_ = 0.0;
  MotionBudget holds_;
  MotionStretch stretch_;       ///< As to the centre of mass, in the world's axes.
  double stretchTravel_ = 0.0;  ///< From end to end [m].
  bool isHoldingPairs_ = false;
  /// How far the pairs held are arranged.
  struct Arranging {
    bool isDone = false;
    std::size_t bodies = 0, blocks = 0;  ///< Bodies that are arranged, and blocks that they use.
    bool isHolding = false;              ///< Those of the next body are being given to ManyPairs.
  };
  Arranging arranging_;
  /// Level of the room for motion that pairs are gathered with; higher levels have less room.
  std::size_t roomLevel_ = 0;
  std::size_t tickLevel_ = 0;  ///< The same for the rest of this tick, which has less work left.
  unsigned gatherings_ = 0;
  bool isSurfaceNear_ = false;  ///< An unsided surface was searched.
  bool isCrowded_ = false;
  unsigned sparseGatherings_ = 0;  ///< Gatherings of few pairs, one after the other.
  /// Travel for which the pairs taken from lists of triangles serve [m]; 0 if others were taken too.
  double listedTravel_ = 0.0;

  /// Pose of the first look in the last tick, and how far that was from the one before [m].
  RigidTransform tickPose_;
  double tickTravel_ = 0.0;
  bool isFirstLook_ = false;
  bool isFirstGathering_ = false;  ///< The tick has gathered nothing yet.

  Look look_;
  std::uint64_t allowed_ = 0, workDone_ = 0, searchWorkLeft_ = 0, surfaceWorkLeft_ = 0;
  Excess excess_ = Excess::None;
  bool isBlind_ = false;        ///< Nothing is known of any pose of this tick.
  unsigned generousTicks_ = 0;  ///< Ticks left in which surfaces may use all the work.
  std::uint32_t lateBodies_ = 0;
};

}  // namespace nearfit
