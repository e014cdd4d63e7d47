#include "core/report/lmd_set.h"

#include <algorithm>
#include <chrono>

#include "core/proximity/blocked_minima.h"

namespace nearfit {
namespace {

/// Work space beyond the limit on minima: a flat region is found in pieces.
constexpr std::size_t kHeadroom = 4;

}  // namespace

LmdSet LmdCollector::collect(const NormalConeTree& scene, const NormalConeTree& part,
                             const RigidTransform& sceneFromPart, double cutoff) {
  LmdSet set;
  for (;;) {
    set.lmds.resize(std::min(capacity_, limit_));
    const auto start = std::chrono::steady_clock::now();
    const LmdResult result = findLmds(scene, part, sceneFromPart, cutoff, scratch_, set.lmds);
    set.queryTime = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    set.isComplete = result.status == QueryStatus::Complete;
    if (set.isComplete || capacity_ / kHeadroom >= limit_) {
      set.lmds.resize(result.count);
      // The pose may be any: where bodies interpenetrate nothing is known of the least distance.
      markBlocked(scene, part, sceneFromPart, set.lmds, 0.0, scratch_);
      return set;
    }
    capacity_ *= 4;
    scratch_ = LmdScratch(capacity_);
  }
}

const char* nameOf(FeatureKind kind) noexcept {
  switch (kind) {
    case FeatureKind::Vertex:
      return "vertex";
    case FeatureKind::Edge:
      return "edge";
    case FeatureKind::Face:
      break;
  }
  return "face";
}

const char* nameOf(MassBasis basis) noexcept {
  return basis == MassBasis::VolumeIntegrals ? "volume integrals" : "oriented box";
}

}  // namespace nearfit
