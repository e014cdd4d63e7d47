#include "core/servo/many_pairs.h"

#include <algorithm>
#include <bit>
#include <limits>

#include <glm/geometric.hpp>

#include "core/math/mixed_bits.h"
#include "core/math/tolerances.h"
#include "core/proximity/query/feature_corners.h"
#include "core/proximity/query/leaf_tests.h"
#include "core/proximity/query/query_workspace.h"

namespace nearfit {
namespace {

constexpr double kBeyondAll = std::numeric_limits<double>::infinity();
/// Slots for pairs separated by the scene, and as many for those separated by the part.
constexpr std::size_t kSlotsOfKind = ManyPairs::kMax;
constexpr std::size_t kTableSize = 2 * ManyPairs::kMax, kGroupTableSize = 2 * ManyPairs::kMax;
/// Groups are found anew when there are so many, most of them of pairs that are no longer held.
constexpr std::size_t kManyGroups = ManyPairs::kMax / 2;
/// Places looked at for a pair before the hash table: pairs come in the order of the last time, but for some.
constexpr std::size_t kPlacesAhead = 4;
/// Pairs ahead whose entry in the hash table is fetched: it is larger than the nearest caches.
constexpr std::size_t kFetchedAhead = 16;
/// Cell size of directions; their length is 1.
constexpr double kDirectionCell = 0.2;
/// A separation found so large a turn ago is found anew: the part's directions have left their cells [rad].
constexpr double kMaxTurnOfKey = 0.5 * kDirectionCell;
/// Makes cells' numbers positive, so that cutting off the fraction rounds down.
constexpr double kCellsBelowZero = 512.0;
/// A pair that is nearer than the nearest of its group by no more than this share of what is needed is not tested: the
/// part may come so much nearer than its margin, and of pairs that lie along each other nearly all would be tested.
constexpr double kLeastGain = 0.005;
/// Looks after which a pair without a contact is separated anew where its features are so close that each look tests it,
/// whatever its separation.
constexpr std::uint32_t kLooksOfClose = 16;
/// Work of a test, of finding a separation after it, and of a passage; and pairs bounded in a unit of work.
constexpr std::uint64_t kWorkOfExactTest = 2, kWorkOfSeparation = 2, kWorkOfOnePassage = 1;
constexpr std::size_t kBoundedOfWork = 32, kBoundedOnWayOfWork = 16;
/// While pairs are taken over: pairs found, added and counted, and slots swept, in a unit of work; and pairs between two
/// looks at how much work is left.
constexpr std::size_t kFoundOfWork = 3, kAddedOfWork = 4, kCountedOfWork = 8, kSweptOfWork = 8,
                      kHeldAtOnce = 64;

std::uint64_t hashOf(const LeafPair& pair) noexcept {
  return mixedBits(static_cast<std::uint64_t>(pair.scene) << 32U | pair.part);
}

/// Reserves room and writes to it: the servo thread must not wait for the system to provide memory at its first use.
template <class T>
void makeRoom(std::vector<T>& of, std::size_t count) {
  of.resize(count);
  of.clear();
}

std::size_t kindOf(const LeafPair& pair) noexcept {
  return isSeparatedByPart(pair) ? 1 : 0;
}

}  // namespace

ManyPairs::ManyPairs()
    : slots_(2 * kSlotsOfKind),
      separations_(2 * kSlotsOfKind / kLanes),
      held_(separations_.size()),
      tested_(separations_.size()),
      table_(kTableSize),
      places_(2 * kSlotsOfKind),
      groups_(kMax + 1),
      groupTable_(kGroupTableSize, kNone),
      kernel_(separationKernel(defaultSimdLevel())) {
  for (std::vector<std::uint32_t>& slots : free_)
    makeRoom(slots, kSlotsOfKind);
  makeRoom(order_, kMax);
  makeRoom(nextOrder_, kMax);
  makeRoom(new_, kMax);
  makeRoom(unknown_, kMax);
  forget();
}

void ManyPairs::forget() noexcept {
  std::fill(table_.begin(), table_.end(), Entry{});
  std::fill(groupTable_.begin(), groupTable_.end(), kNone);
  std::fill(held_.begin(), held_.end(), std::uint8_t{0});
  used_ = {};
  for (std::vector<std::uint32_t>& slots : free_)
    slots.clear();
  order_.clear();
  new_.clear();
  groupCount_ = 1;
  groups_[0] = {.least = kBeyondAll};
  turn_ = 0.0;
  stage_ = Stage::Done;
  holdingStage_ = HoldingStage::Done;
}

void ManyPairs::takeForLooks(const ManyPairs& from) noexcept {
  used_ = from.used_;
  for (std::size_t kind = 0; kind < used_.size(); ++kind) {
    const std::size_t first = kind * kSlotsOfKind, blocks = (used_[kind] + kLanes - 1) / kLanes;
    std::copy_n(&from.slots_[first], used_[kind], &slots_[first]);
    std::copy_n(&from.separations_[first / kLanes], blocks, &separations_[first / kLanes]);
    std::copy_n(&from.held_[first / kLanes], blocks, &held_[first / kLanes]);
    std::copy_n(&from.tested_[first / kLanes], blocks, &tested_[first / kLanes]);
  }
  groupCount_ = from.groupCount_;
  std::copy_n(from.groups_.begin(), groupCount_, groups_.begin());
  groupTable_ = from.groupTable_;
  new_ = from.new_;
  turn_ = from.turn_;
  look_ = from.look_;
  stage_ = Stage::Done;
  holdingStage_ = HoldingStage::Done;
}

void ManyPairs::fetchAhead(std::span<const LeafPair> pairs, std::size_t at) const noexcept {
  if (at + kFetchedAhead < pairs.size())
    __builtin_prefetch(&table_[hashOf(pairs[at + kFetchedAhead]) % kTableSize]);
}

std::uint32_t ManyPairs::find(const LeafPair& pair) const noexcept {
  for (std::size_t at = hashOf(pair) % kTableSize;; at = (at + 1) % kTableSize) {
    const Entry& entry = table_[at];
    if (entry.slot == kNone || (entry.pair.scene == pair.scene && entry.pair.part == pair.part))
      return entry.slot;
  }
}

std::uint32_t ManyPairs::findNear(const LeafPair& pair, std::size_t& next) const noexcept {
  const std::size_t end = std::min(next + kPlacesAhead, order_.size());
  for (std::size_t i = next; i < end; ++i) {
    const Placed& placed = order_[i];
    if (placed.pair.scene != pair.scene || placed.pair.part != pair.part) continue;
    next = i + 1;
    return placed.slot;
  }
  const std::uint32_t slot = find(pair);
  if (slot != kNone) next = places_[slot] + std::size_t{1};
  return slot;
}

void ManyPairs::setHeld(std::uint32_t slot) noexcept {
  std::uint8_t& lanes = held_[slot / kLanes];
  lanes = static_cast<std::uint8_t>(lanes | 1U << slot % kLanes);
}

void ManyPairs::setTested(std::uint32_t slot, bool isTested) noexcept {
  const unsigned bit = 1U << slot % kLanes, lanes = tested_[slot / kLanes];
  tested_[slot / kLanes] = static_cast<std::uint8_t>(isTested ? lanes | bit : lanes & ~bit);
}

void ManyPairs::insert(std::uint32_t slot) noexcept {
  std::size_t at = hashOf(slots_[slot].pair) % kTableSize;
  while (table_[at].slot != kNone)
    at = (at + 1) % kTableSize;
  table_[at] = {slots_[slot].pair, slot};
}

std::uint32_t ManyPairs::add(const LeafPair& pair) noexcept {
  const std::size_t kind = kindOf(pair);
  std::uint32_t slot;
  if (!free_[kind].empty()) {
    slot = free_[kind].back();
    free_[kind].pop_back();
  } else {
    slot = static_cast<std::uint32_t>(kind * kSlotsOfKind + used_[kind]++);
  }
  slots_[slot] = {.pair = pair, .distance = kBeyondAll};
  insert(slot);
  return slot;
}

template <class Visit>
void ManyPairs::visitSlots(Visit&& visit) const noexcept {
  for (std::size_t kind = 0; kind < used_.size(); ++kind) {
    for (std::size_t i = 0; i < used_[kind]; ++i)
      visit(static_cast<std::uint32_t>(kind * kSlotsOfKind + i));
  }
}

void ManyPairs::sweep() noexcept {
  std::fill(table_.begin(), table_.end(), Entry{});
  std::fill(groupTable_.begin(), groupTable_.end(), kNone);
  groupCount_ = 1;
  groups_[0] = {.least = kBeyondAll};
  for (std::vector<std::uint32_t>& slots : free_)
    slots.clear();
  // The slots that it names may soon be those of other pairs.
  order_.clear();
  visitSlots([this](std::uint32_t at) {
    if (!isHeld(at)) {
      free_[at / kSlotsOfKind].push_back(at);
      return;
    }
    insert(at);
    if (slots_[at].isKnown) slots_[at].group = groupOf(slots_[at].key);
  });
}

void ManyPairs::count(std::uint32_t at) noexcept {
  Slot& slot = slots_[at];
  if (slot.isKnown && turn_ - slot.turnAt > kMaxTurnOfKey) slot.isKnown = false;
  if (!slot.isKnown) {
    new_.push_back(at);
    return;
  }
  if (slot.group == 0 || slot.distance == kBeyondAll) return;
  Group& group = groups_[slot.group];
  if (group.nearest == kNone || slot.distance < slots_[group.nearest].distance) group.nearest = at;
}

void ManyPairs::beginHolding(std::span<const LeafPair> pairs, double turn) noexcept {
  turn_ += turn;
  stage_ = Stage::Done;
  std::fill(held_.begin(), held_.end(), std::uint8_t{0});
  nextOrder_.clear();
  new_.clear();
  unknown_.clear();
  toHold_ = pairs;
  holdingStage_ = HoldingStage::Find;
  holdAt_ = nextPlace_ = 0;
}

bool ManyPairs::goOnHolding(std::uint64_t& work) noexcept {
  const auto spend = [&work](std::uint64_t done) { work -= std::min(work, done); };
  // Calls step(index) from where it was left to the end, and goes to the next stage; false if the work is spent before.
  const auto runStage = [&](std::size_t end, std::size_t ofWork, HoldingStage next, auto&& step) {
    while (holdAt_ < end) {
      if (work == 0) return false;
      const std::size_t stop = std::min(end, holdAt_ + kHeldAtOnce);
      spend(1 + (stop - holdAt_) / ofWork);
      for (; holdAt_ < stop; ++holdAt_)
        step(holdAt_);
    }
    holdAt_ = 0;
    holdingStage_ = next;
    return true;
  };
  const auto keep = [this](const LeafPair& pair, std::uint32_t slot) {
    setHeld(slot);
    nextOrder_.push_back({pair, slot});
  };
  if (holdingStage_ == HoldingStage::Find) {
    const auto findOne = [&](std::size_t i) {
      fetchAhead(toHold_, i);
      const std::uint32_t slot = findNear(toHold_[i], nextPlace_);
      if (slot == kNone)
        unknown_.push_back(toHold_[i]);
      else
        keep(toHold_[i], slot);
    };
    if (!runStage(toHold_.size(), kFoundOfWork, HoldingStage::Add, findOne)) return false;
    const std::size_t there = used_[0] + used_[1] - free_[0].size() - free_[1].size();
    const std::size_t unheld = there - nextOrder_.size();
    // Pairs that come back find their separations, but too many make every pass longer.
    if (unheld > toHold_.size() / 2 || there + unknown_.size() > kMax || groupCount_ > kManyGroups) {
      spend(there / kSweptOfWork);
      sweep();
    }
  }
  if (holdingStage_ == HoldingStage::Add) {
    const auto addOne = [&](std::size_t i) { keep(unknown_[i], add(unknown_[i])); };
    if (!runStage(unknown_.size(), kAddedOfWork, HoldingStage::Count, addOne)) return false;
    for (std::size_t g = 0; g < groupCount_; ++g)
      groups_[g].nearest = kNone;
  }
  if (holdingStage_ == HoldingStage::Count) {
    const auto countOne = [&](std::size_t i) {
      if (i + kFetchedAhead < nextOrder_.size()) {
        const std::uint32_t ahead = nextOrder_[i + kFetchedAhead].slot;
        __builtin_prefetch(&slots_[ahead]);
        __builtin_prefetch(&places_[ahead], 1);
      }
      places_[nextOrder_[i].slot] = static_cast<std::uint32_t>(i);
      count(nextOrder_[i].slot);
    };
    if (!runStage(nextOrder_.size(), kCountedOfWork, HoldingStage::Done, countOne)) return false;
    std::swap(order_, nextOrder_);
  }
  return true;
}

std::uint32_t ManyPairs::groupOf(std::uint64_t key) noexcept {
  if (key == 0) return 0;
  std::size_t at = mixedBits(key) % kGroupTableSize;
  while (groupTable_[at] != kNone) {
    if (groups_[groupTable_[at]].key == key) return groupTable_[at];
    at = (at + 1) % kGroupTableSize;
  }
  if (groupCount_ == groups_.size()) return 0;
  groups_[groupCount_] = {.key = key, .least = kBeyondAll};
  return groupTable_[at] = static_cast<std::uint32_t>(groupCount_++);
}

std::uint64_t ManyPairs::keyOf(const glm::dvec3& direction, const glm::dvec3& point) const noexcept {
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
    append(point[k], asked_.cell);
  return key;
}

void ManyPairs::begin(const Asked& asked) noexcept {
  asked_ = asked;
  found_ = {kBeyondAll, asked.enough};
  stage_ = Stage::New;
  at_ = 0;
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
  const NormalConeTree &scene = *asked_.scene, &part = *asked_.part;
  const RigidTransform pose = centredPose(scene, part, asked_.sceneFromPart);
  const LeafTests tests(scene, part, pose, asked_.reach.distance, asked_.reach.turn);
  const auto spend = [&work](std::uint64_t done) { work -= std::min(work, done); };
  Minimum minimum;
  const auto know = [&](std::uint32_t at, const glm::dvec3& apart, std::uint64_t key) {
    Slot& slot = slots_[at];
    separations_[at / kLanes].set(at % kLanes, separationAlong(scene, part, slot.pair, pose, apart));
    if (!slot.isKnown || slot.key != key || slot.group == 0) slot.group = groupOf(key);
    slot.key = key;
    slot.turnAt = turn_;
    slot.isKnown = true;
  };
  const auto separate = [&](std::uint32_t at) {
    slots_[at].distance = kBeyondAll;
    Slot& slot = slots_[at];
    // A pair that is new in this look has just been separated at this very pose.
    if (slot.isKnown && look_ - slot.separated < (slot.isClose ? kLooksOfClose : 1)) return;
    slot.separated = look_;
    const PairDirections directions = directionsOf(scene, part, slot.pair, pose);
    spend(kWorkOfSeparation);
    know(at, directions.apart, keyOf(directions.ofContact, directions.onPart));
    slot.isClose = directions.distance <= asked_.sure;
  };
  const auto test = [&](std::uint32_t at) {
    Slot& slot = slots_[at];
    slot.look = look_;
    setTested(at, true);
    spend(kWorkOfExactTest);
    if (!tests.test(slot.pair.scene, slot.pair.part, minimum)) {
      separate(at);
      return;
    }
    const Lmd& lmd = minimum.lmd;
    slot.distance = std::min(minimum.least, lmd.distance);
    out[count++] = {lmd.partPoint + scene.centre(), lmd.direction, slot.distance};
    spend(1);
    found_.least = std::min(found_.least, slot.distance);
    know(at, lmd.direction, keyOf(lmd.direction, lmd.partPoint));
    Group& group = groups_[slot.group];
    if (slot.group == 0 || !(slot.distance < group.least)) return;
    group.least = slot.distance;
    group.nearest = at;
  };
  const auto isFull = [&] { return count == out.size(); };
  if (stage_ == Stage::New) {
    for (; at_ < new_.size(); ++at_) {
      if (work == 0) return std::nullopt;
      if (slots_[new_[at_]].isKnown) continue;
      setTested(new_[at_], false);
      separate(new_[at_]);
    }
    new_.clear();
    stage_ = Stage::Nearest;
    at_ = 0;
  }
  if (stage_ == Stage::Nearest) {
    for (; at_ < groupCount_; ++at_) {
      if (work == 0 || isFull()) return std::nullopt;
      const std::uint32_t nearest = groups_[at_].nearest;
      if (nearest == kNone || slots_[nearest].look == look_ || slots_[nearest].distance > asked_.need)
        continue;
      test(nearest);
      if (slots_[nearest].distance == kBeyondAll && groups_[at_].nearest == nearest)
        groups_[at_].nearest = kNone;
    }
    stage_ = Stage::Rest;
    at_ = 0;
  }
  if (stage_ == Stage::Done) return found_;
  const double rounding =
      kSeparationRoundings * kPointRounding * (scene.size() + part.size() + glm::length(pose.translation));
  const double gain = kLeastGain * asked_.need, sure = std::min(asked_.sure, asked_.need),
               least = asked_.enough + rounding;
  std::array<SeparationScan, 2> scans;
  for (std::size_t kind = 0; kind < scans.size(); ++kind)
    scans[kind] = {.pose = separationPose(pose, kind != 0),
                   .near = asked_.need + rounding,
                   .nearOfTested = sure + rounding};
  std::optional<PairPassage> passage;
  if (asked_.way) {
    const RigidTransform from = centredPose(scene, part, asked_.way->from);
    for (std::size_t kind = 0; kind < scans.size(); ++kind) {
      scans[kind].isOfWay = true;
      scans[kind].start = separationPose(from, kind != 0);
      scans[kind].nearOnWay = least + (kind != 0 ? asked_.bendFromPart : asked_.way->bend);
    }
    passage.emplace(scene, part, *asked_.way, asked_.enough);
  }
  const auto lookAt = [&](std::uint32_t at, double bound) {
    const Slot& slot = slots_[at];
    if (slot.look == look_) return;
    if (bound <= groups_[slot.group].least - gain)
      test(at);
    else
      found_.least = std::min(found_.least, bound);
  };
  const std::size_t boundedOfWork = asked_.way ? kBoundedOnWayOfWork : kBoundedOfWork;
  SeparationsFound found;
  for (std::size_t kind = at_ / kSlotsOfKind; kind < used_.size(); at_ = ++kind * kSlotsOfKind) {
    const std::size_t end = (kind * kSlotsOfKind + used_[kind] + kLanes - 1) / kLanes;
    while (at_ / kLanes < end) {
      if (work == 0) return std::nullopt;
      const std::size_t first = at_ / kLanes, blocks = std::min(SeparationsFound::kMostBlocks, end - first);
      kernel_(&separations_[first], &held_[first], &tested_[first], blocks, scans[kind], found);
      spend(1 + blocks * kLanes / boundedOfWork);
      found_.least = std::min(found_.least, found.lowest - rounding);
      for (std::size_t block = 0; block < blocks; ++block, at_ += kLanes) {
        const unsigned near = found.near[block], onWay = found.nearOnWay[block];
        if ((near | onWay) == 0) continue;
        if (work == 0 || count + kLanes > out.size()) return std::nullopt;
        for (unsigned lanes = onWay; lanes != 0; lanes &= lanes - 1) {
          const Slot& slot = slots_[at_ + static_cast<std::size_t>(std::countr_zero(lanes))];
          found_.leastOnWay = std::min(found_.leastOnWay, passage->leastOf(slot.pair));
          spend(kWorkOfOnePassage);
        }
        for (unsigned lanes = near; lanes != 0; lanes &= lanes - 1) {
          const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
          lookAt(static_cast<std::uint32_t>(at_ + lane), found.apart[block][lane] - rounding);
        }
      }
    }
  }
  stage_ = Stage::Done;
  return found_;
}

}  // namespace nearfit
