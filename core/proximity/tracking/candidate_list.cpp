#include "core/proximity/tracking/candidate_list.h"

#include <algorithm>
#include <bit>
#include <limits>

#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"
#include "core/proximity/query/leaf_tests.h"
#include "core/proximity/query/query_workspace.h"

namespace nearfit {
namespace {

constexpr std::size_t kNodeWidth = NormalConeTree::kWidth;
static_assert(kNodeWidth == kListedAtOnce);

constexpr std::size_t blocksOf(std::size_t pairs) noexcept {
  return (pairs + kNodeWidth - 1) / kNodeWidth;
}

/// Number of pairs that can be listed within so much work.
constexpr std::uint64_t listable(std::uint64_t work) noexcept {
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max() / kListedAtOnce;
  return kListedAtOnce * std::min(work, kMax);
}

void copyLane(const NormalConeTree::Node& from, std::size_t lane, NormalConeTree::Node& to,
              std::size_t at) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    to.centre[k][at] = from.centre[k][lane];
    to.n[k][at] = from.n[k][lane];
    to.u[k][at] = from.u[k][lane];
    to.half[k][at] = from.half[k][lane];
  }
  to.leastN[at] = from.leastN[lane];
  to.mostU[at] = from.mostU[lane];
  to.mostV[at] = from.mostV[lane];
  to.child[at] = from.child[lane];
}

/// Tests pairs one by one: for all minima with half of the work allowed, then for the nearest only.
class BoundedTests {
 public:
  /// @param query   Its pose is between the centred frames.
  /// @param limits  Limits of the culls before the tests; tightened on the way.
  BoundedTests(const BodyPairQuery& query, std::uint64_t maxTests, MinimaCollector& collector,
               CullLimits& limits) noexcept
      : tests_(query.scene, query.part, query.sceneFromPart, query.cutoff),
        collector_(collector),
        limits_(limits),
        cutoff_(query.cutoff),
        maxTests_(maxTests) {}

  void test(std::uint32_t sceneLeaf, std::uint32_t partLeaf) noexcept {
    if (count_ == maxTests_) {
      isSpent_ = true;
      return;
    }
    ++count_;
    Minimum& slot = collector_.slot();
    if (tests_.test(sceneLeaf, partLeaf, slot)) {
      nearest_ = std::min(nearest_, slot.lmd.distance);
      collector_.add();
    }
    if (count_ > maxTests_ / 2)
      limits_.cutoff = std::min(limits_.cutoff, static_cast<float>(kNearestSlack * nearest_));
  }

  std::uint64_t count() const noexcept { return count_; }
  /// Every minimum nearer than this was found [m].
  double completeTo() const noexcept {
    return isSpent_ ? 0.0 : count_ > maxTests_ / 2 ? std::min(cutoff_, nearest_) : cutoff_;
  }

 private:
  const LeafTests tests_;
  MinimaCollector& collector_;
  CullLimits& limits_;
  double cutoff_, nearest_ = std::numeric_limits<double>::infinity();
  std::uint64_t maxTests_, count_ = 0;
  bool isSpent_ = false;
};

}  // namespace

RangeLimits CandidateList::limitsWithin(double share) const noexcept {
  return rangeLimits({*scene_, *part_, {}, cutoff_}, pose_, relaxed(share * range_, cutoff_, relaxation_));
}

void CandidateList::build(const BodyPairQuery& query, const MotionRange& range, LmdScratch& scratch,
                          const Bounds& bounds, double relaxation, bool hasLevels) {
  scene_ = &query.scene;
  part_ = &query.part;
  cutoff_ = query.cutoff;
  relaxation_ = relaxation;
  range_ = range;
  isUsable_ = true;
  searchWork_ = 0;
  found_.clear();
  levelEnds_.fill(0);
  if (!isQueryValid(query.scene, query.part, query.sceneFromPart, query.cutoff)) return;
  pose_ = centredPose(query.scene, query.part, query.sceneFromPart);
  LmdScratch::Data& workspace = scratch.data();
  const RangeLimits limits = limitsWithin(1.0);
  const auto outermost = static_cast<std::uint8_t>(hasLevels ? kLevels.size() - 1 : 0);
  TreeTraversal traversal(*scene_, *part_, pose_, limits.still,
                          relaxation_ > 0.0 ? workspace.openSweptContacts : workspace.openSwept,
                          workspace.traversal);
  traversal.setSweep(limits.inScene, limits.inPart);
  isUsable_ = traversal.run(
      [&](const EntryPair& pair) {
        if (found_.size() <= bounds.pairs) found_.push_back({pair.sceneLane, pair.partLane, outermost});
      },
      bounds.nodePairs);
  searchWork_ = traversal.nodePairs();
  isUsable_ = isUsable_ && found_.size() <= bounds.pairs;
  if (!isUsable_) {
    found_.clear();
    return;
  }
  if (hasLevels) findLevels(workspace);
  pack();
}

