#include "core/proximity/query/range_limits.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/query_workspace.h"

namespace nearfit {
namespace {

constexpr float kUp = 1.0F + 1e-6F;  // Sums and conversions below round by less.

std::array<float, 3> single(const glm::dvec3& v) noexcept {
  return {kUp * static_cast<float>(v.x), kUp * static_cast<float>(v.y), kUp * static_cast<float>(v.z)};
}

}  // namespace

RangeLimits rangeLimits(const BodyPairQuery& query, const RigidTransform& centred,
                        const MotionRange& range) noexcept {
  const double radius = 0.5 * query.part.size();
  const double spin = glm::length(range.stretch.spin), shift = glm::length(range.stretch.shift);
  const double travel = range.budget.travel + shift + spin * radius;
  // No two points get farther apart than this; a cutoff beyond it would be infinite in single precision.
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

MotionRange relaxed(MotionRange range, double cutoff, double relaxation) noexcept {
  range.budget.travel += relaxation * cutoff;
  // Twice, for the limits of both bodies; the relaxed conditions compare sines.
  range.budget.turn += 2.0 * std::asin(std::min(relaxation, 1.0));
  return range;
}

CullLimits contactLimits(const BodyPairQuery& query, const RigidTransform& centred, double relaxation,
                         const MotionBudget& slack) noexcept {
  return rangeLimits(query, centred, relaxed({{}, slack}, query.cutoff, relaxation)).still;
}

}  // namespace nearfit
