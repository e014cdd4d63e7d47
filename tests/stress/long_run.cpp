#include "tests/stress/long_run.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <unistd.h>

#include "device/servo/servo_loop.h"
#include "tests/stress/stress_scene.h"
#include "tests/stress/stress_servo.h"

namespace nearfit::stress {
namespace {

constexpr double kCycle = 10.0;  // [s]
constexpr auto kTicksOfCycle = static_cast<std::uint64_t>(kCycle / ServoLoop::kPeriod);

/// From 0 to 1 between two times, smoothly.
double between(double time, double begin, double end) {
  const double t = std::clamp((time - begin) / (end - begin), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// At the same moment of each cycle the same, to the last bit.
RigidTransform handAt(std::uint64_t tickOfCycle, double press) {
  const double time = ServoLoop::kPeriod * static_cast<double>(tickOfCycle);
  const double down = between(time, 0.5, 1.5) - between(time, 8.0, 9.0);
  const double slide = between(time, 2.0, 4.0) - between(time, 9.0, 9.8);
  const double turn = between(time, 4.5, 6.0) - between(time, 9.0, 9.8);
  return {glm::angleAxis(0.5 * turn, glm::dvec3(0.0, 0.0, 1.0)),
          {0.05 * slide, 0.0, 0.5 * kCubeSide + 0.01 - press * down}};
}

std::int64_t residentBytes() {
  std::ifstream file("/proc/self/statm");
  std::int64_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

/// What each cycle is compared by.
struct Moment {
  RigidTransform part;
  glm::dvec3 force{0.0};
};

class LongRun {
 public:
  explicit LongRun(StressMode mode)
      : press_(mode == StressMode::Proxy ? kPress : kSpringPress),
        scene_(cubeOverFloor(handAt(0, press_), kLongMargin)),
        servo_(scene_.scene, parameters(mode), 1) {}

  LongRunResult run(std::uint64_t ticks) {
    const std::uint64_t late = ticks - ticks / 10;
    for (result_.ticks = 0; result_.ticks < ticks; ++result_.ticks) {
      const std::uint64_t ofCycle = result_.ticks % kTicksOfCycle;
      const ServoSnapshot& s = servo_.tick({.pose = handAt(ofCycle, press_)}, ServoLoop::kPeriod);
      // Free and at rest at the beginning, pressed and at rest before it is lifted.
      if (ofCycle == kTicksOfCycle / 25)
        result_.freeDrift =
            std::max(result_.freeDrift, glm::distance(s.proxy.translation, s.handle.translation));
      if (ofCycle == kTicksOfCycle * 3 / 4) compare(s, result_.ticks >= late);
      if (ofCycle == kTicksOfCycle - 1) endCycle(s);
    }
    result_.memoryGrowth = result_.cycles > 2 ? residentBytes() - residentBefore_ : 0;
    return result_;
  }

 private:
  static ServoParameters parameters(StressMode mode) {
    ServoParameters parameters;
    parameters.haptics.proxy.margin = kLongMargin;
    parameters.haptics.springs.cutoff = 2e-3;
    setMode(parameters.haptics, mode, SpringParameters{}.stiffness);
    return parameters;
  }

  void compare(const ServoSnapshot& s, bool isLate) {
    if (!first_) first_ = {s.proxy, s.wrench.force};
    const double radius = scene_.scene->metric.radius;
    const double drift = glm::distance(s.proxy.translation, first_->part.translation) +
                         radius * glm::length(turnBetween(first_->part.rotation, s.proxy.rotation));
    result_.contactDrift = std::max(result_.contactDrift, drift);
    if (isLate) result_.lateDrift = std::max(result_.lateDrift, drift);
    result_.forceDrift = std::max(result_.forceDrift, glm::distance(s.wrench.force, first_->force));
  }

  void endCycle(const ServoSnapshot& s) {
    const double given = s.energyToHand - energyBefore_;
    energyBefore_ = s.energyToHand;
    ++result_.cycles;
    if (result_.cycles != 2) {
      result_.energyDrift = std::abs(given - energyOfCycle_);
      return;
    }
    energyOfCycle_ = given;
    residentBefore_ = residentBytes();
  }

  /// From a centimetre above the floor: 3 mm into it, and to 0.5 mm above it [m].
  static constexpr double kPress = 0.013, kSpringPress = 0.0095;

  const double press_;
  const StressScene scene_;
  StressServo servo_;
  LongRunResult result_;
  std::optional<Moment> first_;
  double energyBefore_ = 0.0, energyOfCycle_ = 0.0;
  std::int64_t residentBefore_ = 0;
};

}  // namespace

LongRunResult runLong(double seconds, StressMode mode) {
  return LongRun(mode).run(static_cast<std::uint64_t>(std::llround(seconds / ServoLoop::kPeriod)));
}

}  // namespace nearfit::stress
