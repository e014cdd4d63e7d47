#include "core/haptics/minima_finder.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "core/haptics/servo_faults.h"
#include "core/proximity/blocked_minima.h"

namespace nearfit {
namespace {

bool isNearer(const SnapshotLmd& a, const SnapshotLmd& b) noexcept {
  return a.lmd.distance < b.lmd.distance;
}

}  // namespace

MinimaFinder::MinimaFinder() : lmds_(kMaxPerBody), display_(2 * ServoSnapshot::kMaxLmds) {}

void MinimaFinder::begin() noexcept {
  displayCount_ = 0;
  displayWasCut_ = false;
  nodePairsLeft_ = kMaxNodePairs;
  result_ = {};
  result_.distance = result_.completeTo = std::numeric_limits<double>::infinity();
}

LmdResult MinimaFinder::search(const Task& task, const RigidTransform& bodyFromPart, double cutoff) noexcept {
  if (task.list != nullptr) {
    const std::optional<LmdResult> listed = task.list->query(bodyFromPart, cutoff, scratch_, lmds_);
    if (listed) return *listed;
  }
  ++result_.lateBodies;
  const LmdResult result =
      findNearestLmds(task.scene.bodies[task.body].geometry->tree(), task.scene.moving.geometry->tree(),
                      bodyFromPart, cutoff, scratch_, lmds_, nodePairsLeft_);
  nodePairsLeft_ -= std::min(nodePairsLeft_, result.nodePairs);
  return result;
}

std::span<const Lmd> MinimaFinder::findOne(const Task& task, const RigidTransform& worldFromPart,
                                           double cutoff) noexcept {
  const ServoScene::Body& body = task.scene.bodies[task.body];
  const RigidTransform bodyFromPart = (body.worldFromPart.inverse() * worldFromPart).normalized();
  if (!isPose(body.worldFromPart) || !bodyFromPart.isFinite()) {
    result_.isPoseBad = true;
    return {};
  }
  const LmdResult result = search(task, bodyFromPart, cutoff);
  // A minimum is held against what may bar its way, and pieces of regions against each other: as much as
  // several pairs, and an eighth.
  constexpr std::uint64_t kWorkOfMinimum = 16, kPiecesOfWork = 8;
  result_.work += result.nodePairs + result.leafPairs + kWorkOfMinimum * result.count +
                  result.pieces * result.pieces / kPiecesOfWork;
  const std::span<Lmd> found = std::span(lmds_).first(result.count);
  markBlocked(body.geometry->tree(), task.scene.moving.geometry->tree(), bodyFromPart, found, task.apart,
              scratch_);
  for (Lmd& lmd : found) {
    lmd = transformed(lmd, body.worldFromPart);
    result_.distance = std::min(result_.distance, lmd.distance);
  }
  result_.count += static_cast<std::uint32_t>(result.count);
  result_.completeTo = std::min(result_.completeTo, result.completeTo);
  if (result.status == QueryStatus::Truncated) result_.isTruncated = true;
  keepForDisplay(body.id, result.count);
  return found;
}

void MinimaFinder::keepForDisplay(PartId other, std::size_t count) noexcept {
  const std::size_t added = std::min(count, ServoSnapshot::kMaxLmds);
  for (std::size_t i = 0; i < added; ++i)
    display_[displayCount_ + i] = {lmds_[i], other};
  displayCount_ += added;
  if (displayCount_ <= ServoSnapshot::kMaxLmds) return;
  const auto begin = display_.begin();
  std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(ServoSnapshot::kMaxLmds),
                   begin + static_cast<std::ptrdiff_t>(displayCount_), isNearer);
  displayCount_ = ServoSnapshot::kMaxLmds;
  displayWasCut_ = true;
}

void MinimaFinder::write(ServoSnapshot& snapshot) const noexcept {
  const auto kept = std::span(display_).first(displayCount_);
  std::copy(kept.begin(), kept.end(), snapshot.lmds.begin());
  if (displayWasCut_) {
    std::sort(snapshot.lmds.begin(), snapshot.lmds.begin() + static_cast<std::ptrdiff_t>(displayCount_),
              [](const SnapshotLmd& a, const SnapshotLmd& b) {
                return a.other != b.other ? a.other < b.other : isNearer(a, b);
              });
  }
  snapshot.storedLmds = static_cast<std::uint32_t>(displayCount_);
  snapshot.lmdCount = result_.count;
  snapshot.distance = result_.distance;
  snapshot.isTruncated = result_.isTruncated;
}

}  // namespace nearfit
