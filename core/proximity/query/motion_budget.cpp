#include "core/proximity/query/motion_budget.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"

namespace nearfit {
namespace {

/// Budgets may be used to this fraction only, so that rounding of the motion does not overdraw them.
constexpr double kBudgetUse = 1.0 - 1e-9;

}  // namespace

MotionBudget motionBetween(const RigidTransform& from, const RigidTransform& to, double radius) noexcept {
  const glm::dquat turn = glm::conjugate(from.rotation) * to.rotation;
  const double sine = glm::length(glm::dvec3(turn.x, turn.y, turn.z));
  const double angle = 2.0 * std::atan2(sine, std::abs(turn.w));
  // The displacement of a point at the radius is a chord.
  return {glm::distance(from.translation, to.translation) + 2.0 * std::min(sine, 1.0) * radius, angle};
}

double spentShare(const MotionBudget& motion, const MotionBudget& budget) noexcept {
  const auto share = [](double used, double available) {
    return available > 0.0 ? used / (kBudgetUse * available)
           : used > 0.0    ? std::numeric_limits<double>::infinity()
                           : 0.0;
  };
  return std::max(share(motion.travel, budget.travel), share(motion.turn, budget.turn));
}

MotionBudget operator*(double factor, const MotionBudget& budget) noexcept {
  return {factor * budget.travel, factor * budget.turn};
}

RigidTransform poseOn(const MotionStretch& stretch, const RigidTransform& middle, double time) noexcept {
  return {glm::normalize(rotationOf(time * stretch.spin) * middle.rotation),
          middle.translation + time * stretch.shift};
}

double timeAlong(const MotionStretch& stretch, const RigidTransform& middle, const RigidTransform& pose,
                 double radius) noexcept {
  const double length =
      glm::dot(stretch.shift, stretch.shift) + radius * radius * glm::dot(stretch.spin, stretch.spin);
  if (!(length > 0.0)) return 0.0;
  const glm::dvec3 turn = rotationVector(pose.rotation * glm::conjugate(middle.rotation));
  const double along = glm::dot(stretch.shift, pose.translation - middle.translation) +
                       radius * radius * glm::dot(stretch.spin, turn);
  return along / length;
}

double nearestTime(const MotionStretch& stretch, const RigidTransform& middle, const RigidTransform& pose,
                   double radius) noexcept {
  return std::clamp(timeAlong(stretch, middle, pose, radius), -1.0, 1.0);
}

MotionRange operator*(double factor, const MotionRange& range) noexcept {
  return {{factor * range.stretch.shift, factor * range.stretch.spin}, factor * range.budget};
}

MotionRange turned(const glm::dquat& turn, const MotionRange& range) noexcept {
  return {{turn * range.stretch.shift, turn * range.stretch.spin}, range.budget};
}

double spentShare(const MotionRange& range, const RigidTransform& middle, const RigidTransform& pose,
                  double radius) noexcept {
  const double time = nearestTime(range.stretch, middle, pose, radius);
  const MotionBudget aside = motionBetween(poseOn(range.stretch, middle, time), pose, radius);
  return std::max(std::abs(time), spentShare(aside, range.budget));
}

}  // namespace nearfit