void CandidateList::findLevels(const LmdScratch::Data& workspace) noexcept {
  const SinglePose pose(pose_);
  std::array<RangeLimits, kLevels.size()> limits;
  for (std::size_t level = 0; level < kLevels.size(); ++level)
    limits[level] = limitsWithin(kLevels[level]);
  BoundPairs block;
  for (std::size_t base = 0; base < found_.size(); base += kNodeWidth) {
    const std::size_t count = std::min(kNodeWidth, found_.size() - base);
    // Unused lanes repeat the first pair.
    for (std::size_t i = 0; i < kNodeWidth; ++i)
      copyPair(found_[base + (i < count ? i : 0)], block, i);
    for (std::size_t level = kLevels.size() - 1; level-- > 0;) {
      const std::uint32_t alive =
          workspace.sweptPairCull(block, pose, limits[level].still, limits[level].inScene);
      for (std::size_t i = 0; i < count; ++i) {
        LanePair& pair = found_[base + i];
        if (pair.level == level + 1 && (alive >> i & 1U) != 0) pair.level = static_cast<std::uint8_t>(level);
      }
    }
  }
}

void CandidateList::pack() {
  for (const LanePair& pair : found_)
    ++levelEnds_[pair.level];
  std::array<std::size_t, kLevels.size()> next{};
  for (std::size_t level = 0, sum = 0; level < kLevels.size(); ++level) {
    next[level] = sum;
    sum += levelEnds_[level];
    levelEnds_[level] = sum;
  }
  blocks_.resize(std::max(blocks_.size(), blocksOf(found_.size())));
  for (const LanePair& pair : found_) {
    const std::size_t at = next[pair.level]++;
    copyPair(pair, blocks_[at / kNodeWidth], at % kNodeWidth);
  }
  // Unused lanes of the last block repeat its first pair; they are never counted.
  for (std::size_t i = found_.size(); i % kNodeWidth != 0; ++i) {
    BoundPairs& block = blocks_[i / kNodeWidth];
    copyLane(block.scene, 0, block.scene, i % kNodeWidth);
    copyLane(block.part, 0, block.part, i % kNodeWidth);
  }
}

void CandidateList::copyPair(const LanePair& pair, BoundPairs& block, std::size_t at) const noexcept {
  copyLane(scene_->nodes()[pair.sceneLane / kNodeWidth], pair.sceneLane % kNodeWidth, block.scene, at);
  copyLane(part_->nodes()[pair.partLane / kNodeWidth], pair.partLane % kNodeWidth, block.part, at);
}

double CandidateList::spentAt(const RigidTransform& centred) const noexcept {
  return spentShare(range_, pose_, centred, 0.5 * part_->size());
}

MotionBudget CandidateList::asideOf(const RigidTransform& centred) const noexcept {
  const double radius = 0.5 * part_->size();
  const double time = nearestTime(range_.stretch, pose_, centred, radius);
  return motionBetween(poseOn(range_.stretch, pose_, time), centred, radius);
}

double CandidateList::spent(const RigidTransform& sceneFromPart) const noexcept {
  if (!isUsable_ || !sceneFromPart.isFinite()) return std::numeric_limits<double>::infinity();
  return spentAt(centredPose(*scene_, *part_, sceneFromPart));
}

double CandidateList::roomLeft(const RigidTransform& sceneFromPart) const noexcept {
  if (!isUsable_ || !sceneFromPart.isFinite()) return -std::numeric_limits<double>::infinity();
  return 1.0 - spentShare(asideOf(centredPose(*scene_, *part_, sceneFromPart)), range_.budget);
}

double CandidateList::timeAt(const RigidTransform& sceneFromPart) const noexcept {
  if (!isUsable_ || !sceneFromPart.isFinite()) return std::numeric_limits<double>::infinity();
  return timeAlong(range_.stretch, pose_, centredPose(*scene_, *part_, sceneFromPart), 0.5 * part_->size());
}

bool CandidateList::covers(const RigidTransform& sceneFromPart, double cutoff) const noexcept {
  return cutoff <= cutoff_ && spent(sceneFromPart) <= 1.0;
}

