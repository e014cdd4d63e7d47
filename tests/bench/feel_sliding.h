#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/servo/servo_scene.h"
#include "tests/bench/feel_report.h"

namespace nearfit::bench {

struct SlidingOptions {
  double margin = 5e-5;  ///< [m]
  double press = 1e-3;   ///< Of the hand, into the wall [m].
  double seconds = 1.0;  ///< At full speed.
};

/// What a hand along a wall finds, tick by tick.
struct SlidingRun {
  /// How far the part is behind the hand along the wall, the way that the hand goes in a tick included [m].
  std::vector<double> lag;
  std::vector<double> subSteps;
  std::size_t ticksInContact = 0;
  std::shared_ptr<const ServoScene> scene;
  std::vector<RigidTransform> poses;  ///< Of the part, tick by tick, while it comes up to speed too.
};

/// A box of 5 cm is pressed flat on a wall and drawn along it: up to speed within kApproachTime, then on.
/// @param speed  Of the hand along the wall [m/s].
SlidingRun runSliding(double speed, const SlidingOptions& options);

/// What a hand feels that moves the same box freely above the wall, and then rests.
struct FreeRun {
  std::vector<double> moving, resting;  ///< Size of the force [N] and of the torque [N m], summed.
  std::shared_ptr<const ServoScene> scene;
  std::vector<RigidTransform> poses;  ///< Of the part, tick by tick.
};
FreeRun runFree();

std::vector<FeelRow> slidingRows(const std::vector<double>& speeds, const SlidingOptions& options);

}  // namespace nearfit::bench
