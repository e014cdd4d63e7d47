#pragma once

#include <glm/vec3.hpp>

#include "core/haptics/device_limits.h"
#include "core/haptics/haptic_settings.h"
#include "core/haptics/mass_metric.h"
#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"

namespace nearfit {

/// Stiffness and damping in force between hand and part.
struct CouplingState {
  double stiffness = 0.0, damping = 0.0;                      ///< [N/m], [N s/m]
  double rotationalStiffness = 0.0, rotationalDamping = 0.0;  ///< [N m/rad], [N m s/rad]
  bool isHeldToBound = false;                                 ///< Less than was wished, for stability.
};

/// Where a body is and how it moves; world frame, `twist` at the centre of mass.
struct BodyMotion {
  RigidTransform pose;  ///< worldFromPart.
  Twist twist;
};

/// Part of the device's damping that the automatic coupling uses for its own: enough to calm the snap off a
/// corner, little enough that four fifths of the stiffness stay.
inline constexpr double kAutomaticDampingShare = 0.2;
/// The automatic coupling's part of the bound: what is known of a device's damping is seldom better than
/// that.
inline constexpr double kAutomaticStiffnessShare = 0.8;
/// Damping that is wished counts up to this part of the device's own, so that the bound leaves a stiffness.
inline constexpr double kMostDampingShare = 0.5;

/// The largest stiffness K of a wall, sampled and held, that is passive in anyone's hand:
/// b > K T / 2 + |B|. For translation [N/m] from [N s/m], for rotation [N m/rad] from [N m s/rad].
///
/// @param deviceDamping    b, physical.     @param couplingDamping  B, rendered.
/// @param period           T, from one output to the next [s].
/// 0 where there is no such stiffness, and for numbers that are not finite or a period <= 0. Real-time safe.
/// Source: Colgate & Schenkel 1997, Passivity of a class of sampled-data systems. It holds for damping from
/// backward differences, low-passed or not.
double stiffnessBound(double deviceDamping, double couplingDamping, double period) noexcept;

/// What is enforced of the wished coupling. Automatic: the damping is kAutomaticDampingShare of the device's,
/// the stiffness kAutomaticStiffnessShare of the bound that this leaves. Rotation is that of the part's
/// metric (stiffness and damping times the square of its largest gyration), so that the wrench is square to
/// what holds the part, where its own bound allows. Not automatic: each number as wished, up to
/// kMostDampingShare and to the bound.
///
/// @param device  As at the handle (limitsAtHandle).   @param period  Measured (PeriodMeter) [s].
/// Any input: finite and >= 0; zero stiffness where the bound has no meaning. Real-time safe.
CouplingState boundedCoupling(const CouplingSettings& wish, const DeviceLimits& device,
                              const MassMetric& metric, double period) noexcept;

/// What the radii of gyration have to be multiplied by for the metric to weigh turns against shifts as the
/// coupling's energy does: a proxy that is nearest in any other metric gains energy where it gives way in the
/// one to be nearer in the other, for nothing. 1 where stiffnesses agree with the metric, and where one is
/// zero; held to [kLeastTurnScale, kMostTurnScale] for the sake of the program's condition, which leaves the
/// rest to the passivity controller. Real-time safe.
double turnScale(const CouplingState& coupling, const MassMetric& metric) noexcept;
inline constexpr double kLeastTurnScale = 0.1, kMostTurnScale = 20.0;

/// Spring and damper from the handle to the part, on the hand, about the centre of mass of the handle's
/// pose; world frame. The force is `stiffness` times the distance of the centres; the torque that of a spring
/// whose stiffness about each principal axis of the part goes with the square of its gyration, since the
/// proxy is nearest in that metric: a torque of any other would not be square to the contacts. It is the
/// derivative of the spring's energy by the turn of the hand, so that no way round gains anything; for small
/// turns, stiffness times turn.
///
/// @param centreInPart  Centre of mass [m].
/// Zero exactly where both are at one pose with one twist. Hand and part turned by more than half a turn
/// against each other pull the shorter way round: the torque then changes sign. NaN or infinity in comes out.
/// Real-time safe.
/// Source: Ortega, Redon & Coquillart 2007, 5; with damping.
Wrench couplingWrench(const CouplingState& coupling, const MassMetric& metric, const glm::dvec3& centreInPart,
                      const BodyMotion& handle, const BodyMotion& part) noexcept;

/// Energy in the spring between the poses [J], less what it could not give back as its force and torque are
/// clamped to the limits: from there on it grows with the distance, not with its square. Real-time safe.
double storedEnergy(const CouplingState& coupling, const MassMetric& metric, const glm::dvec3& centreInPart,
                    const RigidTransform& handle, const RigidTransform& part,
                    const DeviceLimits& limits) noexcept;

/// The turn, as axis times angle in the common frame [rad], that takes `from` to `to` the shorter way; zero
/// exactly for equal ones. Real-time safe.
glm::dvec3 turnBetween(const glm::dquat& from, const glm::dquat& to) noexcept;

}  // namespace nearfit
