#include "core/proximity/tracking/lmd_set.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>

#include "core/proximity/query/blocked_minima.h"
#include "core/proximity/query/contact_areas.h"

namespace nearfit {
namespace {

/// Work space relative to the limit on minima: a flat region is found in several pieces.
constexpr std::size_t kHeadroom = 4;

/// Largest distance from the origin of a mesh in its own frame, or of the pose between them [m].
double fromOriginOf(const BodyPairQuery& query) noexcept {
  return std::max({glm::length(query.scene.centre()), glm::length(query.part.centre()),
                   glm::length(query.sceneFromPart.translation)});
}

}  // namespace

void markFarRegions(std::vector<Lmd>& lmds, double fromOrigin, double size) noexcept {
  if (!(fromOrigin > kMaxExtentOrigin * size)) return;
  for (Lmd& lmd : lmds)
    lmd.isMarginal = lmd.isMarginal || lmd.isRegion;
}

template <class Find>
LmdSet LmdCollector::grow(const BodyPairQuery& query, Find&& find) {
  LmdSet set;
  for (;;) {
    found_.resize(std::min(capacity_, limit_));
    const auto start = std::chrono::steady_clock::now();
    const LmdResult result = find(scratch_, std::span(found_));
    set.queryTime = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    set.isComplete = result.status == QueryStatus::Complete;
    if (set.isComplete || capacity_ / kHeadroom >= limit_) {
      set.lmds.assign(found_.begin(), found_.begin() + static_cast<std::ptrdiff_t>(result.count));
      // The bodies may interpenetrate, so there is no lower bound on the min distance.
      markBlocked(query.scene, query.part, query.sceneFromPart, set.lmds, 0.0, scratch_);
      markFarRegions(set.lmds, fromOriginOf(query), query.scene.size() + query.part.size());
      return set;
    }
    capacity_ *= 4;
    scratch_ = LmdScratch(capacity_);
  }
}

LmdSet LmdCollector::collect(const NormalConeTree& scene, const NormalConeTree& part,
                             const RigidTransform& sceneFromPart, double cutoff) {
  return grow({scene, part, sceneFromPart, cutoff}, [&](LmdScratch& scratch, std::span<Lmd> out) {
    return findLmds(scene, part, sceneFromPart, cutoff, scratch, out);
  });
}

LmdSet LmdCollector::collectTracked(const NormalConeTree& scene, const NormalConeTree& part,
                                    const RigidTransform& sceneFromPart, double cutoff) {
  if (!followed_ || followed_->scene_ != &scene || followed_->part_ != &part) followed_.emplace(scene, part);
  return collectTracked(*followed_, sceneFromPart, cutoff);
}

LmdSet LmdCollector::collectTracked(FollowedPair& pair, const RigidTransform& sceneFromPart, double cutoff) {
  const NormalConeTree &scene = *pair.scene_, &part = *pair.part_;
  pair.tracker_.observe(sceneFromPart, 1.0);
  if (pair.tracker_.isDue(pair.list_, cutoff)) pair.tracker_.refresh(pair.list_, cutoff, scratch_);
  return grow({scene, part, sceneFromPart, cutoff}, [&](LmdScratch& scratch, std::span<Lmd> out) {
    const std::optional<LmdResult> listed = pair.list_.query(sceneFromPart, cutoff, scratch, out);
    return listed ? *listed : findLmds(scene, part, sceneFromPart, cutoff, scratch, out);
  });
}

void LmdCollector::mergeByArea(const NormalConeTree& scene, const NormalConeTree& part,
                               const RigidTransform& sceneFromPart, double cutoff, LmdSet& set) {
  set.areas = mergeAreas(scene, part, sceneFromPart, cutoff, set.lmds, scratch_,
                         std::numeric_limits<std::uint64_t>::max())
                  .areas;
}

}  // namespace nearfit