std::size_t CandidateList::countFor(double share) const noexcept {
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    if (share <= kLevels[level]) return levelEnds_[level];
  }
  return levelEnds_.back();
}

std::optional<CandidateList::CoveredPose> CandidateList::covered(const RigidTransform& sceneFromPart,
                                                                 double cutoff) const noexcept {
  if (!isUsable_ || !(cutoff <= cutoff_) || !sceneFromPart.isFinite()) return std::nullopt;
  const RigidTransform pose = centredPose(*scene_, *part_, sceneFromPart);
  const double share = spentAt(pose);
  if (!(share <= 1.0)) return std::nullopt;
  const bool isValid = isQueryValid(*scene_, *part_, sceneFromPart, cutoff);
  return CoveredPose{pose, isValid ? countFor(share) : 0};
}

template <class Cull, class Visit>
std::size_t CandidateList::visitPairs(std::size_t count, Cull&& cull, Visit&& visit) const noexcept {
  for (std::size_t base = 0; base < count; base += kNodeWidth) {
    const BoundPairs& block = blocks_[base / kNodeWidth];
    std::uint32_t lanes = cull(block);
    if (count - base < kNodeWidth) lanes &= (1U << (count - base)) - 1U;
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
      if (!visit(block.scene.child[lane], block.part.child[lane])) return base / kNodeWidth + 1;
    }
  }
  return blocksOf(count);
}

void CandidateList::appendPairs(std::vector<LeafPair>& out) const {
  visitPairs(
      size(), [](const BoundPairs&) { return (1U << kNodeWidth) - 1U; },
      [&](std::uint32_t sceneLeaf, std::uint32_t partLeaf) {
        out.push_back({sceneLeaf, partLeaf});
        return true;
      });
}

std::optional<LmdResult> CandidateList::query(const RigidTransform& sceneFromPart, double cutoff,
                                              LmdScratch& scratch, std::span<Lmd> out,
                                              std::uint64_t maxWork) const noexcept {
  const std::optional<CoveredPose> pose = covered(sceneFromPart, cutoff);
  if (!pose) return std::nullopt;
  LmdResult result;
  result.completeTo = cutoff;
  if (pose->count == 0) return result;
  const std::uint64_t blocks = blocksOf(pose->count);
  if (blocks >= maxWork) {
    result.status = QueryStatus::Truncated;
    result.completeTo = 0.0;
    return result;
  }
  result.nodePairs = blocks;
  MinimaCollector collector(scratch.data(), result);
  CullLimits limits = cullLimits(*scene_, *part_, pose->centred, cutoff);
  BoundedTests tests({*scene_, *part_, pose->centred, cutoff}, (maxWork - blocks) / kWorkOfLeafTest,
                     collector, limits);
  const SinglePose inSingle(pose->centred);
  visitPairs(
      pose->count, [&](const BoundPairs& block) { return scratch.data().pairCull(block, inSingle, limits); },
      [&](std::uint32_t sceneLeaf, std::uint32_t partLeaf) {
        tests.test(sceneLeaf, partLeaf);
        return true;
      });
  result.leafPairs = tests.count();
  result.completeTo = tests.completeTo();
  if (result.completeTo < cutoff) result.status = QueryStatus::Truncated;
  collector.finish(*scene_, *part_, out);
  return result;
}

CandidateList::Way CandidateList::wayBetween(const RigidTransform& from,
                                             const RigidTransform& to) const noexcept {
  const RigidTransform a = centredPose(*scene_, *part_, from), b = centredPose(*scene_, *part_, to);
  const bool isOfOnePose = a == b;
  if (isOfOnePose) return {a, {}, true};
  const glm::dvec3 spin = 0.5 * rotationVector(b.rotation * glm::conjugate(a.rotation));
  return {{glm::normalize(rotationOf(spin) * a.rotation), 0.5 * (a.translation + b.translation)},
          {0.5 * (b.translation - a.translation), spin},
          false};
}

