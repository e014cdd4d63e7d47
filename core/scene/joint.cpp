#include "core/scene/joint.h"

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace nearfit {

glm::dvec3 checkedDirection(const glm::dvec3& direction) {
  const double length = glm::length(direction);
  if (!(std::abs(length - 1.0) <= kDirectionSlack))
    throw UsageError("direction", fmt::format("its length is {}, not 1", length), "give a unit vector");
  // Keep a direction that is unit up to rounding, so that saving and loading changes no digit.
  return std::abs(length - 1.0) <= 1e-15 ? direction : direction / length;
}

Joint checkedJoint(const Joint& joint) {
  Joint checked = joint;
  for (JointFeature* feature : {&checked.onPart, &checked.onBase}) {
    checkPosition(feature->point);
    feature->direction = joint.kind == JointKind::ToPoint ? JointFeature().direction
                                                          : checkedDirection(feature->direction);
  }
  return checked;
}

}  // namespace nearfit
