#include "core/servo/many_pairs.h"

#include <algorithm>

#include "core/math/mixed_bits.h"

namespace nearfit {
namespace {

constexpr std::size_t kTableSize = 2 * ManyPairs::kMax, kGroupTableSize = 2 * ManyPairs::kMax;
/// Groups are found anew when there are so many, most of them of pairs that are no longer held.
constexpr std::size_t kManyGroups = ManyPairs::kMax / 2;
/// Places looked at for a pair before the hash table: pairs come in the order of the last time, but for some.
constexpr std::size_t kPlacesAhead = 4;
/// Pairs ahead whose entry in the hash table is fetched: it is larger than the nearest caches.
constexpr std::size_t kFetchedAhead = 16;
/// A separation found so large a turn ago is found anew: the part's directions have left their cells [rad].
constexpr double kMaxTurnOfKey = 0.5 * ManyPairs::kDirectionCell;
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

/// Which half of the slots a pair goes to.
std::size_t halfOf(const LeafPair& pair) noexcept {
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
      scan_(separationKernel(defaultSimdLevel())),
      edgeKernels_(edgePairKernels(defaultSimdLevel())),
      separateSegments_(segmentSeparationKernel(defaultSimdLevel())),
      faceKernels_(facePairKernels(defaultSimdLevel())) {
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
  const std::size_t kind = halfOf(pair);
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

}  // namespace nearfit
