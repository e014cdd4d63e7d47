#include "core/scene/joint_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/haptics/virtual_coupling.h"
#include "core/math/axes_across.h"
#include "core/math/least_turn.h"
#include "core/math/rotation_vector.h"

namespace nearfit {
namespace {

using Placed = JointSet::Placed;

glm::dvec3 along(const glm::dvec3& v, const glm::dvec3& direction) noexcept {
  return glm::dot(v, direction) * direction;
}

/// From the part's point to the nearest place that the joint allows it.
glm::dvec3 shiftOnto(const Placed& joint, const glm::dvec3& point) noexcept {
  const glm::dvec3 between = joint.place - point;
  switch (joint.kind) {
    case JointKind::OnAxis:
      return between - along(between, joint.target);
    case JointKind::InPlane:
      return along(between, joint.target);
    case JointKind::ToPoint:
      break;
  }
  return between;
}

/// The point of the part's axis or plane that is nearest to the centre; the point itself for a point. Part's frame.
glm::dvec3 pointNear(const Placed& joint, const glm::dvec3& centreInPart) noexcept {
  const JointFeature& feature = joint.onPart;
  const glm::dvec3 between = centreInPart - feature.point;
  switch (joint.kind) {
    case JointKind::OnAxis:
      return feature.point + along(between, feature.direction);
    case JointKind::InPlane:
      return centreInPart - along(between, feature.direction);
    case JointKind::ToPoint:
      break;
  }
  return feature.point;
}

/// The least rotation that gives the part's direction the one that it should have.
glm::dquat turnOnto(const Placed& joint, const glm::dquat& worldFromPart) noexcept {
  return leastTurn(glm::normalize(worldFromPart * joint.onPart.direction), joint.target);
}

/// The least rotation, then the least translation, that puts the part on one joint.
RigidTransform placedOn(const Placed& joint, const RigidTransform& pose,
                        const glm::dvec3& centreInPart) noexcept {
  const glm::dvec3 inPart = pointNear(joint, centreInPart);
  const glm::dvec3 point = pose.applyToPoint(inPart);
  glm::dquat rotation = pose.rotation;
  // The second turn takes back the rounding of one by nearly half a turn.
  for (int i = 0; joint.kind != JointKind::ToPoint && i < 2; ++i)
    rotation = glm::normalize(turnOnto(joint, rotation) * rotation);
  return {rotation, point + shiftOnto(joint, point) - rotation * inPart};
}

StepVector stepBetween(const RigidTransform& from, const RigidTransform& to, const glm::dvec3& centreInPart,
                       const MassMetric& metric) noexcept {
  const glm::dvec3 shift = to.applyToPoint(centreInPart) - from.applyToPoint(centreInPart);
  const glm::dvec3 turn =
      metric.gyration * (metric.principalFromWorld(from) * turnBetween(from.rotation, to.rotation));
  return {shift.x, shift.y, shift.z, turn.x, turn.y, turn.z};
}

RigidTransform stepped(const RigidTransform& pose, const StepVector& y, double share,
                       const glm::dvec3& centreInPart, const MassMetric& metric) noexcept {
  const glm::dvec3 shift = share * glm::dvec3(y[0], y[1], y[2]);
  const glm::dvec3 turn = share * glm::dvec3(y[3], y[4], y[5]) / metric.gyration;
  const glm::dquat rotation =
      glm::normalize(rotationOf(glm::normalize(metric.worldFromPrincipal(pose)) * turn) * pose.rotation);
  return {rotation, pose.applyToPoint(centreInPart) + shift - rotation * centreInPart};
}

/// Minus the derivative of half the squared length of stepBetween(from, to) by steps of `from`. For turns it is that of
/// 1/2 t . K t, with K turning along: K t + t x K t / 2 + bend t x (t x K t).
StepVector pullBetween(const RigidTransform& from, const RigidTransform& to, const glm::dvec3& centreInPart,
                       const MassMetric& metric) noexcept {
  constexpr double kSmall = 1e-4;
  StepVector pull = stepBetween(from, to, centreInPart, metric);
  const glm::dvec3 turn = glm::dvec3(pull[3], pull[4], pull[5]) / metric.gyration;
  const glm::dvec3 load = metric.gyration * glm::dvec3(pull[3], pull[4], pull[5]);
  const double angle = glm::length(turn);
  // (1 - x cot x) / angle^2 with x = angle / 2, which tends to 1 / 12.
  const double bend =
      angle < kSmall ? 1.0 / 12.0 : (1.0 - 0.5 * angle / std::tan(0.5 * angle)) / (angle * angle);
  const glm::dvec3 across = glm::cross(turn, load);
  const glm::dvec3 torque = (load + 0.5 * across + bend * glm::cross(turn, across)) / metric.gyration;
  pull[3] = torque.x;
  pull[4] = torque.y;
  pull[5] = torque.z;
  return pull;
}

double productOfSteps(const StepVector& a, const StepVector& b) noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += a[k] * b[k];
  return sum;
}

/// Share of the next step, from how the pull along the joints has changed with the last one (Barzilai and Borwein 1988);
/// the whole step if the pull did not fall.
double nextShare(double share, const StepVector& last, const StepVector& now) noexcept {
  constexpr double kLeast = 0.1, kMost = 2.0;
  const double whole = productOfSteps(last, last), fall = whole - productOfSteps(last, now);
  return fall > 0.0 ? std::clamp(share * whole / fall, kLeast, kMost) : 1.0;
}

double lengthOfStep(const StepVector& y) noexcept {
  return std::sqrt(productOfSteps(y, y));
}

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) noexcept {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Locks one joint's rows: those of its direction first, since their corrections are exact.
void lockJoint(const Placed& joint, const RigidTransform& pose, const glm::dvec3& centreInPart,
               const MassMetric& metric, LockedMotions& locked) noexcept {
  const glm::dquat principalFromWorld = metric.principalFromWorld(pose);
  const std::array<glm::dvec3, 2> across = axesAcross(joint.target);
  if (joint.kind != JointKind::ToPoint) {
    const glm::dvec3 turn = rotationVector(turnOnto(joint, pose.rotation));
    for (const glm::dvec3& axis : across) {
      const glm::dvec3 inPrincipal = principalFromWorld * axis / metric.gyration;
      locked.lock({0.0, 0.0, 0.0, inPrincipal.x, inPrincipal.y, inPrincipal.z}, glm::dot(turn, axis));
    }
  }
  const glm::dvec3 point = pose.applyToPoint(pointNear(joint, centreInPart));
  const glm::dvec3 arm = point - pose.applyToPoint(centreInPart), shift = joint.place - point;
  const auto lockPoint = [&](const glm::dvec3& axis) {
    locked.lock(stepRow(axis, arm, principalFromWorld, metric), glm::dot(shift, axis));
  };
  if (joint.kind != JointKind::InPlane) {
    lockPoint(across[0]);
    lockPoint(across[1]);
  }
  if (joint.kind != JointKind::OnAxis) lockPoint(joint.target);
}

}  // namespace

