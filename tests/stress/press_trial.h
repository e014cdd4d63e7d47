#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/haptics/device_limits.h"
#include "tests/stress/stress_mode.h"
#include "tests/stress/stress_scene.h"

namespace nearfit::stress {

/// A hand that presses a part into a contact and holds still there.
struct PressScene {
  std::string name;
  StressScene scene;
  RigidTransform wanted;  ///< worldFromPart where the grip wants it: beyond the contact.
  /// The scene's motions are so many times the device's: a part of 1 mm or 1 km is pressed as one of 0.1 m
  /// is.
  double scale = 1.0;
};

/// Flat on a floor, on an edge, in a corner, wedged, in its bore, between plates, against a wall of 1 um from
/// outside and inside, in a grid, between components that overlap, ring in ring, the rings of 1 mm and 1 km
/// and far from the origin, in a box; and open sheets: a sheet on a sheet, a cup in a coil, neither with an inside.
std::vector<PressScene> pressScenes();

struct PressOptions {
  /// Of the coupling or each spring, wished, at the device [N/m]; 0: as stiff as the device's bound allows.
  double stiffness = 0.0;
  StressMode mode = StressMode::Proxy;
  /// Of the device [N s/m]: what it has, and what the servo takes it to have; 0: the same.
  double damping = DeviceLimits{}.damping, toldDamping = 0.0;
  double period = 1e-3;  ///< Of the servo, nominal [s].
  bool isRough = false;  ///< Periods vary by a third either way, and one tick in twenty is lost.
  double friction = 0.0;
  double seconds = 4.0;  ///< Of which the last is looked at.
  std::uint64_t seed = 1;
};

/// All of the device: where the scene is scaled, its motions and torques are over the scale.
struct PressResult {
  double handle = 0.0;  ///< Root mean square of the handle's motion about its mean, turns by the radius [m].
  double shake = 0.0;   ///< The same about its mean of kShakeSpan around: without slow ways [m].
  double force = 0.0;   ///< Of the force's [N].
  double torque = 0.0;  ///< Of the torque's [N m].
  double stiffness = 0.0;   ///< In force at the end [N/m].
  double meanForce = 0.0;   ///< At the end [N].
  double forceStep = 0.0;   ///< Largest, from one tick to the next in that time, before limits and ramps [N].
  double energyGain = 0.0;  ///< EnergyLedger's, over the whole trial after the force has risen [J].
  double lag = 0.0;         ///< Largest, of the part behind the hand in that time [m]; over the scale.
  double springShare = 1.0;  ///< Of the springs' force, at the end.
  bool isKept = true;        ///< On its side of the wall, linked with its ring (StressScene::isKept).
};

/// Largest residual vibration, about the mean of the last second.
struct RestLimits {
  double handle = 0.0;  ///< rms [m]
  double force = 0.0;   ///< rms [N]
};
/// Of a hand at rest: a tenth of what a good encoder resolves (10 um), and far below what a finger tells.
constexpr RestLimits kAtRest{1e-6, 1e-3};
/// Where the servo's periods vary the bound of stability does, and the stiffness follows it in small steps
/// (PeriodMeter::kPlay): a hand that leans on a wall sinks and rises a little with it. Three steps of an
/// encoder, and less than the least force that a finger tells from none.
constexpr RestLimits kAtRestWhenRough{3e-5, 3e-2};

/// A hand that vibrates by more than this is shaken: ten times what the bound's own steps move it by.
constexpr double kShaken = 3e-4;  // rms [m]
/// Span of the mean that a vibration is about [s]. A hand still on its way, as one that slides off or through, is not
/// shaken: while it speeds up by 0.5 m/s^2 it strays from that mean by 0.2 mm. Shaking comes at 5 Hz and more,
/// of which a third or more is left.
constexpr double kShakeSpan = 0.1;

inline bool isShaken(const PressResult& result) {
  return !(result.shake <= kShaken);
}

inline bool isAtRest(const PressResult& result, const PressOptions& options) {
  const RestLimits& limits = options.isRough ? kAtRestWhenRough : kAtRest;
  return result.handle <= limits.handle && result.force <= limits.force;
}

/// A hand of mass, damping and grip (HeldHand), by whole ticks of the servo in virtual time.
PressResult press(const PressScene& scene, const PressOptions& options);

}  // namespace nearfit::stress
