#pragma once

namespace nearfit {

/// What a device bears and what it takes to keep it stable; all finite, >= 0.
struct DeviceLimits {
  double maxForce = 10.0;  ///< [N]
  double maxTorque = 1.0;  ///< [N m]
  /// Fastest change of what is sent: full force in 5 ms.
  double forceSlew = 2000.0;  ///< [N/s]
  double torqueSlew = 200.0;  ///< [N m/s]
  /// Physical damping, the `b` of Colgate's bound: what device and hand take out of a vibration.
  double damping = 1.0;             ///< [N s/m]
  double rotationalDamping = 1e-3;  ///< [N m s/rad]
  /// Of handle and fingers, at the least: damping that a lighter hand would be turned round by is not
  /// rendered.
  double leastMass = 0.05;       ///< [kg]
  double leastInertia = 4.5e-5;  ///< As of that mass at 3 cm [kg m^2].
};

}  // namespace nearfit
