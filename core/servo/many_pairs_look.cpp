#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "core/math/tolerances.h"
#include "core/proximity/query/feature_corners.h"
#include "core/proximity/query/leaf_tests.h"
#include "core/proximity/query/query_workspace.h"
#include "core/servo/many_pairs.h"

namespace nearfit {
namespace {

/// Makes cells' numbers positive, so that cutting off the fraction rounds down.
constexpr double kCellsBelowZero = 512.0;
/// A pair that is nearer than the nearest of its group by no more than this share of what is needed is not tested: the
/// part may come so much nearer than its margin, and of pairs that lie along each other nearly all would be tested.
constexpr double kLeastGain = 0.005;
/// Looks after which a pair without a contact is separated anew where its features are so close that each look tests it,
/// whatever its separation.
constexpr std::uint32_t kLooksOfClose = 16;
/// Work of a test by itself, of one among those of a kernel, of finding a separation, and of a passage; and pairs bounded
/// in a unit of work.
constexpr std::uint64_t kWorkOfExactTest = 2, kWorkOfTestAmongEight = 1, kWorkOfSeparation = 1,
                        kWorkOfOnePassage = 1;
constexpr std::size_t kBoundedOfWork = 32, kBoundedOnWayOfWork = 16;

}  // namespace

/// One call of goOn(): the look's pose, the work allowed, and the room for contacts.
class ManyPairs::LookCall {
 public:
  LookCall(ManyPairs& many, std::uint64_t& work, std::span<ContactPair> out, std::size_t& count) noexcept
      : many_(many),
        scene_(*many.asked_.scene),
        part_(*many.asked_.part),
        pose_(centredPose(scene_, part_, many.asked_.sceneFromPart)),
        tests_(scene_, part_, pose_, many.asked_.reach.distance, many.asked_.reach.turn),
        work_(work),
        out_(out),
        count_(count) {}

  // Each goes through a stage and ends it; false if the work or the room is spent before.
  bool separateNew() noexcept;
  bool testNearest() noexcept;
  bool testRest() noexcept;

 private:
  /// Slots and pairs that go to a kernel; in the lanes after `count` the last is repeated.
  struct Taken {
    std::array<std::uint32_t, kLanes> at;
    std::array<LeafPair, kLanes> pairs;
    std::size_t count;
  };
  void spend(std::uint64_t work) noexcept { work_ -= std::min(work_, work); }
  /// True if the pairs of a block can be tested, and what waits with them.
  bool canTest() const noexcept { return work_ > 0 && count_ + kLeastRoom <= out_.size(); }
  std::uint64_t keyOf(const glm::dvec3& direction, const glm::dvec3& point) const noexcept;
  void test(std::uint32_t at) noexcept;
  void testOne(std::uint32_t at) noexcept;
  void testWaiting(Kind kind) noexcept;
  void testEdges(const Taken& taken) noexcept;
  void testFaces(const Taken& taken, bool areOfPart) noexcept;
  /// Takes the contact that a test has put into minimum_, if it has found one.
  void takeIf(bool isFound, std::uint32_t at) noexcept;
  void take(std::uint32_t at, const ContactPair& contact) noexcept;
  void separate(std::uint32_t at) noexcept;
  void separateWaiting(Kind kind) noexcept;
  void separateSegments(const Taken& taken) noexcept;
  void separateFaces(const Taken& taken, bool areOfPart) noexcept;
  /// Tests and separates what waits.
  void endStage() noexcept;
  void know(std::uint32_t at, const Separation& separation, std::uint64_t key) noexcept;
  void knowSeparated(std::uint32_t at, const Separation& separation,
                     const PairDirections& directions) noexcept;
  /// Takes the pairs that wait, at least one.
  Taken takeWaiting(Waiting& waiting) const noexcept;
  const RigidTransform& faceFromVertex(bool facesArePart) const noexcept {
    return facesArePart ? tests_.partFromScene() : tests_.sceneFromPart();
  }
  void lookAt(std::uint32_t at, double bound, double gain) noexcept;

