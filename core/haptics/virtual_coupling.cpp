#include "core/haptics/virtual_coupling.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"

namespace nearfit {
namespace {

double finiteOrZero(double value) noexcept {
  return std::isfinite(value) && value > 0.0 ? value : 0.0;
}

double largestGyration(const MassMetric& metric) noexcept {
  return std::max({metric.gyration.x, metric.gyration.y, metric.gyration.z});
}

struct SpringDamper {
  double stiffness = 0.0, damping = 0.0;
};

SpringDamper heldTo(const SpringDamper& wish, double deviceDamping, double period) noexcept {
  const double damping = std::min(finiteOrZero(wish.damping), kMaxDampingShare * finiteOrZero(deviceDamping));
  const double bound = stiffnessBound(deviceDamping, damping, period);
  return {std::min(finiteOrZero(wish.stiffness), bound), damping};
}

bool isLess(const SpringDamper& held, const SpringDamper& wish) noexcept {
  return held.stiffness < wish.stiffness || held.damping < wish.damping;
}

SpringDamper asStiffAsAllowed(double deviceDamping, double damping, double period) noexcept {
  return {kAutomaticStiffnessShare * stiffnessBound(deviceDamping, damping, period), damping};
}

/// @param damping  Physical damping of the device [N s/m].
CouplingState automatic(double damping, double rotationalDamping, double gyration, double period) noexcept {
  const double area = finiteOrZero(gyration * gyration);
  const SpringDamper linear = asStiffAsAllowed(damping, kAutomaticDampingShare * damping, period);
  const double angularDamping = std::min(linear.damping * area, kAutomaticDampingShare * rotationalDamping);
  const SpringDamper angular = asStiffAsAllowed(rotationalDamping, angularDamping, period);
  return {linear.stiffness, linear.damping, std::min(linear.stiffness * area, angular.stiffness),
          angular.damping, false};
}

/// From the handle to the part, in the world frame: offset of the centres [m], and rotation vector [rad].
struct Stretch {
  glm::dvec3 shift, turn;
};

Stretch stretchOf(const glm::dvec3& centreInPart, const RigidTransform& handle,
                  const RigidTransform& part) noexcept {
  return {part.applyToPoint(centreInPart) - handle.applyToPoint(centreInPart),
          turnBetween(handle.rotation, part.rotation)};
}

/// Scales the component along each principal axis of the part by the square of its gyration, relative
/// to the largest.
glm::dvec3 byGyration(const MassMetric& metric, const RigidTransform& part,
                      const glm::dvec3& vector) noexcept {
  const glm::dquat worldFromPrincipal = metric.worldFromPrincipal(part);
  const glm::dvec3 ratio = metric.gyration / largestGyration(metric);
  return worldFromPrincipal * (ratio * ratio * (glm::conjugate(worldFromPrincipal) * vector));
}

/// Torque on the hand of a spring with the energy V = 1/2 turn . K turn, from `load` = K turn. It is the
/// derivative of V with respect to the hand's rotation: J^-T load, with J the right Jacobian of the rotation
/// vector. K turn itself is not, unless K is the same about all axes: on a loop of large rotations it would
/// create energy.
glm::dvec3 torqueOf(const glm::dvec3& load, const glm::dvec3& turn) noexcept {
  constexpr double kSmall = 1e-4;
  const double angle = glm::length(turn);
  // (1 - x cot x) / angle^2 with x = angle / 2, which tends to 1 / 12.
  const double bend =
      angle < kSmall ? 1.0 / 12.0 : (1.0 - 0.5 * angle / std::tan(0.5 * angle)) / (angle * angle);
  const glm::dvec3 across = glm::cross(turn, load);
  return load - 0.5 * across + bend * glm::cross(turn, across);
}

/// Energy of a spring whose force or torque, of length `size`, is clamped at a limit: the integral of what
/// is rendered along the straight way. Leaves out that the torque of large rotations grows a little less
/// than the rotation.
double storedIn(const glm::dvec3& load, double size, const glm::dvec3& stretch, double limit) noexcept {
  const double rendered = size > limit ? limit / size : 1.0;
  return rendered * (1.0 - 0.5 * rendered) * glm::dot(load, stretch);
}

}  // namespace

double stiffnessBound(double deviceDamping, double couplingDamping, double period) noexcept {
  if (!(period > 0.0)) return 0.0;
  return finiteOrZero(2.0 * (deviceDamping - std::abs(couplingDamping)) / period);
}

CouplingState boundedCoupling(const CouplingSettings& wish, const DeviceLimits& device,
                              const MassMetric& metric, double period) noexcept {
  const double damping = finiteOrZero(device.damping);
  const double rotationalDamping = finiteOrZero(device.rotationalDamping);
  if (wish.isAutomatic) {
    return automatic(damping, rotationalDamping, largestGyration(metric), period);
  }
  const SpringDamper linearWish{wish.stiffness, wish.damping};
  const SpringDamper angularWish{wish.rotationalStiffness, wish.rotationalDamping};
  const SpringDamper linear = heldTo(linearWish, damping, period);
  const SpringDamper angular = heldTo(angularWish, rotationalDamping, period);
  return {linear.stiffness, linear.damping, angular.stiffness, angular.damping,
          isLess(linear, linearWish) || isLess(angular, angularWish)};
}

double turnScale(const CouplingState& coupling, const MassMetric& metric) noexcept {
  const double gyration = largestGyration(metric);
  const double scale =
      std::sqrt(coupling.rotationalStiffness / coupling.stiffness) / (gyration > 0.0 ? gyration : 1.0);
  return std::isfinite(scale) && scale > 0.0 ? std::clamp(scale, kMinTurnScale, kMaxTurnScale) : 1.0;
}

glm::dvec3 turnBetween(const glm::dquat& from, const glm::dquat& to) noexcept {
  // With fused operations, a quaternion times its conjugate is the identity only to rounding.
  if (from == to) return glm::dvec3(0.0);
  return rotationVector(to * glm::conjugate(from));
}

Wrench couplingWrench(const CouplingState& coupling, const MassMetric& metric, const glm::dvec3& centreInPart,
                      const BodyMotion& handle, const BodyMotion& part) noexcept {
  const Stretch stretch = stretchOf(centreInPart, handle.pose, part.pose);
  const glm::dvec3 load = byGyration(metric, part.pose, coupling.rotationalStiffness * stretch.turn);
  const glm::dvec3 damping =
      byGyration(metric, part.pose, coupling.rotationalDamping * (part.twist.angular - handle.twist.angular));
  return {coupling.stiffness * stretch.shift + coupling.damping * (part.twist.linear - handle.twist.linear),
          torqueOf(load, stretch.turn) + damping};
}

double storedEnergy(const CouplingState& coupling, const MassMetric& metric, const glm::dvec3& centreInPart,
                    const RigidTransform& handle, const RigidTransform& part,
                    const DeviceLimits& limits) noexcept {
  const Stretch stretch = stretchOf(centreInPart, handle, part);
  const glm::dvec3 load = byGyration(metric, part, coupling.rotationalStiffness * stretch.turn);
  const glm::dvec3 force = coupling.stiffness * stretch.shift;
  return storedIn(force, glm::length(force), stretch.shift, limits.maxForce) +
         storedIn(load, glm::length(torqueOf(load, stretch.turn)), stretch.turn, limits.maxTorque);
}

}  // namespace nearfit
