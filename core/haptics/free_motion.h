#pragma once

#include <glm/vec3.hpp>

#include "core/haptics/virtual_coupling.h"

namespace nearfit {

/// Mass and weight of the part that the hand is to feel.
struct FeltMass {
  double mass = 0.0;         ///< Resists acceleration [kg]; 0 for no inertia.
  glm::dvec3 weight{0.0};    ///< World frame [N].
  bool isLightened = false;  ///< The weight was reduced to kMaxWeightShare of the device's force.
};

/// Max part of the device's force used for weight; the rest is left to feel contact.
inline constexpr double kMaxWeightShare = 0.5;

/// Mass and weight that the settings ask for; the weight is limited to kMaxWeightShare of `maxForce`.
/// @param mass      Of the part [kg]; counts as 0 if negative or not finite.
/// @param maxForce  Of the device [N].
/// Real-time safe.
FeltMass feltBody(const WeightSettings& settings, double mass, double maxForce) noexcept;

/// Moves a part that hangs on the coupling and touches nothing by one step. The result is the proxy's target.
///
/// Backward Euler: v+ = (m v + dt (K (h - p) + B v_h + W)) / (m + dt B + dt^2 K), where p + dt v+ is the new
/// position and h, v_h are the handle's position and velocity. Rotation likewise, with the metric's inertia.
/// It dissipates energy, to first order in dt, and never adds any: stable for every dt > 0. Gyroscopic
/// torque is left out.
///
/// Without mass the target is the handle's pose, bit for bit. With weight and no mass it is lower by the sag
/// W / K at which the hand carries the weight (no sag if K is zero).
///
/// @param centreInPart  Centre of mass, in the part's frame [m].
/// @param handle        At the end of the step.
/// @param part          At the start of the step.
/// @param dt            Step [s]; > 0.
/// @return Pose and twist after the step. NaN and infinity propagate. Real-time safe.
BodyMotion freeStep(const FeltMass& felt, const CouplingState& coupling, const MassMetric& metric,
                    const glm::dvec3& centreInPart, const BodyMotion& handle, const BodyMotion& part,
                    double dt) noexcept;

/// Kinetic energy of a moving part with the felt mass and the metric's inertia [J]. Real-time safe.
double kineticEnergy(const FeltMass& felt, const MassMetric& metric, const BodyMotion& part) noexcept;

}  // namespace nearfit
