#include "core/haptics/virtual_coupling.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// By this much and the square of the turn, the torque about an axis of small gyration grows faster than the metric says,
/// times the square of how much larger another gyration is; and the max of it at which a step by the metric still does not
/// overshoot.
constexpr double kBendOfTorque = 1.0 / 12.0, kMaxSteepness = 0.5;

/// Spring and damper between two poses.
struct CouplingLoad {
  Stretch stretch;
  glm::dvec3 force, load;  ///< Of the spring; `load` as in torqueOf().
  glm::dvec3 torque;       ///< Of the spring.
};

CouplingLoad loadOf(const CouplingState& coupling, const MassMetric& metric, const glm::dvec3& centreInPart,
                    const RigidTransform& handle, const RigidTransform& part) noexcept {
  CouplingLoad load;
  load.stretch = stretchOf(centreInPart, handle, part);
  load.force = coupling.stiffness * load.stretch.shift;
  load.load = byGyration(metric, part, coupling.rotationalStiffness * load.stretch.turn);
  load.torque = torqueOf(load.load, load.stretch.turn);
  return load;
}

/// Wrench of the damper.
Wrench dampingOf(const CouplingState& coupling, const MassMetric& metric, const BodyMotion& handle,
                 const BodyMotion& part) noexcept {
  return {coupling.damping * (part.twist.linear - handle.twist.linear),
          byGyration(metric, part.pose,
                     coupling.rotationalDamping * (part.twist.angular - handle.twist.angular))};
}

/// The spring with its torque clamped and nothing else limited.
struct TorqueLimited {
  double share = 1.0;   ///< Of the torque.
  double energy = 0.0;  ///< [J]
  /// Energy beyond which force and torque are scaled down [J]; infinity without a force.
  double limit = std::numeric_limits<double>::infinity();
};

TorqueLimited torqueLimited(const CouplingState& coupling, const CouplingLoad& load,
                            const DeviceLimits& limits) noexcept {
  TorqueLimited result;
  const double torque = glm::length(load.torque);
  if (torque > limits.maxTorque) result.share = limits.maxTorque / torque;
  // The integral of what is rendered along the straight way. Leaves out that the torque of large rotations grows a
  // little less than the rotation.
  result.energy = result.share * (1.0 - 0.5 * result.share) * glm::dot(load.load, load.stretch.turn);
  if (!(limits.maxForce > 0.0) || !(coupling.stiffness > 0.0)) return result;
  result.energy += 0.5 * glm::dot(load.force, load.stretch.shift);
  result.limit = 0.5 * limits.maxForce * limits.maxForce / coupling.stiffness;
  return result;
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

glm::dvec3 steepestTurn(const glm::dvec3& turn, const glm::dvec3& gyration) noexcept {
  const glm::dvec3 inertia = gyration * gyration;
  // The turn from the hand to the part is the opposite one, and the torque on the part that on the hand.
  const glm::dvec3 correction = -torqueOf(-inertia * turn, -turn) / inertia - turn;
  const double largest = std::max({inertia.x, inertia.y, inertia.z});
  const double smallest = std::min({inertia.x, inertia.y, inertia.z});
  const double steepness = kBendOfTorque * glm::dot(turn, turn) * largest / smallest;
  return turn + (steepness > kMaxSteepness ? kMaxSteepness / steepness : 1.0) * correction;
}

Wrench couplingWrench(const CouplingState& coupling, const MassMetric& metric, const glm::dvec3& centreInPart,
                      const BodyMotion& handle, const BodyMotion& part) noexcept {
  const CouplingLoad spring = loadOf(coupling, metric, centreInPart, handle.pose, part.pose);
  const Wrench damper = dampingOf(coupling, metric, handle, part);
  return {spring.force + damper.force, spring.torque + damper.torque};
}

LimitedCoupling limitedCoupling(const CouplingState& coupling, const MassMetric& metric,
                                const glm::dvec3& centreInPart, const BodyMotion& handle,
                                const BodyMotion& part, const DeviceLimits& limits) noexcept {
  const CouplingLoad spring = loadOf(coupling, metric, centreInPart, handle.pose, part.pose);
  const Wrench damper = dampingOf(coupling, metric, handle, part);
  const TorqueLimited limited = torqueLimited(coupling, spring, limits);
  const double share = limited.energy > limited.limit ? std::sqrt(limited.limit / limited.energy) : 1.0;
  const double forceShare = limits.maxForce > 0.0 ? share : 0.0;
  return {
      {spring.force + damper.force, spring.torque + damper.torque},
      {forceShare * (spring.force + damper.force), share * (limited.share * spring.torque + damper.torque)}};
}

double storedEnergy(const CouplingState& coupling, const MassMetric& metric, const glm::dvec3& centreInPart,
                    const RigidTransform& handle, const RigidTransform& part,
                    const DeviceLimits& limits) noexcept {
  const CouplingLoad spring = loadOf(coupling, metric, centreInPart, handle, part);
  const TorqueLimited limited = torqueLimited(coupling, spring, limits);
  if (!(limited.energy > limited.limit)) return limited.energy;
  return 2.0 * std::sqrt(limited.limit * limited.energy) - limited.limit;
}

}  // namespace nearfit
