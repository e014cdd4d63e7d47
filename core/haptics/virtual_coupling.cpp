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
  const double damping =
      std::min(finiteOrZero(wish.damping), kMostDampingShare * finiteOrZero(deviceDamping));
  const double bound = stiffnessBound(deviceDamping, damping, period);
  return {std::min(finiteOrZero(wish.stiffness), bound), damping};
}

bool isLess(const SpringDamper& held, const SpringDamper& wish) noexcept {
  return held.stiffness < wish.stiffness || held.damping < wish.damping;
}

SpringDamper asStiffAsAllowed(double deviceDamping, double damping, double period) noexcept {
  return {kAutomaticStiffnessShare * stiffnessBound(deviceDamping, damping, period), damping};
}

/// @param damping  What the device takes out of the handle's motion [N s/m].
CouplingState automatic(double damping, double rotationalDamping, double gyration, double period) noexcept {
  const double area = finiteOrZero(gyration * gyration);
  const SpringDamper linear = asStiffAsAllowed(damping, kAutomaticDampingShare * damping, period);
  const double angularDamping = std::min(linear.damping * area, kAutomaticDampingShare * rotationalDamping);
  const SpringDamper angular = asStiffAsAllowed(rotationalDamping, angularDamping, period);
  return {linear.stiffness, linear.damping, std::min(linear.stiffness * area, angular.stiffness),
          angular.damping, false};
}

/// From the handle to the part: of the centres, and of the turn; world frame.
struct Stretch {
  glm::dvec3 shift, turn;
};

Stretch stretchOf(const glm::dvec3& centreInPart, const RigidTransform& handle,
                  const RigidTransform& part) noexcept {
  return {part.applyToPoint(centreInPart) - handle.applyToPoint(centreInPart),
          turnBetween(handle.rotation, part.rotation)};
}

/// Along each principal axis of the part by the square of its gyration, that of the largest being one.
glm::dvec3 byGyration(const MassMetric& metric, const RigidTransform& part,
                      const glm::dvec3& vector) noexcept {
  const glm::dquat worldFromPrincipal = part.rotation * metric.partFromPrincipal;
  const glm::dvec3 ratio = metric.gyration / largestGyration(metric);
  return worldFromPrincipal * (ratio * ratio * (glm::conjugate(worldFromPrincipal) * vector));
}

/// Of a spring whose load is clamped at a limit: the integral of the clamped load.
double storedIn(const glm::dvec3& load, const glm::dvec3& stretch, double limit) noexcept {
  const double size = glm::length(load);
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

glm::dvec3 turnBetween(const glm::dquat& from, const glm::dquat& to) noexcept {
  // The product of a quaternion and its conjugate is the identity only but for rounding where operations are
  // fused.
  if (from == to) return glm::dvec3(0.0);
  return rotationVector(to * glm::conjugate(from));
}

Wrench couplingWrench(const CouplingState& coupling, const MassMetric& metric, const glm::dvec3& centreInPart,
                      const BodyMotion& handle, const BodyMotion& part) noexcept {
  const Stretch stretch = stretchOf(centreInPart, handle.pose, part.pose);
  const glm::dvec3 twisting = coupling.rotationalStiffness * stretch.turn +
                              coupling.rotationalDamping * (part.twist.angular - handle.twist.angular);
  return {coupling.stiffness * stretch.shift + coupling.damping * (part.twist.linear - handle.twist.linear),
          byGyration(metric, part.pose, twisting)};
}

double storedEnergy(const CouplingState& coupling, const MassMetric& metric, const glm::dvec3& centreInPart,
                    const RigidTransform& handle, const RigidTransform& part,
                    const DeviceLimits& limits) noexcept {
  const Stretch stretch = stretchOf(centreInPart, handle, part);
  const glm::dvec3 torque = byGyration(metric, part, coupling.rotationalStiffness * stretch.turn);
  return storedIn(coupling.stiffness * stretch.shift, stretch.shift, limits.maxForce) +
         storedIn(torque, stretch.turn, limits.maxTorque);
}

}  // namespace nearfit
