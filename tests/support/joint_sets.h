#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/scene/joint_set.h"
#include "tests/support/random_values.h"

namespace nearfit::test {

/// A joint that keeps a part where it is at a pose: its feature there, in the world.
inline JointSet::Placed keptAt(JointKind kind, const RigidTransform& worldFromPart, const glm::dvec3& point,
                               const glm::dvec3& direction = {0.0, 0.0, 1.0}) {
  const RigidTransform partFromWorld = worldFromPart.inverse();
  return {kind,
          {partFromWorld.applyToPoint(point), glm::normalize(partFromWorld.applyToVector(direction))},
          point,
          glm::normalize(direction)};
}

inline JointSet jointSetOf(std::initializer_list<JointSet::Placed> joints,
                           const RigidTransform& worldFromPart) {
  return {std::vector<JointSet::Placed>(joints), worldFromPart};
}

/// Half the squared length of a motion in the metric of mass at `pose`, by the definition.
inline double energyOf(const RigidTransform& pose, const RigidTransform& wanted,
                       const glm::dvec3& centreInPart, const MassMetric& metric) {
  const glm::dvec3 shift = wanted.applyToPoint(centreInPart) - pose.applyToPoint(centreInPart);
  const glm::dmat3 turn = glm::mat3_cast(wanted.rotation) * glm::transpose(glm::mat3_cast(pose.rotation));
  const double cosine = std::clamp(0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1.0), -1.0, 1.0);
  const double angle = std::acos(cosine);
  glm::dvec3 axis(turn[1][2] - turn[2][1], turn[2][0] - turn[0][2], turn[0][1] - turn[1][0]);
  axis = glm::length(axis) > 0.0 ? glm::normalize(axis) : glm::dvec3(0.0);
  const glm::dmat3 partFromWorld = glm::transpose(glm::mat3_cast(pose.rotation * metric.partFromPrincipal));
  const glm::dvec3 weighed = metric.gyration * (partFromWorld * (angle * axis));
  return 0.5 * (glm::dot(shift, shift) + glm::dot(weighed, weighed));
}

}  // namespace nearfit::test
