#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/proximity/query/contact_query.h"
#include "core/proximity/query/edge_pairs.h"
#include "core/proximity/query/face_pairs.h"
#include "core/proximity/query/pair_passage.h"
#include "core/proximity/query/pair_separations.h"
#include "core/proximity/query/segment_pairs.h"

namespace nearfit {

/// Thousands of pairs of features of two bodies, as between a thread and its nut, of which a look tests few.
///
/// Pairs are grouped by the contact that they could form: those of a group say the same of the part's motion, so the
/// nearest counts (ContactThinning). Each pair has a Separation, which bounds its distance from below wherever the part
/// goes. A look tests the nearest pair that each group had last, and then those alone that may be nearer. A pair that is
/// not tested is therefore no nearer than one that is, but for a hundredth of the distance that is needed, or it is
/// farther than a distance beyond which a look need not be sure.
///
/// Allocates only in the constructor; real-time safe after it.
class ManyPairs {
 public:
  /// With fewer pairs, testing all of them costs less than bounding them.
  static constexpr std::size_t kFew = 1024;
  /// Max pairs held.
  static constexpr std::size_t kMax = 1U << 15;
  /// Room for contacts that a look needs to go on: of eight pairs of a block, and of as many of each of two kinds that
  /// waited for them.
  static constexpr std::size_t kLeastRoom = 24;
  /// Cell size of the directions that pairs are grouped by; their length is 1.
  static constexpr double kDirectionCell = 0.2;

  ManyPairs();

  /// Becomes a copy of another for looks alone: it holds no other pairs from then on, until it is a copy anew.
  void takeForLooks(const ManyPairs& from) noexcept;

  /// Forgets all pairs.
  void forget() noexcept;
  /// From now on holds these pairs, at most kMax, which span contacts. What is known of those held before stays.
  /// @param pairs  Must outlive the calls of goOnHolding(); no look may begin before these are done.
  /// @param turn   Angle by which the part has turned since the last call, at most [rad].
  void beginHolding(std::span<const LeafPair> pairs, double turn) noexcept;
  /// Goes on with that until it is done, which it returns, or the work is spent.
  /// @param work  Work allowed, as in ContactFinder; the work done is subtracted, down to 0.
  bool goOnHolding(std::uint64_t& work) noexcept;

  /// Parameters of a look.
  struct Asked {
    const NormalConeTree *scene = nullptr, *part = nullptr;
    RigidTransform sceneFromPart;  ///< The look's pose.
    ContactReach reach;
    /// Contacts farther than this need not be found [m]; at most the reach.
    double need = 0.0;
    /// Beyond this, pairs that may be nearer than the nearest of their group are not tested again [m]; at most `need`.
    double sure = 0.0;
    /// Where a pair has lost a contact no farther than this, all pairs so near whose groups have no contact are tested
    /// again: a contact that goes from one feature to the next is not left out [m]; from `sure` to `need`.
    double held = 0.0;
    double cell = 0.0;  ///< Size of the cells that points are grouped by [m]; > 0.
    /// The way that led there, if it is asked how near the pairs come on it; travel and bend apart.
    std::optional<PartWay> way{};
    /// No point of the other body strays farther from the straight line between its places at both ends, as seen from
    /// the part [m].
    double bendFromPart = 0.0;
    double enough = 0.0;  ///< A distance on the way beyond this [m] is as good as any.
  };
  /// Result of a look, besides contacts.
  struct Found {
    /// Lower bound on the distance of any contact [m], by at most a hundredth of `need` less than that of the nearest if
    /// that is nearer than `sure`. Infinity if there is none within the reach.
    double least = 0.0;
    /// Lower bound on the distance on the way, as in PairPassage [m]; at most `enough`.
    double leastOnWay = 0.0;
  };
  double need() const noexcept { return asked_.need; }  ///< Of the last look [m].
  /// Starts a look; what an earlier one has not finished is left. The hierarchies are the same until forget().
  void begin(const Asked& asked) noexcept;
  /// Goes on with a look until it ends or the work is spent.
  /// @param work  Work allowed, as in ContactFinder; the work done is subtracted, down to 0.
  /// @param out   Room for contacts, in the frame of the scene's mesh.
  /// @param count Of those filled, before and after. The look waits where fewer than kLeastRoom are left.
  /// Returns the result once the look has ended.
  std::optional<Found> goOn(std::uint64_t& work, std::span<ContactPair> out, std::size_t& count) noexcept;

 private:
  static constexpr std::size_t kLanes = kPairLanes;
  static constexpr std::uint32_t kNone = ~0U;
  static constexpr double kBeyondAll = std::numeric_limits<double>::infinity();
  /// Slots for pairs separated by the scene, and as many for those separated by the part.
  static constexpr std::size_t kSlotsOfKind = kMax;

