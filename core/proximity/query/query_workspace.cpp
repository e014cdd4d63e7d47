#include "core/proximity/query/query_workspace.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/tolerances.h"
#include "core/proximity/query/merge_minima.h"

namespace nearfit {
namespace {

/// Rounding of the hierarchy, and of the pose in single precision, as a fraction of the lengths involved.
constexpr double kPosePadding = 1e-6;

/// Rounding of projected limits of direction: some thirty roundings of single precision.
constexpr float kDirectionSlack = 4e-6F;

bool isNearerMinimum(const Minimum& a, const Minimum& b) noexcept {
  return a.lmd.distance < b.lmd.distance;
}

}  // namespace

void MinimaCollector::add() noexcept {
  if (count_ < minima_.size()) {
    ++count_;
    return;
  }
  // Full: replaces the farthest.
  if (!isHeap_) std::make_heap(minima_.begin(), minima_.end(), isNearerMinimum);
  isHeap_ = true;
  if (spare_.lmd.distance >= minima_.front().lmd.distance) return;
  std::pop_heap(minima_.begin(), minima_.end(), isNearerMinimum);
  minima_.back() = spare_;
  std::push_heap(minima_.begin(), minima_.end(), isNearerMinimum);
}

void MinimaCollector::finish(const NormalConeTree& scene, const NormalConeTree& part,
                             std::span<Lmd> out) noexcept {
  const MergeResult merged = mergeMinima(minima_.first(count_), workspace_.order, workspace_.merge,
                                         scene.size() + part.size(), std::min(scene.size(), part.size()));
  const std::size_t kept = merged.count;
  result_.pieces = count_;
  result_.piecePairs = merged.pairs;
  result_.count = std::min(kept, out.size());
  if (kept > out.size() || isHeap_) {
    result_.status = QueryStatus::Truncated;
    const double farthest =
        result_.count > 0 ? minima_[workspace_.order[result_.count - 1]].lmd.distance : 0.0;
    result_.completeTo = std::min(result_.completeTo, farthest);
  }
  for (std::size_t i = 0; i < result_.count; ++i) {
    out[i] = minima_[workspace_.order[i]].lmd;
    out[i].scenePoint += scene.centre();
    out[i].partPoint += scene.centre();
  }
}

RigidTransform centredPose(const NormalConeTree& scene, const NormalConeTree& part,
                           const RigidTransform& sceneFromPart) noexcept {
  const RigidTransform pose = sceneFromPart.normalized();
  if (glm::length(pose.translation) + glm::length(part.centre()) + glm::length(scene.centre()) <=
      kNearOrigin * (scene.size() + part.size())) {
    return {pose.rotation, pose.translation + pose.rotation * part.centre() - scene.centre()};
  }
  // Far from the origin, rounding would swallow the small difference of these large numbers.
  using Extended = glm::tvec3<long double>;
  const glm::qua<long double> given(sceneFromPart.rotation);
  const long double length = std::sqrt(glm::dot(given, given));
  const Extended turned =
      length > 0.0L ? (given / length) * Extended(part.centre()) : Extended(part.centre());
  return {pose.rotation, glm::dvec3(Extended(pose.translation) + turned - Extended(scene.centre()))};
}

CullLimits cullLimits(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& centred,
                      double cutoff) noexcept {
  const double reach = scene.size() + part.size() + glm::length(centred.translation);
  // No two points are farther apart than the reach; a cutoff far beyond it would overflow single precision.
  const double within = std::min(cutoff, reach);
  // Features of a region are parallel only to a tolerance, and may meet at any place on them.
  return {static_cast<float>(within * (1.0 + kPosePadding)),
          static_cast<float>(kPosePadding * reach + kFlatTolerance * (within + reach)),
          kDirectionSlack + static_cast<float>(kFlatTolerance)};
}

bool isQueryValid(const NormalConeTree& scene, const NormalConeTree& part,
                  const RigidTransform& sceneFromPart, double cutoff) noexcept {
  // Touching regions report the smallest normal number as their distance; it must be within the cutoff.
  return !scene.isEmpty() && !part.isEmpty() && cutoff > 0.0 && std::isnormal(cutoff) &&
         sceneFromPart.isFinite();
}

}  // namespace nearfit