  ManyPairs& many_;
  const NormalConeTree &scene_, &part_;
  const RigidTransform pose_;
  const LeafTests tests_;
  std::uint64_t& work_;
  std::span<ContactPair> out_;
  std::size_t& count_;
  Minimum minimum_;
};

std::uint64_t ManyPairs::LookCall::keyOf(const glm::dvec3& direction,
                                         const glm::dvec3& point) const noexcept {
  if (direction == glm::dvec3(0.0)) return 0;
  std::uint64_t key = 1;
  const auto append = [&key](double x, double cell) {
    // Ten bits each: contacts lie within the part, which is some tens of cells wide, and cells so far apart that their
    // numbers agree are not near it at once.
    const auto step = static_cast<std::int64_t>(x / cell + kCellsBelowZero) & 0x3FF;
    key = key << 10U | static_cast<std::uint64_t>(step);
  };
  for (glm::length_t k = 0; k < 3; ++k)
    append(direction[k], kDirectionCell);
  for (glm::length_t k = 0; k < 3; ++k)
    append(point[k], many_.asked_.cell);
  return key;
}

void ManyPairs::LookCall::know(std::uint32_t at, const Separation& separation, std::uint64_t key) noexcept {
  Slot& slot = many_.slots_[at];
  many_.separations_[at / kLanes].set(at % kLanes, separation);
  if (!slot.isKnown || slot.key != key || slot.group == 0) slot.group = many_.groupOf(key);
  slot.key = key;
  slot.turnAt = many_.turn_;
  slot.isKnown = true;
}

ManyPairs::LookCall::Taken ManyPairs::LookCall::takeWaiting(Waiting& waiting) const noexcept {
  Taken taken{.at = waiting.at, .pairs = {}, .count = std::exchange(waiting.count, 0)};
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    taken.pairs[lane] = many_.slots_[taken.at[std::min(lane, taken.count - 1)]].pair;
  return taken;
}

ManyPairs::Kind ManyPairs::kindOf(const LeafPair& pair) noexcept {
  return isOfSegments(pair) ? OfSegments : isSeparatedByPart(pair) ? OfPartFace : OfSceneFace;
}

void ManyPairs::LookCall::separate(std::uint32_t at) noexcept {
  Slot& slot = many_.slots_[at];
  many_.isLost_ = many_.isLost_ || slot.distance <= many_.asked_.held;
  slot.distance = kBeyondAll;
  // A pair that is new in this look has just been separated at this very pose.
  if (slot.isKnown && many_.look_ - slot.separated < (slot.isClose ? kLooksOfClose : 1)) return;
  slot.separated = many_.look_;
  spend(kWorkOfSeparation);
  const Kind kind = kindOf(slot.pair);
  Waiting& waiting = many_.toSeparate_[kind];
  waiting.at[waiting.count++] = at;
  if (waiting.count == kLanes) separateWaiting(kind);
}

void ManyPairs::LookCall::knowSeparated(std::uint32_t at, const Separation& separation,
                                        const PairDirections& directions) noexcept {
  know(at, separation, keyOf(directions.ofContact, directions.onPart));
  many_.slots_[at].isClose = directions.distance <= many_.asked_.sure;
}

void ManyPairs::LookCall::separateWaiting(Kind kind) noexcept {
  if (many_.toSeparate_[kind].count == 0) return;
  const Taken taken = takeWaiting(many_.toSeparate_[kind]);
  if (kind == OfSegments)
    separateSegments(taken);
  else
    separateFaces(taken, kind == OfPartFace);
}

void ManyPairs::LookCall::separateSegments(const Taken& taken) noexcept {
  SegmentPairs packed;
  packSegmentPairs(scene_, part_, taken.pairs, packed);
  SegmentSeparations found;
  many_.separateSegments_(packed, separationPose(pose_, false), found);
  for (std::size_t lane = 0; lane < taken.count; ++lane) {
    if ((found.undecided >> lane & 1U) != 0) {
      const LeafPair& pair = taken.pairs[lane];
      const PairDirections directions = directionsOf(scene_, part_, pair, pose_);
      knowSeparated(taken.at[lane], separationAlong(scene_, part_, pair, pose_, directions.apart),
                    directions);
      continue;
    }
    const PairDirections directions = found.directions(lane);
    knowSeparated(taken.at[lane],
                  {.direction = directions.apart,
                   .height = found.height[lane],
                   .ends = {vectorIn(packed.part[0], lane), vectorIn(packed.part[1], lane)}},
                  directions);
  }
}

void ManyPairs::LookCall::separateFaces(const Taken& taken, bool areOfPart) noexcept {
  FacePairs packed;
  packFacePairs(scene_, part_, taken.pairs, areOfPart, packed);
  FaceSeparations found;
  many_.faceKernels_.separate(packed, faceFromVertex(areOfPart), found);
  for (std::size_t lane = 0; lane < taken.count; ++lane) {
    const glm::dvec3 vertex = vectorIn(packed.vertex, lane), apart = vectorIn(found.apart, lane),
                     normal = vectorIn(found.normal, lane);
    knowSeparated(
        taken.at[lane],
        {.isOfPart = areOfPart, .direction = apart, .height = found.height[lane], .ends = {vertex, vertex}},
        {.apart = apart,
         .ofContact = areOfPart ? pose_.applyToVector(-normal) : normal,
         .onPart = areOfPart ? vertex : vectorIn(found.vertex, lane),
         .distance = found.distance[lane]});
  }
}

void ManyPairs::LookCall::test(std::uint32_t at) noexcept {
  const LeafPair& pair = many_.slots_[at].pair;
  many_.slots_[at].look = many_.look_;
  many_.setTested(at, true);
  // Kernels test relaxed directions only, of edges and of faces.
  const Kind kind = kindOf(pair);
  if (!(many_.asked_.reach.turn > 0.0) || (kind == OfSegments && !isOfEdges(pair))) {
    spend(kWorkOfExactTest);
    testOne(at);
    return;
  }
  spend(kWorkOfTestAmongEight);
  Waiting& waiting = many_.toTest_[kind];
  waiting.at[waiting.count++] = at;
  if (waiting.count == kLanes) testWaiting(kind);
}

void ManyPairs::LookCall::testOne(std::uint32_t at) noexcept {
  const LeafPair& pair = many_.slots_[at].pair;
  takeIf(tests_.test(pair.scene, pair.part, minimum_), at);
}

void ManyPairs::LookCall::takeIf(bool isFound, std::uint32_t at) noexcept {
  if (!isFound) {
    separate(at);
    return;
  }
  const Lmd& lmd = minimum_.lmd;
  take(at, {lmd.partPoint, lmd.direction, std::min(minimum_.least, lmd.distance)});
}

void ManyPairs::LookCall::testWaiting(Kind kind) noexcept {
  if (many_.toTest_[kind].count == 0) return;
  const Taken taken = takeWaiting(many_.toTest_[kind]);
  if (kind == OfSegments)
    testEdges(taken);
  else
    testFaces(taken, kind == OfPartFace);
}

void ManyPairs::LookCall::testEdges(const Taken& taken) noexcept {
  EdgePairs packed;
  packEdgePairs(scene_, part_, taken.pairs, many_.edgeKernels_, packed);
  EdgePairHits hits;
  many_.edgeKernels_.test(packed, tests_.sceneFromPart(), tests_.partFromScene(), tests_.edgePairLimits(),
                          hits);
  for (std::size_t lane = 0; lane < taken.count; ++lane) {
    if ((hits.undecided >> lane & 1U) != 0)
      testOne(taken.at[lane]);
    else if ((hits.found >> lane & 1U) != 0)
      take(taken.at[lane],
           {vectorIn(hits.partPoint, lane), vectorIn(hits.direction, lane), hits.distance[lane]});
    else
      separate(taken.at[lane]);
  }
}

void ManyPairs::LookCall::testFaces(const Taken& taken, bool areOfPart) noexcept {
  FacePairs packed;
  packFacePairs(scene_, part_, taken.pairs, areOfPart, packed);
  FacePairHits hits;
  many_.faceKernels_.test(packed, faceFromVertex(areOfPart), tests_.edgePairLimits(), hits);
  for (std::size_t lane = 0; lane < taken.count; ++lane) {
    const LeafPair& pair = taken.pairs[lane];
    const bool isFound = (hits.over >> lane & 1U) != 0 &&
                         tests_.testOverFace(pair.scene, pair.part,
                                             {vectorIn(hits.vertex, lane), vectorIn(hits.normal, lane),
                                              hits.distance[lane], hits.tilt[lane]},
                                             minimum_);
    takeIf(isFound, taken.at[lane]);
  }
}

void ManyPairs::LookCall::endStage() noexcept {
  for (const Kind kind : {OfSegments, OfSceneFace, OfPartFace})
    testWaiting(kind);
  for (const Kind kind : {OfSegments, OfSceneFace, OfPartFace})
    separateWaiting(kind);
}

/// @param contact  In the scene's centred frame.
void ManyPairs::LookCall::take(std::uint32_t at, const ContactPair& contact) noexcept {
  Slot& slot = many_.slots_[at];
  slot.distance = contact.distance;
  out_[count_++] = {contact.point + scene_.centre(), contact.direction, contact.distance};
  spend(1);
  many_.found_.least = std::min(many_.found_.least, slot.distance);
  know(at, separationAlong(scene_, part_, slot.pair, pose_, contact.direction),
       keyOf(contact.direction, contact.point));
  Group& group = many_.groups_[slot.group];
  if (slot.group == 0 || !(slot.distance < group.least)) return;
  group.least = slot.distance;
  group.nearest = at;
}

bool ManyPairs::LookCall::separateNew() noexcept {
  for (; many_.at_ < many_.new_.size(); ++many_.at_) {
    if (work_ == 0) return false;
    const std::uint32_t at = many_.new_[many_.at_];
    if (many_.slots_[at].isKnown) continue;
    many_.setTested(at, false);
    separate(at);
  }
  endStage();
  many_.new_.clear();
  return true;
}

bool ManyPairs::LookCall::testNearest() noexcept {
  for (; many_.at_ < many_.groupCount_; ++many_.at_) {
    if (!canTest()) return false;
    const std::uint32_t nearest = many_.groups_[many_.at_].nearest;
    if (nearest == kNone) continue;
    const Slot& slot = many_.slots_[nearest];
    if (slot.look != many_.look_ && slot.distance <= many_.asked_.need) test(nearest);
  }
  if (!canTest()) return false;
  endStage();
  return true;
}

void ManyPairs::LookCall::lookAt(std::uint32_t at, double bound, double gain) noexcept {
  const Slot& slot = many_.slots_[at];
  if (slot.look == many_.look_) return;
  const double least = many_.groups_[slot.group].least;
  // Pairs beyond `sure` that were tested before are here for contacts that are lost.
  const bool isNeeded = bound <= many_.asked_.sure || least == kBeyondAll || !many_.isTested(at);
  if (isNeeded && bound <= least - gain)
    test(at);
  else
    many_.found_.least = std::min(many_.found_.least, bound);
}

bool ManyPairs::LookCall::testRest() noexcept {
  const Asked& asked = many_.asked_;
  Found& result = many_.found_;
  const double rounding =
      kSeparationRoundings * kPointRounding * (scene_.size() + part_.size() + glm::length(pose_.translation));
  const double gain = kLeastGain * asked.need, sure = many_.isLost_ ? asked.held : asked.sure,
               least = asked.enough + rounding;
  std::array<SeparationScan, 2> scans;
  for (std::size_t kind = 0; kind < scans.size(); ++kind)
    scans[kind] = {.pose = separationPose(pose_, kind != 0),
                   .near = asked.need + rounding,
                   .nearOfTested = sure + rounding};
  std::optional<PairPassage> passage;
  if (asked.way) {
    const RigidTransform from = centredPose(scene_, part_, asked.way->from);
    for (std::size_t kind = 0; kind < scans.size(); ++kind) {
      scans[kind].isOfWay = true;
      scans[kind].start = separationPose(from, kind != 0);
      scans[kind].nearOnWay = least + (kind != 0 ? asked.bendFromPart : asked.way->bend);
    }
    passage.emplace(scene_, part_, *asked.way, asked.enough);
  }
  const std::size_t boundedOfWork = asked.way ? kBoundedOnWayOfWork : kBoundedOfWork;
  std::size_t& at = many_.at_;
  SeparationsFound found;
  for (std::size_t kind = at / kSlotsOfKind; kind < many_.used_.size(); at = ++kind * kSlotsOfKind) {
    const std::size_t end = (kind * kSlotsOfKind + many_.used_[kind] + kLanes - 1) / kLanes;
    while (at / kLanes < end) {
      if (work_ == 0) return false;
      const std::size_t first = at / kLanes, blocks = std::min(SeparationsFound::kMostBlocks, end - first);
      many_.scan_(&many_.separations_[first], &many_.held_[first], &many_.tested_[first], blocks, scans[kind],
                  found);
      spend(1 + blocks * kLanes / boundedOfWork);
      result.least = std::min(result.least, found.lowest - rounding);
      for (std::size_t block = 0; block < blocks; ++block, at += kLanes) {
        const unsigned near = found.near[block], onWay = found.nearOnWay[block];
        if ((near | onWay) == 0) continue;
        if (!canTest()) return false;
        for (unsigned lanes = onWay; lanes != 0; lanes &= lanes - 1) {
          const Slot& slot = many_.slots_[at + static_cast<std::size_t>(std::countr_zero(lanes))];
          result.leastOnWay = std::min(result.leastOnWay, passage->leastOf(slot.pair));
          spend(kWorkOfOnePassage);
        }
        for (unsigned lanes = near; lanes != 0; lanes &= lanes - 1) {
          const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
          lookAt(static_cast<std::uint32_t>(at + lane), found.apart[block][lane] - rounding, gain);
        }
      }
    }
  }
  if (!canTest()) return false;
  endStage();
  return true;
}

void ManyPairs::begin(const Asked& asked) noexcept {
  asked_ = asked;
  found_ = {kBeyondAll, asked.enough};
  stage_ = Stage::New;
  isLost_ = false;
  at_ = 0;
  for (std::size_t kind = 0; kind < kKinds; ++kind)
    toTest_[kind].count = toSeparate_[kind].count = 0;
  // When the number comes round, no slot may count as tested.
  if (++look_ == 0) {
    for (Slot& slot : slots_)
      slot.look = slot.separated = 0;
    look_ = 1;
  }
  for (std::size_t g = 0; g < groupCount_; ++g)
    groups_[g].least = kBeyondAll;
}

std::optional<ManyPairs::Found> ManyPairs::goOn(std::uint64_t& work, std::span<ContactPair> out,
                                                std::size_t& count) noexcept {
  if (stage_ == Stage::Done) return found_;
  LookCall call(*this, work, out, count);
  const auto next = [this](Stage stage) {
    stage_ = stage;
    at_ = 0;
  };
  if (stage_ == Stage::New) {
    if (!call.separateNew()) return std::nullopt;
    next(Stage::Nearest);
  }
  if (stage_ == Stage::Nearest) {
    if (!call.testNearest()) return std::nullopt;
    next(Stage::Rest);
  }
  if (!call.testRest()) return std::nullopt;
  next(Stage::Done);
  return found_;
}

}  // namespace nearfit