std::optional<MotionBudget> CandidateList::roomAlong(const Way& way) const noexcept {
  if (!(spentAt(way.middle) <= 1.0)) return std::nullopt;
  MotionBudget aside = asideOf(way.middle), lost;
  if (!way.isOfOnePose) {
    for (const double time : {-1.0, 1.0}) {
      const RigidTransform end = poseOn(way.stretch, way.middle, time);
      if (!(spentAt(end) <= 1.0)) return std::nullopt;
      const MotionBudget there = asideOf(end);
      aside = {std::max(aside.travel, there.travel), std::max(aside.turn, there.turn)};
    }
    // Turns about different axes do not add up: between the ends the way may be farther aside by their product. Turns
    // about one axis do, however large they are.
    const glm::dvec3 &onWay = way.stretch.spin, &onList = range_.stretch.spin;
    const double spin = glm::length(onWay), listed = glm::length(onList);
    const glm::dvec3 across = spin > 0.0 ? onList - glm::dot(onList, onWay) / (spin * spin) * onWay : onList;
    lost.turn =
        std::min(spin * (spin + listed + aside.turn), (spin + listed) * (glm::length(across) + aside.turn));
    lost.travel = 0.5 * part_->size() * lost.turn;
  }
  return MotionBudget{std::max(0.0, range_.budget.travel - aside.travel - lost.travel),
                      std::max(0.0, range_.budget.turn - aside.turn - lost.turn)};
}

std::optional<CandidateList::Way> CandidateList::wayFor(const RigidTransform& from, const RigidTransform& to,
                                                        const ContactReach& reach) const noexcept {
  if (!isUsable_ || !(reach.distance <= cutoff_) || !(reach.turn <= relaxation_) || !from.isFinite() ||
      !to.isFinite())
    return std::nullopt;
  return wayBetween(from, to);
}

std::optional<MotionBudget> CandidateList::roomAlong(const RigidTransform& from, const RigidTransform& to,
                                                     const ContactReach& reach) const noexcept {
  const std::optional<Way> way = wayFor(from, to, reach);
  return way ? roomAlong(*way) : std::nullopt;
}

std::optional<NearbyPairs> CandidateList::nearbyPairsAlong(const RigidTransform& from,
                                                           const RigidTransform& to,
                                                           const ContactReach& reach,
                                                           const MotionBudget& slack, LmdScratch& scratch,
                                                           std::span<LeafPair> out,
                                                           std::uint64_t maxWork) const noexcept {
  const std::optional<Way> way = wayFor(from, to, reach);
  const std::optional<MotionBudget> room = way ? roomAlong(*way) : std::nullopt;
  if (!room) return std::nullopt;
  NearbyPairs result;
  result.holds = {std::min(room->travel, slack.travel), std::min(room->turn, slack.turn)};
  result.isComplete = true;
  const BodyPairQuery within{*scene_, *part_, from, reach.distance};
  if (!isQueryValid(*scene_, *part_, from, reach.distance)) return result;
  // Pairs that matter only farther from the middle do not matter at the pose itself.
  const bool isForPose = way->isOfOnePose && !(slack.travel > 0.0) && !(slack.turn > 0.0);
  const std::size_t count = isForPose ? countFor(spentAt(way->middle)) : size();
  if (count == 0) return result;
  result.isComplete = blocksOf(count) <= maxWork;
  if (!result.isComplete) return result;
  const std::span<LeafPair> places = out.first(
      static_cast<std::size_t>(std::min<std::uint64_t>(out.size(), listable(maxWork - blocksOf(count)))));
  const auto take = [&](std::uint32_t sceneLeaf, std::uint32_t partLeaf) {
    result.isComplete = result.count < places.size();
    if (result.isComplete) places[result.count++] = {sceneLeaf, partLeaf};
    return result.isComplete;
  };
  const LmdScratch::Data& workspace = scratch.data();
  const SinglePose pose(way->middle);
  const RangeLimits limits =
      rangeLimits(within, way->middle, relaxed({way->stretch, result.holds}, reach.distance, reach.turn));
  result.work = visitPairs(
      count,
      [&](const BoundPairs& block) {
        return way->isOfOnePose ? workspace.pairCull(block, pose, limits.still)
                                : workspace.sweptPairCull(block, pose, limits.still, limits.inScene);
      },
      take);
  result.work += blocksOf(result.count);
  return result;
}

bool isClearWithin(const BodyPairQuery& query, const MotionBudget& budget, LmdScratch& scratch,
                   std::uint64_t maxNodePairs) noexcept {
  if (!isQueryValid(query.scene, query.part, query.sceneFromPart, query.cutoff)) return true;
  const RigidTransform pose = centredPose(query.scene, query.part, query.sceneFromPart);
  LmdScratch::Data& workspace = scratch.data();
  const CullLimits limits = rangeLimits(query, pose, {{}, budget}).still;
  TreeTraversal traversal(query.scene, query.part, pose, limits, workspace.open, workspace.traversal);
  bool isClear = true;
  return traversal.run([&](const EntryPair&) { isClear = false; }, maxNodePairs) && isClear;
}

}  // namespace nearfit
