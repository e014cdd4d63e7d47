#include "core/proximity/candidate_list.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "core/proximity/leaf_tests.h"
#include "core/proximity/query_workspace.h"

namespace nearfit {
namespace {

constexpr std::size_t kWidth = NormalConeTree::kWidth;

/// Budgets are spent to this fraction only, so that rounding of the motion does not overdraw them.
constexpr double kBudgetUse = 1.0 - 1e-9;

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

}  // namespace

MotionBudget motionBetween(const RigidTransform& from, const RigidTransform& to, double radius) noexcept {
  const glm::dquat turn = glm::conjugate(from.rotation) * to.rotation;
  const double sine = glm::length(glm::dvec3(turn.x, turn.y, turn.z));
  const double angle = 2.0 * std::atan2(sine, std::abs(turn.w));
  // A point at the radius moves along a chord.
  return {glm::distance(from.translation, to.translation) + 2.0 * std::min(sine, 1.0) * radius, angle};
}

CandidateList::CandidateList(std::size_t capacity) : blocks_((capacity + kWidth - 1) / kWidth) {}

void CandidateList::build(const NormalConeTree& scene, const NormalConeTree& part,
                          const RigidTransform& sceneFromPart, double cutoff, const MotionBudget& budget,
                          LmdScratch& scratch) noexcept {
  scene_ = &scene;
  part_ = &part;
  cutoff_ = cutoff;
  budget_ = budget;
  count_ = 0;
  isUsable_ = true;
  pose_ = centredPose(scene, part, sceneFromPart);
  if (!isQueryValid(scene, part, sceneFromPart, cutoff)) return;
  CullLimits limits = cullLimits(scene, part, pose_, cutoff);
  // Seen from the part, the scene's points move by as much and d turns besides.
  limits.padding += static_cast<float>(budget.travel + budget.turn * (cutoff + budget.travel));
  limits.turn += static_cast<float>(budget.turn);
  limits.padding *= 1.0F + 1e-6F;
  limits.turn *= 1.0F + 1e-6F;
  TreeTraversal traversal(scene, part, pose_, limits, scratch.data().open, scratch.data().traversal);
  traversal.run([this](const EntryPair& pair) {
    if (count_ == blocks_.size() * kWidth) {
      isUsable_ = false;
    } else {
      addPair(pair.sceneLane, pair.partLane);
    }
  });
  // Lanes of the last block that are left over repeat its first: never counted, never far from its data.
  for (std::size_t i = count_; i % kWidth != 0; ++i) {
    BoundPairs& block = blocks_[i / kWidth];
    copyLane(block.scene, 0, block.scene, i % kWidth);
    copyLane(block.part, 0, block.part, i % kWidth);
  }
}

void CandidateList::addPair(std::uint32_t sceneLane, std::uint32_t partLane) noexcept {
  BoundPairs& block = blocks_[count_ / kWidth];
  copyLane(scene_->nodes()[sceneLane / kWidth], sceneLane % kWidth, block.scene, count_ % kWidth);
  copyLane(part_->nodes()[partLane / kWidth], partLane % kWidth, block.part, count_ % kWidth);
  ++count_;
}

double CandidateList::spent(const RigidTransform& sceneFromPart) const noexcept {
  const double never = std::numeric_limits<double>::infinity();
  if (!isUsable_ || !sceneFromPart.isFinite()) return never;
  const MotionBudget motion =
      motionBetween(pose_, centredPose(*scene_, *part_, sceneFromPart), 0.5 * part_->size());
  const auto share = [&](double used, double available) {
    return available > 0.0 ? used / (kBudgetUse * available) : used > 0.0 ? never : 0.0;
  };
  return std::max(share(motion.travel, budget_.travel), share(motion.turn, budget_.turn));
}

bool CandidateList::covers(const RigidTransform& sceneFromPart, double cutoff) const noexcept {
  return isUsable_ && cutoff <= cutoff_ && spent(sceneFromPart) <= 1.0;
}

LmdResult CandidateList::query(const RigidTransform& sceneFromPart, double cutoff, LmdScratch& scratch,
                               std::span<Lmd> out) const noexcept {
  LmdResult result;
  if (count_ == 0 || !isQueryValid(*scene_, *part_, sceneFromPart, cutoff)) return result;
  const RigidTransform pose = centredPose(*scene_, *part_, sceneFromPart);
  const CullLimits limits = cullLimits(*scene_, *part_, pose, cutoff);
  const SinglePose single(pose);
  const LeafTests tests(*scene_, *part_, pose, cutoff);
  LmdScratch::Data& workspace = scratch.data();
  MinimaCollector collector(workspace, result);
  for (std::size_t base = 0; base < count_; base += kWidth) {
    const BoundPairs& block = blocks_[base / kWidth];
    std::uint32_t lanes = workspace.pairCull(block, single, limits);
    if (count_ - base < kWidth) lanes &= (1U << (count_ - base)) - 1U;
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
      ++result.leafPairs;
      if (tests.test(block.scene.child[lane], block.part.child[lane], collector.slot())) collector.add();
    }
  }
  collector.finish(*scene_, *part_, out);
  return result;
}

}  // namespace nearfit
