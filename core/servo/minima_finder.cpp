#include "core/servo/minima_finder.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <optional>

#include "core/proximity/query/blocked_minima.h"
#include "core/servo/servo_faults.h"

namespace nearfit {
namespace {

bool isNearerMinimum(const SnapshotLmd& a, const SnapshotLmd& b) noexcept {
  return a.lmd.distance < b.lmd.distance;
}

}  // namespace

// Several bodies together seldom have more minima than the max of one.
MinimaFinder::MinimaFinder()
    : lmds_(2 * kMaxPerBody), kept_(kMaxKeptBodies), display_(2 * ServoSnapshot::kMaxLmds) {}

MinimaFinder::Question MinimaFinder::questionOf(const TrackedScene& tracked,
                                                const RigidTransform& worldFromPart,
                                                const std::array<double, 2>& lengths,
                                                const MinimaAllowance& allowance) noexcept {
  const glm::dvec3& t = worldFromPart.translation;
  const glm::dquat& r = worldFromPart.rotation;
  Question question{tracked.serial, allowance.search, allowance.merge, allowance.areas};
  std::size_t at = 4;
  for (const double number : {t.x, t.y, t.z, r.w, r.x, r.y, r.z, lengths[0], lengths[1]})
    question[at++] = std::bit_cast<std::uint64_t>(number);
  return question;
}

void MinimaFinder::begin(const Question& question, const MinimaAllowance& allowance) noexcept {
  asked_ = question;
  usedLmds_ = keptCount_ = 0;
  isAnswerKept_ = true;
  displayCount_ = 0;
  displayWasCut_ = false;
  left_ = allowance;
  mergesAreas_ = allowance.areas > 0;
  nodePairsLeft_ = std::min(kMaxNodePairs, allowance.search);
  result_ = {};
  result_.distance = result_.completeTo = std::numeric_limits<double>::infinity();
}

std::span<Lmd> MinimaFinder::roomForOne() noexcept {
  if (usedLmds_ + kMaxPerBody > lmds_.size()) {
    usedLmds_ = 0;
    isAnswerKept_ = false;
  }
  return std::span(lmds_).subspan(usedLmds_, kMaxPerBody);
}

void MinimaFinder::keep(std::span<const Lmd> found) noexcept {
  usedLmds_ += found.size();
  if (keptCount_ < kept_.size()) {
    kept_[keptCount_++] = found;
  } else {
    isAnswerKept_ = false;
  }
}

LmdResult MinimaFinder::search(const Task& task, const RigidTransform& bodyFromPart, double cutoff,
                               std::span<Lmd> out) noexcept {
  if (task.list != nullptr) {
    const std::optional<LmdResult> listed =
        task.list->query(bodyFromPart, cutoff, scratch_, out, left_.search);
    if (listed) return *listed;
  }
  ++result_.lateBodies;
  const LmdResult result =
      findNearestLmds(task.scene.bodies[task.body].geometry->tree(), task.scene.moving.geometry->tree(),
                      bodyFromPart, cutoff, scratch_, out, std::min(nodePairsLeft_, left_.search));
  nodePairsLeft_ -= std::min(nodePairsLeft_, result.nodePairs + result.leafPairs);
  return result;
}

void MinimaFinder::spend(const LmdResult& result) noexcept {
  const std::uint64_t searched = result.nodePairs + kWorkOfLeafTest * result.leafPairs;
  const std::uint64_t merged = mergeWork(result.pieces, result.piecePairs);
  left_.search -= std::min(left_.search, searched);
  left_.merge -= std::min(left_.merge, merged);
  result_.work += searched + merged;
}

std::span<const Lmd> MinimaFinder::findOne(const Task& task, const RigidTransform& worldFromPart,
                                           double cutoff) noexcept {
  const ServoScene::Body& body = task.scene.bodies[task.body];
  const RigidTransform bodyFromPart = (body.worldFromPart.inverse() * worldFromPart).normalized();
  if (!isPose(body.worldFromPart) || !bodyFromPart.isFinite()) {
    result_.isPoseBad = true;
    return {};
  }
  const std::size_t pieces = mergeablePieces(left_.merge);
  if (left_.search == 0 || pieces == 0) {
    result_.isTruncated = true;
    result_.completeTo = 0.0;
    return {};
  }
  scratch_.holdAtMost(pieces);
  const std::span<Lmd> room = roomForOne();
  const LmdResult result = search(task, bodyFromPart, cutoff, room);
  spend(result);
  const std::span<Lmd> found = room.first(result.count);
  markBlocked(body.geometry->tree(), task.scene.moving.geometry->tree(), bodyFromPart, found, task.apart,
              scratch_);
  mergeByArea(task, bodyFromPart, cutoff, found);
  for (Lmd& lmd : found) {
    lmd = transformed(lmd, body.worldFromPart);
    result_.distance = std::min(result_.distance, lmd.distance);
  }
  result_.count += static_cast<std::uint32_t>(result.count);
  result_.completeTo = std::min(result_.completeTo, result.completeTo);
  if (result.status == QueryStatus::Truncated) result_.isTruncated = true;
  keepForDisplay(task, found);
  return found;
}

void MinimaFinder::mergeByArea(const Task& task, const RigidTransform& bodyFromPart, double cutoff,
                               std::span<Lmd> found) noexcept {
  if (!mergesAreas_) {
    result_.areas += static_cast<std::uint32_t>(
        std::ranges::count_if(found, [](const Lmd& lmd) { return !lmd.isBlocked; }));
    return;
  }
  const AreaResult merged =
      mergeAreas(task.scene.bodies[task.body].geometry->tree(), task.scene.moving.geometry->tree(),
                 bodyFromPart, cutoff, found, scratch_, left_.areas);
  left_.areas -= std::min(left_.areas, merged.work);
  result_.areas += merged.areas;
  result_.work += merged.work;
}

void MinimaFinder::keepForDisplay(const Task& task, std::span<const Lmd> found) noexcept {
  const PartId other = task.scene.bodies[task.body].id;
  const std::size_t added = std::min(found.size(), ServoSnapshot::kMaxLmds);
  for (std::size_t i = 0; i < added; ++i)
    display_[displayCount_ + i] = {found[i], other,
                                   task.scene.memberAt(found[i].partFeature, found[i].partIndex)};
  displayCount_ += added;
  if (displayCount_ <= ServoSnapshot::kMaxLmds) return;
  const auto begin = display_.begin();
  std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(ServoSnapshot::kMaxLmds),
                   begin + static_cast<std::ptrdiff_t>(displayCount_), isNearerMinimum);
  displayCount_ = ServoSnapshot::kMaxLmds;
  displayWasCut_ = true;
}

void MinimaFinder::write(ServoSnapshot& snapshot) const noexcept {
  const auto kept = std::span(display_).first(displayCount_);
  std::copy(kept.begin(), kept.end(), snapshot.lmds.begin());
  if (displayWasCut_) {
    std::sort(snapshot.lmds.begin(), snapshot.lmds.begin() + static_cast<std::ptrdiff_t>(displayCount_),
              [](const SnapshotLmd& a, const SnapshotLmd& b) {
                return a.other != b.other ? a.other < b.other : isNearerMinimum(a, b);
              });
  }
  snapshot.storedLmds = static_cast<std::uint32_t>(displayCount_);
  snapshot.lmdCount = result_.count;
  snapshot.distance = result_.distance;
  snapshot.isTruncated = result_.isTruncated;
}

}  // namespace nearfit