JointSet::JointSet(std::span<const Placed> joints, const RigidTransform& worldFromPart) noexcept
    : count_(std::min(joints.size(), kMaxJointsPerPart)) {
  std::copy_n(joints.begin(), count_, joints_.begin());
  for (Placed& joint : joints_) {
    const bool isTurned = glm::dot(worldFromPart.rotation * joint.onPart.direction, joint.target) < 0.0;
    if (joint.kind == JointKind::OnAxis && isTurned) joint.target = -joint.target;
  }
  isContradictory_ = count_ > 1 && !findAnchor(worldFromPart);
}

bool JointSet::findAnchor(const RigidTransform& start) noexcept {
  const glm::dvec3 centre = joints_[0].onPart.point;
  const MassMetric metric = plainMetric(centre);
  const auto isFound = [&](const RigidTransform& from) {
    int most = kMaxFirstCorrections;
    const std::optional<RigidTransform> found = corrected(from, centre, metric, most);
    if (found) anchor_ = *found;
    return found.has_value();
  };
  if (isFound(start)) return true;
  // Corrections from there may lead nowhere although there is such a pose: try from all sides, by quarter turns about
  // two axes, with the first joint's turns between.
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 8; ++j) {
      const double quarter = 0.5 * std::numbers::pi, eighth = 0.5 * quarter;
      const glm::dquat turn = glm::angleAxis(eighth * j, joints_[0].target) *
                              glm::angleAxis(quarter * i, axesAcross(joints_[0].target)[0]);
      if (isFound({glm::normalize(turn * start.rotation), start.translation})) return true;
    }
  }
  return false;
}

