#pragma once

#include <glm/vec3.hpp>

#include "core/haptics/device_limits.h"
#include "core/haptics/haptic_settings.h"
#include "core/haptics/mass_metric.h"
#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"

namespace nearfit {

/// Stiffness and damping that are rendered between handle and part.
struct CouplingState {
  double stiffness = 0.0, damping = 0.0;                      ///< [N/m], [N s/m]
  double rotationalStiffness = 0.0, rotationalDamping = 0.0;  ///< [N m/rad], [N m s/rad]
  bool isHeldToBound = false;                                 ///< Less than requested, for stability.
};

/// Pose and velocity of a body, in the world frame; `twist` at the centre of mass.
struct BodyMotion {
  RigidTransform pose;  ///< worldFromPart.
  Twist twist;
};

/// Part of the device's damping that the automatic coupling uses for its own: enough to calm the snap off a
/// corner, little enough to leave four fifths of the stiffness.
inline constexpr double kAutomaticDampingShare = 0.2;
/// Part of the bound that the automatic coupling uses: a device's damping is seldom known better than that.
inline constexpr double kAutomaticStiffnessShare = 0.8;
/// Requested damping is limited to this part of the device's own, so that the bound leaves a stiffness.
inline constexpr double kMaxDampingShare = 0.5;

/// Max stiffness K of a wall, sampled and held, that is passive in anyone's hand: b > K T / 2 + |B|. For
/// translation [N/m] from [N s/m], for rotation [N m/rad] from [N m s/rad].
///
/// @param deviceDamping    b, physical.
/// @param couplingDamping  B, rendered.
/// @param period           T, from one output to the next [s].
/// 0 if there is no such stiffness, for numbers that are not finite, and for a period <= 0. Real-time safe.
/// Source: Colgate & Schenkel 1997, Passivity of a class of sampled-data systems. It holds for damping from
/// backward differences, low-passed or not.
double stiffnessBound(double deviceDamping, double couplingDamping, double period) noexcept;

/// The coupling that is rendered for a requested one. Automatic: the damping is kAutomaticDampingShare of the
/// device's, the stiffness kAutomaticStiffnessShare of the bound that this leaves. As far as their own bound
/// allows, rotational values are these times the square of the part's largest gyration, as in its metric, so
/// that the wrench is orthogonal to what holds the part. Not automatic: each number as requested, limited to
/// kMaxDampingShare and to the bound.
///
/// @param device  Limits at the handle (limitsAtHandle()).
/// @param period  Measured (PeriodMeter) [s].
/// The result is finite and >= 0 for any input; zero stiffness where the bound has no meaning.
/// Real-time safe.
CouplingState boundedCoupling(const CouplingSettings& wish, const DeviceLimits& device,
                              const MassMetric& metric, double period) noexcept;

/// Factor on the radii of gyration with which the metric weighs rotation against translation as the
/// coupling's energy does. A proxy that is nearest in any other metric would gain energy for nothing, by
/// giving way in one metric to be nearer in the other. 1 if the stiffnesses agree with the metric, or one of
/// them is zero. Limited to [kMinTurnScale, kMaxTurnScale] for the program's condition; the passivity
/// controller handles the rest. Real-time safe.
double turnScale(const CouplingState& coupling, const MassMetric& metric) noexcept;
inline constexpr double kMinTurnScale = 0.1, kMaxTurnScale = 20.0;

/// turnScale() for a device that senses turning and has no motors against it. The hand turns such a device without
/// work. If the proxy then moved aside, its spring would push with energy that nobody gave. So the proxy turns as
/// freely as the program's condition allows: of a force on an arm as long as the gyration, a hundredth is left that
/// comes from turning.
/// Source: Barbagli & Salisbury 2003, The effect of sensor/actuator asymmetries in haptic interfaces.
inline constexpr double kTurnScaleWithoutTorque = kMinTurnScale;

/// Wrench on the hand of the spring and damper from handle to part, about the centre of mass of the handle's
/// pose; world frame. The spring's force is `stiffness` times the offset of the centres. Its torque is that
/// of a spring whose stiffness about each principal axis of the part is proportional to the square of its
/// gyration: the proxy is nearest in that metric, so any other torque would not be orthogonal to the
/// contacts. It is the derivative of the spring's energy with respect to the hand's rotation, so no closed
/// path gains energy; for small rotations, stiffness times rotation.
///
/// @param centreInPart  Centre of mass, in the part's frame [m].
/// Exactly zero if both have one pose and one twist. Past half a turn between hand and part the torque pulls
/// the shorter way round, so it changes sign. NaN and infinity propagate. Real-time safe. Source: Ortega,
/// Redon & Coquillart 2007, 5; with damping.
Wrench couplingWrench(const CouplingState& coupling, const MassMetric& metric, const glm::dvec3& centreInPart,
                      const BodyMotion& handle, const BodyMotion& part) noexcept;

/// A wanted wrench, and the part of it that the device can render.
struct LimitedCoupling {
  Wrench wanted;    ///< couplingWrench().
  Wrench rendered;  ///< Within the limits, but for damping beyond them.
};

/// couplingWrench() before and after the device's limits.
///
/// The torque is clamped to its limit. One factor then scales force and torque together, so that the wrench stays
/// square to what contacts leave free; a force that is clamped alone leaves a component along it, which drags. The
/// factor depends only on the spring's energy E: sqrt(M / E) beyond M = maxForce^2 / (2 stiffness), where a spring
/// that is only shifted reaches the max force. So the wrench is the derivative of storedEnergy() for the same limits,
/// and no closed path gains energy. The force stays within its limit; a torque without force stays below maxForce times
/// sqrt(rotationalStiffness / stiffness) too.
///
/// A limit of 0 renders no force or no torque, and the other as without it. NaN and infinity propagate. Real-time safe.
LimitedCoupling limitedCoupling(const CouplingState& coupling, const MassMetric& metric,
                                const glm::dvec3& centreInPart, const BodyMotion& handle,
                                const BodyMotion& part, const DeviceLimits& limits) noexcept;

/// Energy in the spring between two poses [J], as limitedCoupling() renders it: beyond the limits it grows linearly
/// with the distance, since only so much comes back. Real-time safe.
double storedEnergy(const CouplingState& coupling, const MassMetric& metric, const glm::dvec3& centreInPart,
                    const RigidTransform& handle, const RigidTransform& part,
                    const DeviceLimits& limits) noexcept;

/// Turn in whose direction the coupling's energy falls fastest for the part, in a metric of gyration [rad].
///
/// For a small turn, or one about a principal axis, it is that turn itself. For others the derivative of the energy points
/// elsewhere: a proxy that went by the turn would come to rest where the torque still drives it along what is free.
/// @param turn  From the part to the hand, in the part's principal axes [rad].
/// Where gyrations differ much, large turns are followed only in part, since the torque then changes faster than the
/// metric says. Real-time safe.
glm::dvec3 steepestTurn(const glm::dvec3& turn, const glm::dvec3& gyration) noexcept;

/// Rotation vector from `from` to `to`, in their common frame [rad]; the shorter way. Exactly zero if they
/// are equal. Real-time safe.
glm::dvec3 turnBetween(const glm::dquat& from, const glm::dquat& to) noexcept;

}  // namespace nearfit
