#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/haptics/wrench.h"
#include "core/servo/servo_scene.h"
#include "tests/bench/feel_motion.h"

namespace nearfit::bench {

/// Two meshes, and a hand that presses one against the other and moves it there.
struct PressedParts {
  TriangleMesh scene, part;
  PressingMotion motion;
  double margin = 1e-4;  ///< Of the proxy [m].
};

/// Poses, wrenches and times of the walk, tick by tick.
struct PressedWalk {
  std::size_t triangles = 0;  ///< Of both meshes.
  std::shared_ptr<const ServoScene> bodies;
  std::vector<RigidTransform> poses;  ///< Of the part.
  std::vector<Wrench> wrenches;       ///< On the hand, unclamped.
  std::vector<double> times;          ///< Of the ticks, on the processor [s].
  std::size_t held = 0;               ///< Ticks in contact.
  std::size_t truncated = 0;          ///< Ticks that ran out of lists or of work.
};

/// Walks the hand's motion in the proxy mode at 1 kHz, with a list for each tick as soon as it is due.
PressedWalk walkPressed(const PressedParts& parts, std::size_t ticks);

/// 99th percentile of the ticks' times [s].
double p99(const PressedWalk& walk);

}  // namespace nearfit::bench