MassMetric JointSet::plainMetric(const glm::dvec3& centreInPart) const noexcept {
  MassMetric metric;
  double farthest = 0.0;
  for (const Placed& joint : joints())
    farthest = std::max(farthest, glm::distance(joint.onPart.point, centreInPart));
  // With all features at the centre any weight does.
  if (farthest > 0.0) metric.gyration = glm::dvec3(farthest);
  return metric;
}

LockedMotions JointSet::lockedMotions(const RigidTransform& worldFromPart, const glm::dvec3& centreInPart,
                                      const MassMetric& metric) const noexcept {
  LockedMotions locked;
  for (std::size_t i = 0; !isContradictory_ && i < count_; ++i)
    lockJoint(joints_[i], worldFromPart, centreInPart, metric, locked);
  return locked;
}

JointResidual JointSet::residual(const RigidTransform& worldFromPart) const noexcept {
  JointResidual most;
  for (const Placed& joint : joints()) {
    const glm::dvec3 point = worldFromPart.applyToPoint(joint.onPart.point);
    most.distance = std::max(most.distance, glm::length(shiftOnto(joint, point)));
    if (joint.kind == JointKind::ToPoint) continue;
    const glm::dvec3 direction = worldFromPart.rotation * joint.onPart.direction;
    most.angle = std::max(most.angle, angleBetween(direction, joint.target));
  }
  return most;
}

double JointSet::lack(const RigidTransform& pose, const glm::dvec3& centreInPart,
                      const MassMetric& metric) const noexcept {
  double lengths = glm::length(pose.translation) + glm::length(centreInPart) +
                   std::max({metric.gyration.x, metric.gyration.y, metric.gyration.z});
  for (const Placed& joint : joints())
    lengths += glm::length(joint.place) + glm::length(joint.onPart.point);
  const double share = lengthOfStep(lockedMotions(pose, centreInPart, metric).correction()) / lengths;
  if (count_ == 1 || !(share <= kConverged)) return share;
  const JointResidual left = residual(pose);
  const bool doFit = left.distance <= kMaxMisfit && left.angle <= kMaxMisfitAngle;
  return doFit ? share : std::numeric_limits<double>::infinity();
}

std::optional<RigidTransform> JointSet::corrected(const RigidTransform& worldFromPart,
                                                  const glm::dvec3& centreInPart, const MassMetric& metric,
                                                  int& most) const noexcept {
  if (count_ == 0) return worldFromPart;
  if (isContradictory_) return std::nullopt;
  if (count_ == 1) return placedOn(joints_[0], worldFromPart, centreInPart);
  if (isOn(worldFromPart, centreInPart, metric)) return worldFromPart;
  // Corrections from far off are not first-order: begin on the oldest joint.
  RigidTransform pose = placedOn(joints_[0], worldFromPart, centreInPart);
  for (; most > 0; --most) {
    if (isOn(pose, centreInPart, metric)) return pose;
    pose = stepped(pose, lockedMotions(pose, centreInPart, metric).correction(), 1.0, centreInPart, metric);
  }
  return lack(pose, centreInPart, metric) <= kConverged ? std::optional(pose) : std::nullopt;
}

std::optional<RigidTransform> JointSet::correctedPose(const RigidTransform& worldFromPart,
                                                      const glm::dvec3& centreInPart,
                                                      const MassMetric& metric) const noexcept {
  int most = kMaxCorrections;
  return corrected(worldFromPart, centreInPart, metric, most);
}

