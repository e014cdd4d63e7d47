#pragma once

namespace nearfit {

/// Max output of a device, and the properties that its stability depends on; all finite, >= 0.
struct DeviceLimits {
  double maxForce = 10.0;  ///< [N]
  double maxTorque = 1.0;  ///< [N m]
  /// Max rate of change of the output; by default full force takes 5 ms.
  double forceSlew = 2000.0;  ///< [N/s]
  double torqueSlew = 200.0;  ///< [N m/s]
  /// Physical damping, the `b` of Colgate's bound: what device and hand dissipate of a vibration.
  double damping = 1.0;             ///< [N s/m]
  double rotationalDamping = 1e-3;  ///< [N m s/rad]
  /// Lower bound on the mass of handle and fingers. Rendered damping stays below what would reverse a lighter
  /// hand within a tick.
  double leastMass = 0.05;  ///< [kg]
  /// Lower bound on their inertia: that mass at 3 cm [kg m^2].
  double leastInertia = 4.5e-5;
};

}  // namespace nearfit
