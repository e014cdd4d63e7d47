#include "tests/bench/feel_sliding.h"

#include <cmath>
#include <memory>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "device/servo/servo_loop.h"
#include "tests/bench/feel_certified.h"
#include "tests/bench/feel_scenes.h"
#include "tests/bench/feel_servo.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench {
namespace {

constexpr double kBox = 0.05, kSpringCutoff = 0.01;
/// The wall is this much longer than the way along it.
constexpr double kBeyondWay = 0.5;
constexpr double kStartGap = 1e-3;
/// The way goes aslant over the wall's triangles.
const glm::dvec3 kAlong = glm::normalize(glm::dvec3(1.0, 0.3, 0.0));

/// A box on z = 0 at the origin, over a wall whose face is there and reaches `length` to all sides.
std::shared_ptr<const ServoScene> boxOnWall(double length, double gap) {
  return solidScene(test::boxMesh({2.0 * length, 2.0 * length, 0.1}, {0.0, 0.0, -0.05}),
                    test::boxMesh(glm::dvec3(kBox), {0.0, 0.0, 0.5 * kBox}),
                    {glm::dquat(1.0, 0.0, 0.0, 0.0), {0.0, 0.0, gap}});
}

FeelServo servoOn(const std::shared_ptr<const ServoScene>& scene, double margin) {
  ServoParameters parameters;
  parameters.haptics.mode = HapticMode::Proxy;
  parameters.haptics.springs.cutoff = kSpringCutoff;
  parameters.haptics.proxy.margin = margin;
  return {scene, parameters, ListArrival::InTime, BenchClock::Thread};
}

}  // namespace

SlidingRun runSliding(double speed, const SlidingOptions& options) {
  const std::size_t rampTicks = static_cast<std::size_t>(std::llround(kApproachTime / ServoLoop::kPeriod));
  const std::size_t ticks =
      rampTicks + static_cast<std::size_t>(std::llround(options.seconds / ServoLoop::kPeriod));
  SlidingRun run;
  run.scene = boxOnWall(speed * (kApproachTime + options.seconds) + kBeyondWay, kStartGap);
  FeelServo servo = servoOn(run.scene, options.margin);
  RigidTransform hand;
  double way = 0.0;
  for (std::size_t i = 0; i < ticks; ++i) {
    const double begun = std::min(1.0, static_cast<double>(i) / static_cast<double>(rampTicks));
    way += begun * speed * ServoLoop::kPeriod;
    hand.translation = way * kAlong;
    hand.translation.z = kStartGap - begun * (kStartGap + options.press);
    const ServoSnapshot& snapshot = servo.tick(hand, ServoLoop::kPeriod);
    run.poses.push_back(snapshot.proxy);
    if (i < rampTicks) continue;
    run.lag.push_back(glm::dot(hand.translation - snapshot.proxy.translation, kAlong));
    run.subSteps.push_back(snapshot.subSteps);
    run.ticksInContact += snapshot.contactCount > 0 ? 1 : 0;
  }
  return run;
}

FreeRun runFree() {
  constexpr double kHeight = 5e-3, kMoving = 2.0, kResting = 1.0;
  const std::shared_ptr<const ServoScene> scene = boxOnWall(kBeyondWay, kHeight);
  FeelServo servo = servoOn(scene, ProxySettings{}.margin);
  PressingMotion motion;
  motion.start = scene->moving.worldFromPart;
  motion.centreInPart = scene->centreInPart;
  motion.slide = 2e-3;
  motion.press = 0.05;
  motion.swing = 1.0;
  motion.turn = 0.5;
  FreeRun run;
  run.scene = scene;
  const auto ticks = static_cast<std::size_t>(std::llround((kMoving + kResting) / ServoLoop::kPeriod));
  for (std::size_t i = 0; i < ticks; ++i) {
    const double time = static_cast<double>(i) * ServoLoop::kPeriod;
    const ServoSnapshot& snapshot = servo.tick(handAt(motion, std::min(time, kMoving)), ServoLoop::kPeriod);
    run.poses.push_back(snapshot.proxy);
    const double felt =
        glm::length(snapshot.unclampedWrench.force) + glm::length(snapshot.unclampedWrench.torque);
    (time <= kMoving + ServoLoop::kPeriod ? run.moving : run.resting).push_back(felt);
  }
  return run;
}

std::vector<FeelRow> slidingRows(const std::vector<double>& speeds, const SlidingOptions& options) {
  std::vector<FeelRow> rows;
  for (const double speed : speeds) {
    const SlidingRun slid = runSliding(speed, options);
    const std::string run = fmt::format("{} m/s", speed);
    rows.push_back(feelRow("sliding", "box-wall", run, "lag [mm]", slid.lag, 1e3));
    rows.push_back(feelRow("sliding", "box-wall", run, "sub-steps", slid.subSteps));
    const double share = static_cast<double>(slid.ticksInContact) / static_cast<double>(slid.lag.size());
    rows.push_back(feelRow("sliding", "box-wall", run, "in contact", std::vector{share}));
    rows.push_back(certifiedRow("sliding", "box-wall", run, *slid.scene, slid.poses));
  }
  const FreeRun free = runFree();
  rows.push_back(feelRow("free", "box-wall", "moving", "force and torque [N+N m]", free.moving));
  rows.push_back(feelRow("free", "box-wall", "at rest", "force and torque [N+N m]", free.resting));
  rows.push_back(certifiedRow("free", "box-wall", "all", *free.scene, free.poses));
  return rows;
}

}  // namespace nearfit::bench
