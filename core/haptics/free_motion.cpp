#include "core/haptics/free_motion.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/finite.h"
#include "core/math/rotation_vector.h"

namespace nearfit {
namespace {

/// Mass on a spring and damper, in the units of the vectors passed.
struct Oscillator {
  double inertia, stiffness, damping;

  /// Velocity after the step.
  /// @param offset  From the mass to the spring's other end, after that end has moved.
  glm::dvec3 step(const glm::dvec3& velocity, const glm::dvec3& offset, const glm::dvec3& endVelocity,
                  const glm::dvec3& load, double dt) const noexcept {
    const glm::dvec3 impulse = dt * (stiffness * offset + damping * endVelocity + load);
    return (inertia * velocity + impulse) / (inertia + dt * damping + dt * dt * stiffness);
  }
};

glm::dvec3 sag(const glm::dvec3& weight, double stiffness) noexcept {
  const glm::dvec3 result = weight / stiffness;
  return isFinite(result) ? result : glm::dvec3(0.0);
}

}  // namespace

FeltMass feltBody(const WeightSettings& settings, double mass, double maxForce) noexcept {
  FeltMass felt;
  if (!std::isfinite(mass) || !(mass > 0.0)) return felt;
  if (settings.hasInertia) felt.mass = mass;
  if (!settings.hasWeight) return felt;
  const double most = kMaxWeightShare * maxForce, weight = mass * glm::length(settings.gravity);
  felt.isLightened = weight > most;
  felt.weight = settings.gravity * (felt.isLightened ? mass * (most / weight) : mass);
  return felt;
}

BodyMotion freeStep(const FeltMass& felt, const CouplingState& coupling, const MassMetric& metric,
                    const glm::dvec3& centreInPart, const BodyMotion& handle, const BodyMotion& part,
                    double dt) noexcept {
  if (!(felt.mass > 0.0)) {
    BodyMotion hanging = handle;
    if (felt.weight != glm::dvec3(0.0)) hanging.pose.translation += sag(felt.weight, coupling.stiffness);
    return hanging;
  }
  const double gyration = std::max({metric.gyration.x, metric.gyration.y, metric.gyration.z});
  const glm::dvec3 centre = part.pose.applyToPoint(centreInPart);
  const Oscillator linear{felt.mass, coupling.stiffness, coupling.damping};
  // Inertia, stiffness and damping about each axis are all proportional to the square of its gyration, which
  // cancels: one oscillator serves all axes.
  const Oscillator angular{felt.mass * gyration * gyration, coupling.rotationalStiffness,
                           coupling.rotationalDamping};
  BodyMotion next;
  next.twist.linear = linear.step(part.twist.linear, handle.pose.applyToPoint(centreInPart) - centre,
                                  handle.twist.linear, felt.weight, dt);
  next.twist.angular = angular.step(part.twist.angular, turnBetween(part.pose.rotation, handle.pose.rotation),
                                    handle.twist.angular, glm::dvec3(0.0), dt);
  next.pose.rotation = glm::normalize(rotationOf(dt * next.twist.angular) * part.pose.rotation);
  next.pose.translation = centre + dt * next.twist.linear - next.pose.rotation * centreInPart;
  return next;
}

double kineticEnergy(const FeltMass& felt, const MassMetric& metric, const BodyMotion& part) noexcept {
  const glm::dquat principalFromWorld = metric.principalFromWorld(part.pose);
  const glm::dvec3 spin = metric.gyration * (principalFromWorld * part.twist.angular);
  return 0.5 * felt.mass * (glm::dot(part.twist.linear, part.twist.linear) + glm::dot(spin, spin));
}

}  // namespace nearfit