  /// A place for a pair: those separated by the scene come before those separated by the part.
  struct Slot {
    LeafPair pair;
    std::uint64_t key = 0;        ///< Cell of its contact; 0 without.
    double turnAt = 0.0;          ///< Turn of the part, added up, when its separation was found [rad].
    double distance = 0.0;        ///< Of its last contact [m]; infinity if the last test found none.
    std::uint32_t group = 0;      ///< 0 if it has none: it is tested whenever it may be near.
    std::uint32_t look = 0;       ///< The look that tested it last.
    std::uint32_t separated = 0;  ///< The look that separated it last without a contact.
    bool isKnown = false;         ///< It has a separation.
    bool isClose = false;         ///< Its features were within `sure` when it was separated last.
  };
  struct Group {
    std::uint64_t key = 0;
    std::uint32_t nearest = kNone;  ///< Slot of the pair that was nearest.
    double least = 0.0;             ///< In this look [m].
  };
  enum class Stage : std::uint8_t { New, Nearest, Rest, Done };
  /// Kinds of pairs that kernels take: without a face, with one of the scene, and with one of the part.
  enum Kind : std::size_t { OfSegments, OfSceneFace, OfPartFace, kKinds };
  static Kind kindOf(const LeafPair& pair) noexcept;
  /// Slots that wait until there are as many as a kernel takes at a time.
  struct Waiting {
    std::array<std::uint32_t, kLanes> at{};
    std::size_t count = 0;
  };
  class LookCall;
  enum class HoldingStage : std::uint8_t { Find, Add, Count, Done };

  /// Fetches into the cache what finding the pair a little after `at` needs.
  void fetchAhead(std::span<const LeafPair> pairs, std::size_t at) const noexcept;
  std::uint32_t find(const LeafPair& pair) const noexcept;
  /// The same, for the pair that comes at place `next` or soon after if the order is that of the last call of beginHolding();
  /// sets `next` to the place after it.
  std::uint32_t findNear(const LeafPair& pair, std::size_t& next) const noexcept;
  std::uint32_t add(const LeafPair& pair) noexcept;
  void insert(std::uint32_t slot) noexcept;
  bool isHeld(std::uint32_t slot) const noexcept {
    return (held_[slot / kLanes] >> (slot % kLanes) & 1U) != 0;
  }
  void setHeld(std::uint32_t slot) noexcept;
  bool isTested(std::uint32_t slot) const noexcept {
    return (tested_[slot / kLanes] >> (slot % kLanes) & 1U) != 0;
  }
  void setTested(std::uint32_t slot, bool isTested) noexcept;
  /// Counts a held pair in its group, or among the new ones.
  void count(std::uint32_t slot) noexcept;
  /// Calls visit(slot) for each slot that was used so far.
  template <class Visit>
  void visitSlots(Visit&& visit) const noexcept;
  /// Frees the slots that are not held, and finds the groups anew.
  void sweep() noexcept;
  std::uint32_t groupOf(std::uint64_t key) noexcept;
  std::uint64_t keyOf(const glm::dvec3& direction, const glm::dvec3& point) const noexcept;

  std::vector<Slot> slots_;
  std::vector<SeparatedPairs> separations_;  ///< A lane for each slot.
  std::vector<std::uint8_t> held_;    ///< For each of separations_, a bit for each lane whose pair is held,
  std::vector<std::uint8_t> tested_;  ///< and for each whose pair was tested since it became known.
  /// Hash table of slots by pair. It holds the pairs themselves: a pair without a slot is told without reading others.
  struct Entry {
    LeafPair pair;
    std::uint32_t slot = kNone;
  };
  std::vector<Entry> table_;
  std::vector<std::uint32_t> places_;  ///< For each slot, its index in order_ when it was held last.
  struct Placed {
    LeafPair pair;
    std::uint32_t slot = 0;
  };
  std::vector<Placed> order_;          ///< Pairs held, in the order of the last call of beginHolding(),
  std::vector<Placed> nextOrder_;      ///< and of the present one.
  std::array<std::size_t, 2> used_{};  ///< Slots used so far, of the scene and of the part.
  std::array<std::vector<std::uint32_t>, 2> free_;
  std::vector<std::uint32_t> new_;  ///< Held slots without a separation.
  std::vector<LeafPair> unknown_;   ///< Pairs to hold that have no slot yet.
  std::vector<Group> groups_;
  std::vector<std::uint32_t> groupTable_;
  std::size_t groupCount_ = 0;
  double turn_ = 0.0;  ///< Turn of the part, added up [rad].

  std::span<const LeafPair> toHold_;
  HoldingStage holdingStage_ = HoldingStage::Done;
  std::size_t holdAt_ = 0;     ///< Where that stage goes on.
  std::size_t nextPlace_ = 0;  ///< In order_, for findNear().

  Asked asked_;
  Stage stage_ = Stage::Done;
  std::size_t at_ = 0;  ///< Where the stage goes on.
  std::uint32_t look_ = 0;
  Found found_;
  bool isLost_ = false;  ///< In this look a pair has lost a contact that held the part.
  /// Pairs to test, of edges, of the scene's faces and of the part's; and pairs to separate, of edges and vertices, of the
  /// scene's faces and of the part's. What waits when the work is spent waits on, so that a look finds the same however it
  /// is cut up.
  std::array<Waiting, kKinds> toTest_, toSeparate_;
  SeparationKernel scan_;
  EdgePairKernels edgeKernels_;
  SegmentSeparationKernel separateSegments_;
  FacePairKernels faceKernels_;
};

}  // namespace nearfit
