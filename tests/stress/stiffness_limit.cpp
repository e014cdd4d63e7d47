#include "tests/stress/stiffness_limit.h"

#include <algorithm>
#include <cmath>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "core/haptics/period_meter.h"
#include "core/haptics/virtual_coupling.h"
#include "core/servo/servo_tick.h"
#include "tests/stress/stress_scene.h"
#include "tests/stress/stress_servo.h"
#include "tests/support/simulated_hand.h"

namespace nearfit::stress {
namespace {

/// So small that the proxy's resting place, known to a thousandth of it, is a wall.
constexpr double kWallMargin = 1e-6;
constexpr double kPush = 2.0;    ///< The device is leant on with this [N].
constexpr double kNudge = 0.05;  ///< Of the depth, and of its velocity: the device stays in contact.
constexpr double kPrecision = 0.01;
constexpr double kNoLimit = 1e9;  ///< Of force and slew.

double knownPeriod(double period) {
  return std::max(period, PeriodMeter{}.nominal());
}

/// How a device leans: below where the force begins [m], and on which springs.
struct Stance {
  double depth = 0.0, cutoff = 0.0;
  double springStiffness = 0.0;  ///< As SpringParameters has it for the law.
};

/// @param stiffness  Slope of the force where the device leans [N/m].
Stance stanceOf(StressMode mode, double stiffness) {
  const double depth = kPush / stiffness;
  switch (mode) {
    case StressMode::Proxy:
      return {depth, 1e-3, SpringParameters{}.stiffness};
    case StressMode::Spring:
    case StressMode::Grouped:
      return {depth, 2.0 * depth, stiffness};
    case StressMode::Printed:
      break;
  }
  // At three quarters of the cutoff c the law k (c - d) d has a slope of k c / 2, and a force of 3/16 k c^2.
  const double cutoff = 8.0 / 3.0 * depth;
  return {0.25 * cutoff, cutoff, 2.0 * stiffness / cutoff};
}

ServoParameters parametersFor(const LeaningDevice& device, double stiffness) {
  ServoParameters parameters;
  HapticSettings& settings = parameters.haptics;
  settings.proxy.margin = kWallMargin;
  const Stance stance = stanceOf(device.mode, stiffness);
  settings.springs.cutoff = stance.cutoff;
  setMode(settings, device.mode, stiffness);
  settings.springs.stiffness = stance.springStiffness;
  settings.springs.damping = device.couplingDamping;
  settings.coupling = {.isAutomatic = false, .stiffness = stiffness, .damping = device.couplingDamping};
  DeviceLimits& limits = parameters.limits;
  // A little more than the bound asks for, and twice the rendered damping at least. The printed law asks for twice its
  // slope here.
  constexpr double kMore = 1.001;
  const double counted = device.mode == StressMode::Printed ? 2.0 * stiffness : stiffness;
  limits.damping = std::max(kMore * (0.5 * counted * knownPeriod(device.period) + device.couplingDamping),
                            2.0 * kMore * device.couplingDamping);
  limits.maxForce = limits.forceSlew = kNoLimit;
  return parameters;
}

/// The device over the floor, one tick after the other.
class Leaning {
 public:
  Leaning(const LeaningDevice& device, double stiffness)
      : device_(device),
        depth_(stanceOf(device.mode, stiffness).depth),
        atRest_(0.5 * kCubeSide +
                (device.mode == StressMode::Proxy ? kWallMargin : stanceOf(device.mode, stiffness).cutoff)),
        servo_(scene().scene, parametersFor(device, stiffness), 1),
        hand_(device.mass, device.damping, 0.0, 0.0) {
    // Led down, until the ramp is over and the period known.
    const int ticks = static_cast<int>(std::ceil(0.4 / device.period)) + 100;
    for (int i = 0; i < ticks; ++i)
      servo_.tick(at(atRest_ - depth_ * std::min(1.0, 2.0 * i / ticks)), device.period);
    const double nudge = kNudge * depth_ * std::sqrt(stiffness / device.mass);
    hand_ = test::SimulatedHand(device.mass, device.damping, 0.0, nudge);
  }

  /// The largest motion, as depth and as velocity both, over so many ticks [m].
  double largest(int ticks, double stiffness) {
    double most = 0.0;
    for (int i = 0; i < ticks && most < depth_; ++i) {
      const double force = servo_.snapshot().wrench.force.z - kPush;
      hand_.step(force, device_.period);
      servo_.tick(at(atRest_ - depth_ + hand_.position()), device_.period);
      const double velocity = hand_.velocity() * std::sqrt(device_.mass / stiffness);
      most = std::max(most, std::hypot(hand_.position(), velocity));
    }
    return most;
  }

