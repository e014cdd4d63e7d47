#include "core/proximity/candidate_list.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/proximity/leaf_tests.h"
#include "core/proximity/query_workspace.h"

namespace nearfit {
namespace {

constexpr std::size_t kWidth = NormalConeTree::kWidth;

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

constexpr float kUp = 1.0F + 1e-6F;  // Sums and conversions below round by less.

std::array<float, 3> single(const glm::dvec3& v) noexcept {
  return {kUp * static_cast<float>(v.x), kUp * static_cast<float>(v.y), kUp * static_cast<float>(v.z)};
}

/// Limits that hold at every pose of a range.
///
/// A pair that carries a minimum at a pose X is within the cutoff there. X is within the budget of a pose P
/// on the stretch. Seen from the scene, a point q of the part goes from where it is in the middle to P by t
/// (shift + spin x (q - o)), o the part's centre, but for the curvature of its arc, |spin|^2 |q - o| / 2;
/// seen from the part, a point a of the scene by the opposite with a for q, but for an arc about o as well
/// and for the shift's turning, |spin| |shift|. From P to X it is the budget's travel, and seen from the part
/// its turn times the distance of the two points besides.
RangeLimits rangeLimits(const BodyPairQuery& query, const RigidTransform& centred,
                        const MotionRange& range) noexcept {
  const double radius = 0.5 * query.part.size();
  const double spin = glm::length(range.stretch.spin), shift = glm::length(range.stretch.shift);
  const double travel = range.budget.travel + shift + spin * radius;
  // Nothing gets farther apart than this; beyond it a cutoff would be infinite in single precision.
  const double reach = query.scene.size() + query.part.size() + glm::length(centred.translation) + travel;
  const double within = std::min(query.cutoff, reach);
  const double arc = 0.5 * spin * spin * (radius + within + travel) + spin * shift;
  const double aside = range.budget.travel + range.budget.turn * (within + travel);
  CullLimits limits = cullLimits(query.scene, query.part, centred, query.cutoff);
  limits.cutoff = std::max(limits.cutoff, kUp * static_cast<float>(within));
  limits.padding = kUp * (limits.padding + static_cast<float>(aside + arc));
  limits.turn = kUp * (limits.turn + static_cast<float>(spin + range.budget.turn));
  const MotionRange inPart = turned(glm::conjugate(centred.rotation), range);
  const auto spinLength = kUp * static_cast<float>(spin);
  return {limits,
          {single(range.stretch.shift), single(range.stretch.spin), single(centred.translation), spinLength},
          {single(inPart.stretch.shift), single(inPart.stretch.spin), {0.0F, 0.0F, 0.0F}, spinLength}};
}

/// A contact's direction is off the limits by the relaxation at most, and its points off their features by as
/// much of the distance.
MotionRange relaxed(MotionRange range, double cutoff, double relaxation) noexcept {
  range.budget.travel += relaxation * cutoff;
  range.budget.turn += relaxation;
  return range;
}

}  // namespace

RangeLimits CandidateList::limitsWithin(double share) const noexcept {
  return rangeLimits({*scene_, *part_, {}, cutoff_}, pose_, relaxed(share * range_, cutoff_, relaxation_));
}

void CandidateList::build(const BodyPairQuery& query, const MotionRange& range, LmdScratch& scratch,
                          const Bounds& bounds, double relaxation) {
  scene_ = &query.scene;
  part_ = &query.part;
  cutoff_ = query.cutoff;
  relaxation_ = relaxation;
  range_ = range;
  isUsable_ = true;
  found_.clear();
  levelEnds_.fill(0);
  if (!isQueryValid(query.scene, query.part, query.sceneFromPart, query.cutoff)) return;
  pose_ = centredPose(query.scene, query.part, query.sceneFromPart);
  LmdScratch::Data& workspace = scratch.data();
  const RangeLimits limits = limitsWithin(1.0);
  TreeTraversal traversal(*scene_, *part_, pose_, limits.still, workspace.openSwept, workspace.traversal);
  traversal.setSweep(limits.inScene, limits.inPart);
  isUsable_ = traversal.run(
      [&](const EntryPair& pair) {
        if (relaxation_ > 0.0 && !spansContact(pair.scene, pair.part)) return;
        if (found_.size() <= bounds.pairs)
          found_.push_back({pair.sceneLane, pair.partLane, kLevels.size() - 1});
      },
      bounds.nodePairs);
  isUsable_ = isUsable_ && found_.size() <= bounds.pairs;
  if (!isUsable_) {
    found_.clear();
    return;
  }
  findLevels(workspace);
  pack();
}

void CandidateList::findLevels(const LmdScratch::Data& workspace) noexcept {
  const SinglePose pose(pose_);
  std::array<RangeLimits, kLevels.size()> limits;
  for (std::size_t level = 0; level < kLevels.size(); ++level)
    limits[level] = limitsWithin(kLevels[level]);
  BoundPairs block;
  for (std::size_t base = 0; base < found_.size(); base += kWidth) {
    const std::size_t count = std::min(kWidth, found_.size() - base);
    // Lanes that are left over repeat the first.
    for (std::size_t i = 0; i < kWidth; ++i)
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
  blocks_.resize(std::max(blocks_.size(), (found_.size() + kWidth - 1) / kWidth));
  for (const LanePair& pair : found_) {
    const std::size_t at = next[pair.level]++;
    copyPair(pair, blocks_[at / kWidth], at % kWidth);
  }
  // Lanes of the last block that are left over repeat its first: never counted, never far from its data.
  for (std::size_t i = found_.size(); i % kWidth != 0; ++i) {
    BoundPairs& block = blocks_[i / kWidth];
    copyLane(block.scene, 0, block.scene, i % kWidth);
    copyLane(block.part, 0, block.part, i % kWidth);
  }
}

void CandidateList::copyPair(const LanePair& pair, BoundPairs& block, std::size_t at) const noexcept {
  copyLane(scene_->nodes()[pair.sceneLane / kWidth], pair.sceneLane % kWidth, block.scene, at);
  copyLane(part_->nodes()[pair.partLane / kWidth], pair.partLane % kWidth, block.part, at);
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

template <class Visit>
void CandidateList::visitPairs(const RigidTransform& centred, std::size_t count, const CullLimits& limits,
                               LmdScratch& scratch, Visit&& visit) const noexcept {
  const SinglePose inSingle(centred);
  for (std::size_t base = 0; base < count; base += kWidth) {
    const BoundPairs& block = blocks_[base / kWidth];
    std::uint32_t lanes = scratch.data().pairCull(block, inSingle, limits);
    if (count - base < kWidth) lanes &= (1U << (count - base)) - 1U;
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
      visit(block.scene.child[lane], block.part.child[lane]);
    }
  }
}

std::optional<LmdResult> CandidateList::query(const RigidTransform& sceneFromPart, double cutoff,
                                              LmdScratch& scratch, std::span<Lmd> out) const noexcept {
  const std::optional<CoveredPose> pose = covered(sceneFromPart, cutoff);
  if (!pose) return std::nullopt;
  LmdResult result;
  result.completeTo = cutoff;
  if (pose->count == 0) return result;
  const LeafTests tests(*scene_, *part_, pose->centred, cutoff);
  MinimaCollector collector(scratch.data(), result);
  visitPairs(pose->centred, pose->count, cullLimits(*scene_, *part_, pose->centred, cutoff), scratch,
             [&](std::uint32_t sceneLeaf, std::uint32_t partLeaf) {
               ++result.leafPairs;
               if (tests.test(sceneLeaf, partLeaf, collector.slot())) collector.add();
             });
  collector.finish(*scene_, *part_, out);
  return result;
}

std::optional<NearbyPairs> CandidateList::nearbyPairs(const RigidTransform& sceneFromPart,
                                                      const ContactReach& reach, const MotionBudget& slack,
                                                      LmdScratch& scratch,
                                                      std::span<LeafPair> out) const noexcept {
  if (!(reach.turn <= relaxation_)) return std::nullopt;
  const std::optional<CoveredPose> pose = covered(sceneFromPart, reach.distance);
  if (!pose) return std::nullopt;
  NearbyPairs result;
  // Wherever on the stretch the pose is, what is left aside is left.
  const MotionBudget aside = asideOf(pose->centred);
  result.holds = {std::clamp(range_.budget.travel - aside.travel, 0.0, slack.travel),
                  std::clamp(range_.budget.turn - aside.turn, 0.0, slack.turn)};
  result.isComplete = true;
  result.work = size() / kWidth;
  if (pose->count == 0 && size() == 0) return result;
  const BodyPairQuery within{*scene_, *part_, sceneFromPart, reach.distance};
  visitPairs(pose->centred, size(), contactLimits(within, pose->centred, reach.turn, result.holds), scratch,
             [&](std::uint32_t sceneLeaf, std::uint32_t partLeaf) {
               if (result.count < out.size())
                 out[result.count++] = {sceneLeaf, partLeaf};
               else
                 result.isComplete = false;
             });
  return result;
}

CullLimits contactLimits(const BodyPairQuery& query, const RigidTransform& centred, double relaxation,
                         const MotionBudget& slack) noexcept {
  return rangeLimits(query, centred, relaxed({{}, slack}, query.cutoff, relaxation)).still;
}

ContactPair contactOf(const Minimum& minimum, const NormalConeTree& scene) noexcept {
  const Lmd& lmd = minimum.lmd;
  return {lmd.partPoint + scene.centre(), lmd.direction, std::min(minimum.least, lmd.distance)};
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
