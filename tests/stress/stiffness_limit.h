#pragma once

#include "tests/stress/stress_mode.h"

namespace nearfit::stress {

/// A device in one dimension that leans on a wall, through the servo.
struct LeaningDevice {
  double mass = 0.2;             ///< [kg]
  double damping = 1.0;          ///< Its own, b [N s/m].
  double period = 1e-3;          ///< Of the servo, T [s].
  double couplingDamping = 0.0;  ///< Rendered, B [N s/m].
  /// What it leans on: the coupling, or one spring over a flat floor, whose slope where it leans is the stiffness.
  StressMode mode = StressMode::Proxy;
};

/// The stiffness from which on a device that leans on a floor, nudged, is shaken ever more [N/m]: by
/// bisection over runs of whole ticks of the servo, to 1 %. The servo is told of a damping that the device
/// has not, so that it allows the stiffness, and its observer has nothing to object to.
double simulatedLimit(const LeaningDevice& device);

/// Whether the device, nudged, calms down at that stiffness.
bool isCalm(const LeaningDevice& device, double stiffness);

/// The same limit, from the map of one tick to the next. The device between two, under a force F that is
/// held, with a = exp(-T b / m):
///     x' = x + v tau (1 - a) + F c1     v' = a v + F c2     tau = m / b,
///     c1 = (T - tau (1 - a)) / b        c2 = (1 - a) / b
/// Without rendered damping F = -K x, stable as long as the determinant is below one (Jury):
/// K < b (1 - a) / (tau (1 - a) - a T). It tends to Colgate's 2 b / T for a heavy device, and is more for
/// every other. With it F = -K x - B w, w the servo's smoothed velocity, w' = w + s ((x' - x) / T - w'), s as
/// its time constant has it: stable as long as no eigenvalue of the map of (x, v, x before, w before) is
/// beyond one; found by bisection.
double exactLimit(const LeaningDevice& device);

/// What the application allows that device [N/m]. Of the printed law, which counts by its largest slope, that at
/// contact, half as much where the device leans.
double enforcedBound(const LeaningDevice& device);

}  // namespace nearfit::stress