 private:
  static const StressScene& scene() {
    static const StressScene made = cubeOverFloor(placedAt({0.0, 0.0, 0.5 * kCubeSide + 1e-3}), kWallMargin);
    return made;
  }
  static HandleInput at(double height) { return {.pose = {{1.0, 0.0, 0.0, 0.0}, {0.0, 0.0, height}}}; }

  const LeaningDevice device_;
  const double depth_;   ///< [m]
  const double atRest_;  ///< Height of the cube's centre where the force begins [m].
  StressServo servo_;
  test::SimulatedHand hand_;
};

/// What a device does freely from tick to tick, as exactLimit() has it.
struct HeldForce {
  explicit HeldForce(const LeaningDevice& d)
      : tau(d.mass / d.damping),
        gone(-std::expm1(-d.period / tau)),
        shift((d.period - tau * gone) / d.damping),
        push(gone / d.damping) {}
  double tau, gone;    ///< [s], and 1 - a.
  double shift, push;  ///< c1 and c2.
};

/// The map of (x, v, x before, smoothed velocity before) over a tick; transposed, which has the same
/// eigenvalues.
glm::dmat4 mapOfTick(const LeaningDevice& d, double stiffness) {
  const HeldForce held(d);
  const double share = d.period / (ServoTick::kVelocityTimeConstant + d.period);
  const glm::dvec4 velocity(share / d.period, 0.0, -share / d.period, 1.0 - share);
  const glm::dvec4 force = glm::dvec4(-stiffness, 0.0, 0.0, 0.0) - d.couplingDamping * velocity;
  return {glm::dvec4(1.0, held.tau * held.gone, 0.0, 0.0) + held.shift * force,
          glm::dvec4(0.0, 1.0 - held.gone, 0.0, 0.0) + held.push * force, glm::dvec4(1.0, 0.0, 0.0, 0.0),
          velocity};
}

double largestEntry(const glm::dmat4& m) {
  double largest = 0.0;
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row)
      largest = std::max(largest, std::abs(m[column][row]));
  }
  return largest;
}

/// Logarithm of the largest modulus of the eigenvalues: what high powers grow by.
double growthOf(glm::dmat4 map) {
  constexpr int kSquarings = 30;
  double growth = 0.0, share = 1.0;
  for (int i = 0; i < kSquarings; ++i) {
    const double largest = largestEntry(map);
    growth += share * std::log(largest);
    map /= largest;
    map = map * map;
    share *= 0.5;
  }
  return growth + share * std::log(largestEntry(map));
}

/// The stiffness up to which a device is calm, from well below it on, to a fraction.
template <class IsCalm>
double limitOf(const LeaningDevice& device, double precision, IsCalm&& isCalmAt) {
  double calm = 0.2 * enforcedBound(device), shaken = 2.0 * calm;
  while (isCalmAt(shaken)) {
    calm = shaken;
    shaken *= 2.0;
  }
  while (shaken > (1.0 + precision) * calm) {
    const double middle = std::sqrt(calm * shaken);
    (isCalmAt(middle) ? calm : shaken) = middle;
  }
  return std::sqrt(calm * shaken);
}

}  // namespace

bool isCalm(const LeaningDevice& device, double stiffness) {
  Leaning leaning(device, stiffness);
  // Off the limit by the precision, the motion changes by half of it times T b / m a tick: long enough that
  // it shows beside the sampling of its peaks.
  const double rate = device.period * device.damping / device.mass;
  const double quarterCycle = 1.6 / std::min(1.0, device.period * std::sqrt(stiffness / device.mass));
  const int window = std::clamp(static_cast<int>(2.0 / rate), 4 * static_cast<int>(quarterCycle), 4000);
  const double early = leaning.largest(window, stiffness);
  leaning.largest(2 * window, stiffness);
  return leaning.largest(window, stiffness) < early;
}

double simulatedLimit(const LeaningDevice& device) {
  return limitOf(device, kPrecision, [&](double stiffness) { return isCalm(device, stiffness); });
}

double exactLimit(const LeaningDevice& device) {
  if (device.couplingDamping == 0.0) {
    const HeldForce held(device);
    return device.damping * held.gone / (held.tau * held.gone - (1.0 - held.gone) * device.period);
  }
  constexpr double kExact = 1e-9;
  return limitOf(device, kExact,
                 [&](double stiffness) { return growthOf(mapOfTick(device, stiffness)) < 0.0; });
}

double enforcedBound(const LeaningDevice& device) {
  const double bound = stiffnessBound(device.damping, device.couplingDamping, knownPeriod(device.period));
  return device.mode == StressMode::Printed ? 0.5 * bound : bound;
}

}  // namespace nearfit::stress
