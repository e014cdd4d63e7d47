#include "core/scene/joint.h"

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace nearfit {

const char* wordOf(JointKind kind) noexcept {
  switch (kind) {
    case JointKind::OnAxis:
      return "axis";
    case JointKind::InPlane:
      return "plane";
    case JointKind::ToPoint:
      break;
  }
  return "point";
}

std::optional<JointKind> jointKindOf(std::string_view word) noexcept {
  for (const JointKind kind : {JointKind::OnAxis, JointKind::InPlane, JointKind::ToPoint}) {
    if (word == wordOf(kind)) return kind;
  }
  return std::nullopt;
}

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
    feature->direction =
        joint.kind == JointKind::ToPoint ? JointFeature().direction : checkedDirection(feature->direction);
  }
  return checked;
}

}  // namespace nearfit