RigidTransform JointSet::nearest(const RigidTransform& wanted, const glm::dvec3& centreInPart,
                                 const MassMetric& metric) const noexcept {
  int work = kMaxWork;
  const auto onJoints = [&](const RigidTransform& pose) {
    int most = std::min(work, kMaxCorrections);
    work -= most;
    const std::optional<RigidTransform> found = corrected(pose, centreInPart, metric, most);
    work += most;
    return found;
  };
  RigidTransform pose = onJoints(wanted).value_or(anchor_);
  double length = lengthOfStep(stepBetween(pose, wanted, centreInPart, metric));
  StepVector last{};
  double share = 1.0;
  for (int i = 0; i < kMaxRefinements; ++i) {
    const LockedMotions locked = lockedMotions(pose, centreInPart, metric);
    const StepVector step = locked.freePart(pullBetween(pose, wanted, centreInPart, metric));
    if (!(lengthOfStep(step) > kRefined * length)) break;
    if (i > 0) share = nextShare(share, last, step);
    bool isNearer = false;
    for (int halvings = 0; halvings <= kMaxHalvings && !isNearer; ++halvings) {
      const auto tried = onJoints(stepped(pose, step, share, centreInPart, metric));
      const double left = tried ? lengthOfStep(stepBetween(*tried, wanted, centreInPart, metric)) : length;
      isNearer = left < length;
      if (isNearer) {
        pose = *tried;
        length = left;
      } else {
        share *= 0.5;
      }
    }
    if (!isNearer) break;
    last = step;
  }
  return pose.isFinite() ? pose : wanted;
}

RigidTransform JointSet::nearestPose(const RigidTransform& worldFromPart,
                                     const glm::dvec3& centreInPart) const noexcept {
  if (count_ == 0 || isContradictory_) return worldFromPart;
  const MassMetric metric = plainMetric(centreInPart);
  if (isOn(worldFromPart, centreInPart, metric)) return worldFromPart;
  if (count_ == 1) return placedOn(joints_[0], worldFromPart, centreInPart);
  return nearest(worldFromPart, centreInPart, metric);
}

RigidTransform JointSet::nearestPose(const RigidTransform& worldFromPart, const glm::dvec3& centreInPart,
                                     const MassMetric& metric) const noexcept {
  if (count_ == 0 || isContradictory_ || isOn(worldFromPart, centreInPart, metric)) return worldFromPart;
  return nearest(worldFromPart, centreInPart, metric);
}

glm::dvec3 JointSet::freeShift(const glm::dvec3& shift) const noexcept {
  LockedMotions locked;
  const auto lock = [&locked](const glm::dvec3& axis) {
    locked.lock({axis.x, axis.y, axis.z, 0, 0, 0}, 0.0);
  };
  for (std::size_t i = 0; !isContradictory_ && i < count_; ++i) {
    const Placed& joint = joints_[i];
    const std::array<glm::dvec3, 2> across = axesAcross(joint.target);
    if (joint.kind != JointKind::InPlane) {
      lock(across[0]);
      lock(across[1]);
    }
    if (joint.kind != JointKind::OnAxis) lock(joint.target);
  }
  const StepVector free = locked.freePart({shift.x, shift.y, shift.z, 0, 0, 0});
  return {free[0], free[1], free[2]};
}

JointSet::Placed placedInWorld(const Scene& scene, const Joint& joint) {
  const RigidTransform worldFromBase = joint.base ? scene.get(*joint.base).worldFromPart : RigidTransform{};
  const glm::dvec3 direction = worldFromBase.applyToVector(joint.onBase.direction);
  // Planes are kept face to face.
  return {joint.kind, joint.onPart, worldFromBase.applyToPoint(joint.onBase.point),
          glm::normalize(joint.kind == JointKind::InPlane ? -direction : direction)};
}

JointSet jointsOf(const Scene& scene, PartId part) {
  std::array<JointSet::Placed, kMaxJointsPerPart> placed;
  std::size_t count = 0;
  const RigidTransform& worldFromPart = scene.get(part).worldFromPart;
  for (const Joint& joint : scene.joints()) {
    if (joint.part != part || !joint.isOn || count == placed.size()) continue;
    placed[count++] = placedInWorld(scene, joint);
  }
  return {std::span(placed).first(count), worldFromPart};
}

}  // namespace nearfit
