#include "core/placing/align.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/math/least_turn.h"

namespace nearfit {
namespace {

const glm::dquat kNoTurn(1.0, 0.0, 0.0, 0.0);

bool hasPlane(FeatureShape shape) noexcept {
  return shape == FeatureShape::Plane || shape == FeatureShape::Circle;
}

glm::dquat turnOf(const AlignFeature& moving, const AlignFeature& fixed, bool isFlipped) {
  if (!canBeFlipped(moving.shape, fixed.shape)) return kNoTurn;
  glm::dvec3 target = fixed.direction;
  // Planes face each other; axes take the shorter way round.
  const bool areFlat = moving.shape == FeatureShape::Plane && fixed.shape == FeatureShape::Plane;
  if (areFlat || glm::dot(moving.direction, target) < 0.0) target = -target;
  return leastTurn(moving.direction, isFlipped ? -target : target);
}

glm::dvec3 along(const glm::dvec3& v, const glm::dvec3& direction) {
  return glm::dot(v, direction) * direction;
}

/// @param moving  After its rotation.
glm::dvec3 shiftOf(const AlignFeature& moving, const AlignFeature& fixed, double offset) {
  const glm::dvec3 between = fixed.point - moving.point;
  const FeatureShape m = moving.shape, f = fixed.shape;
  if (f == FeatureShape::Plane) {
    // An axis perpendicular to a plane may be anywhere.
    if (m == FeatureShape::Axis) return glm::dvec3(0.0);
    return along(between, fixed.direction) + offset * fixed.direction;
  }
  if (m == FeatureShape::Plane) {
    if (f == FeatureShape::Axis) return glm::dvec3(0.0);
    return along(between, moving.direction) - offset * moving.direction;
  }
  if (f == FeatureShape::Axis) return between - along(between, fixed.direction);
  if (m == FeatureShape::Axis) return between - along(between, moving.direction);
  return between;
}

}  // namespace

bool canBeOffset(FeatureShape moving, FeatureShape fixed) noexcept {
  if (fixed == FeatureShape::Plane) return moving != FeatureShape::Axis;
  return moving == FeatureShape::Plane && (hasPlane(fixed) || fixed == FeatureShape::Point);
}

bool canBeFlipped(FeatureShape moving, FeatureShape fixed) noexcept {
  return moving != FeatureShape::Point && fixed != FeatureShape::Point;
}

RigidTransform alignMotion(const AlignFeature& moving, const AlignFeature& fixed,
                           const AlignOptions& options) {
  const glm::dquat turn = turnOf(moving, fixed, options.isFlipped);
  AlignFeature turned = moving;
  turned.direction = turn * moving.direction;
  const double offset = canBeOffset(moving.shape, fixed.shape) ? options.offset : 0.0;
  const glm::dvec3 shift = shiftOf(turned, fixed, offset);
  // The feature's point stays in place while the part turns.
  return {turn, moving.point - turn * moving.point + shift};
}

}  // namespace nearfit
