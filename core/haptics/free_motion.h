#pragma once

#include <glm/vec3.hpp>

#include "core/haptics/virtual_coupling.h"

namespace nearfit {

/// What a part that hangs on the coupling is made of, as far as the hand is to feel it.
struct Felt {
  double mass = 0.0;         ///< Resists acceleration [kg]; 0: it does not.
  glm::dvec3 weight{0.0};    ///< World frame [N].
  bool isLightened = false;  ///< The true weight is more than the device is asked for.
};

/// Part of the device's force that weight may take, so that enough is left to feel contact.
inline constexpr double kMostWeightShare = 0.5;

/// Mass and weight as the settings ask for; not more weight than kMostWeightShare of `maxForce`.
/// @param mass  Of the part [kg]; >= 0.   @param maxForce  Of the device [N].
/// A mass that is not finite or negative is 0. Real-time safe.
Felt feltBody(const WeightSettings& settings, double mass, double maxForce) noexcept;

/// One step of a part that hangs on the coupling and touches nothing: what the proxy strives for.
/// By backward Euler, v+ = (m v + dt (K (h - p) + B v_h + W)) / (m + dt B + dt^2 K), with p + dt v+ the new
/// place and h, v_h the handle's; the same for rotation, whose inertia is that of the metric. It takes out
/// energy, of first order in dt, and never adds any: stable for every dt > 0. Gyroscopic torque is left out.
///
/// Without mass the target is the handle's pose, bit for bit; with weight and no mass, lower by the sag
/// W / K at which the hand carries the weight (no sag where K is zero).
///
/// @param centreInPart  Centre of mass [m].   @param part  As it is now.   @param dt  Step [s]; > 0.
/// @return Pose and twist after the step. NaN or infinity in comes out. Real-time safe.
BodyMotion freeStep(const Felt& felt, const CouplingState& coupling, const MassMetric& metric,
                    const glm::dvec3& centreInPart, const BodyMotion& handle, const BodyMotion& part,
                    double dt) noexcept;

/// Of a part with mass that moves [J]; its inertia is that of the metric. Real-time safe.
double kineticEnergy(const Felt& felt, const MassMetric& metric, const BodyMotion& part) noexcept;

}  // namespace nearfit
