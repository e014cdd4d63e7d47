#include "core/proximity/query/pair_passage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/math/tolerances.h"
#include "core/proximity/query/feature_corners.h"
#include "core/proximity/query/query_workspace.h"

namespace nearfit {
PairPassage::PairPassage(const NormalConeTree& scene, const NormalConeTree& part, const PartWay& way,
                         double enough) noexcept
    : scene_(scene), part_(part), travel_(way.travel), enough_(enough) {
  const RigidTransform from = centredPose(scene, part, way.from), to = centredPose(scene, part, way.to);
  turnFrom_ = glm::mat3_cast(from.rotation);
  turnTo_ = glm::mat3_cast(to.rotation);
  shiftFrom_ = from.translation;
  shiftTo_ = to.translation;
  const double lengths =
      scene.size() + part.size() + std::max(glm::length(shiftFrom_), glm::length(shiftTo_));
  lost_ = way.bend + kSeparationRoundings * kPointRounding * lengths;
}

double PairPassage::leastOf(const LeafPair& pair) const noexcept {
  const FeatureCorners scene = cornersOf(scene_, pair.scene), part = cornersOf(part_, pair.part);
  const FeatureCorners from = placed(part, turnFrom_, shiftFrom_), to = placed(part, turnTo_, shiftTo_);
  // How far the part's feature is beyond the scene's along a direction of any length, at both ends.
  const auto apartAlong = [&](const glm::dvec3& direction) {
    const double length = glm::length(direction);
    if (!(length > 0.0)) return -std::numeric_limits<double>::infinity();
    const glm::dvec3 n = direction / length;
    const FeatureExtent here = extentAlong(n, scene), first = extentAlong(n, from), last = extentAlong(n, to);
    return std::max(std::min(first.low, last.low) - here.high, here.low - std::max(first.high, last.high));
  };
  double least = -std::numeric_limits<double>::infinity();
  const auto tries = [&](const glm::dvec3& direction) {
    least = std::max(least, apartAlong(direction) - lost_);
    return least > enough_;
  };
  if (tries(directionAcross(scene, to))) return least;
  const glm::dvec3 apart = betweenNearest(scene, to);
  if (tries(apart) || tries(betweenNearest(scene, from))) return least;
  // However it goes, the part moves no farther than it travels.
  return std::max(least, glm::length(apart) - travel_ - lost_);
}

double PairPassage::leastOf(std::span<const LeafPair> pairs) const noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (const LeafPair& pair : pairs)
    least = std::min(least, leastOf(pair));
  return least;
}

}  // namespace nearfit
