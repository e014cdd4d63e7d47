#include "tests/bench/pressed_walk.h"

#include "device/servo/servo_loop.h"
#include "tests/bench/feel_scenes.h"
#include "tests/bench/feel_servo.h"
#include "tests/bench/statistics.h"

namespace nearfit::bench {
namespace {

constexpr double kPressedCutoff = 1e-3;  // [m]

}  // namespace

PressedWalk walkPressed(const PressedParts& parts, std::size_t ticks) {
  PressedWalk walk;
  walk.triangles = parts.scene.triangles().size() + parts.part.triangles().size();
  walk.bodies = solidScene(parts.scene, parts.part, parts.motion.start);
  ServoParameters parameters;
  parameters.haptics.mode = HapticMode::Proxy;
  parameters.haptics.springs.cutoff = kPressedCutoff;
  parameters.haptics.proxy.margin = parts.margin;
  FeelServo servo(walk.bodies, parameters, ListArrival::AtOnce, BenchClock::Thread);
  PressingMotion motion = parts.motion;
  motion.centreInPart = walk.bodies->centreInPart;
  for (std::size_t i = 0; i < ticks; ++i) {
    const RigidTransform hand = handAt(motion, ServoLoop::kPeriod * static_cast<double>(i));
    const ServoSnapshot& snapshot = servo.tick(hand, ServoLoop::kPeriod);
    walk.poses.push_back(snapshot.proxy);
    walk.wrenches.push_back(snapshot.unclampedWrench);
    walk.times.push_back(servo.tickTime());
    walk.held += snapshot.contactCount > 0 ? 1 : 0;
    walk.truncated += snapshot.isStarved || snapshot.isTruncated ? 1 : 0;
  }
  return walk;
}

double p99(const PressedWalk& walk) {
  return SampleSummary(walk.times).percentile(0.99);
}

}  // namespace nearfit::bench
