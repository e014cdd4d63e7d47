#include "tests/stress/press_trial.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/haptics/spring_bound.h"
#include "core/haptics/virtual_coupling.h"
#include "core/haptics/workspace_mapper.h"
#include "core/haptics/wrench_conditioner.h"
#include "tests/bench/portable_random.h"
#include "tests/stress/held_hand.h"
#include "tests/stress/stress_servo.h"
#include "tests/stress/tick_checks.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::stress {
namespace {

constexpr double kWindow = 1.0;  ///< At the end [s].
/// Springs reach so many margins; where that is less than the lean needs the hand goes through.
constexpr double kSpringReach = 50.0;
/// Springs that wish for all that the device bears: what they may be set to at most, beyond any bound here [N/m].
constexpr double kStiffSpring = 1e6;
/// Springs do not keep a part out: a hand leans on them so lightly that those hold it which a device of 1 N s/m has at 100 Hz.
/// There 2 b / T is 200 N/m, and the printed law of this slope at contact stores 0.8 mJ over the reach of 5 mm [N].
constexpr double kLean = 0.15;
/// It waits until their force has risen, lest it be through before [s].
constexpr double kLeansAfter = 1.25 * WrenchConditioner::kRampTime;
constexpr double kJitter = 1.0 / 3.0, kLost = 0.05;

/// Of vectors, about their mean.
class Spread {
 public:
  void add(const glm::dvec3& v) {
    // About the first, lest the square of a place far off swamps what is looked for.
    if (count_ == 0.0) first_ = v;
    const glm::dvec3 d = v - first_;
    sum_ += d;
    squares_ += glm::dot(d, d);
    count_ += 1.0;
  }
  glm::dvec3 mean() const { return first_ + sum_ / count_; }
  double rms() const {
    const glm::dvec3 mean = sum_ / count_;
    return std::sqrt(std::max(0.0, squares_ / count_ - glm::dot(mean, mean)));
  }

 private:
  glm::dvec3 first_{0.0}, sum_{0.0};
  double squares_ = 0.0, count_ = 0.0;
};

/// Vibration of a hand: its motion about the mean of a span of time around.
class Vibration {
 public:
  /// @param turn  Times a radius [m].
  void add(double time, const glm::dvec3& place, const glm::dvec3& turn) {
    if (samples_.empty()) first_ = place;
    samples_.push_back({time, place - first_, turn});
  }
  double rms(double span) const {
    double squares = 0.0;
    std::size_t counted = 0, begin = 0, end = 0;
    glm::dvec3 place(0.0), turn(0.0);
    for (const Sample& sample : samples_) {
      for (; end < samples_.size() && samples_[end].time <= sample.time + 0.5 * span; ++end) {
        place += samples_[end].place;
        turn += samples_[end].turn;
      }
      for (; samples_[begin].time < sample.time - 0.5 * span; ++begin) {
        place -= samples_[begin].place;
        turn -= samples_[begin].turn;
      }
      // Nearer to an end the mean is of one side, and takes a slow way for a vibration.
      const bool isWhole = sample.time - 0.5 * span >= samples_.front().time &&
                           sample.time + 0.5 * span <= samples_.back().time;
      if (!isWhole) continue;
      const double count = static_cast<double>(end - begin);
      const glm::dvec3 shaken = sample.place - place / count, turned = sample.turn - turn / count;
      squares += glm::dot(shaken, shaken) + glm::dot(turned, turned);
      ++counted;
    }
    return counted > 0 ? std::sqrt(squares / static_cast<double>(counted)) : 0.0;
  }

 private:
  struct Sample {
    double time;  ///< [s]
    glm::dvec3 place, turn;
  };
  std::vector<Sample> samples_;
  glm::dvec3 first_{0.0};
};

ServoParameters parametersOf(const PressScene& scene, const PressOptions& options) {
  ServoParameters parameters;
  HapticSettings& settings = parameters.haptics;
  settings.proxy = {.margin = scene.scene.margin, .friction = options.friction};
  settings.springs.cutoff = scene.scene.cutoff;
  settings.mapping.scale = scene.scale;
  parameters.limits.damping = options.toldDamping > 0.0 ? options.toldDamping : options.damping;
  if (options.mode != StressMode::Proxy) {
    settings.springs.cutoff = kSpringReach * scene.scene.margin;
    setMode(settings, options.mode,
            (options.stiffness > 0.0 ? options.stiffness : kStiffSpring) / scene.scale);
  }
  if (options.stiffness > 0.0) {
    // The handle goes so many times as far under the same force; turns as stiff as the part's metric has
    // them.
    const double stiffness = options.stiffness / scene.scale;
    const glm::dvec3& gyration = scene.scene.scene->metric.gyration;
    const double largest = std::max({gyration.x, gyration.y, gyration.z});
    settings.coupling = {.isAutomatic = false,
                         .stiffness = stiffness,
                         .damping = 0.0,
                         .rotationalStiffness = stiffness * largest * largest,
                         .rotationalDamping = 0.0};
  }
  return parameters;
}

PressScene named(const char* name, const glm::dvec3& shift, const glm::dquat& turn = {1.0, 0.0, 0.0, 0.0},
                 double scale = 1.0) {
  PressScene out{name, chosenScenes(stressScenes({}), {name}).front().make(), {}, scale};
  const RigidTransform& from = out.scene.lure;
  out.wanted = {glm::normalize(turn * from.rotation), from.translation + shift};
  return out;
}

/// Of a scene whose part begins at the lure, where it meets nothing: what has to be threaded is.
PressScene threaded(PressScene scene) {
  auto begun = std::make_shared<ServoScene>(*scene.scene.scene);
  begun->moving.worldFromPart = scene.scene.lure;
  scene.scene.scene = std::move(begun);
  return scene;
}

/// A cube over a floor, with a wall on either side of a corner.
PressScene cubeAt(const char* name, const RigidTransform& wanted) {
  constexpr double kCube = 0.04, kFloor = 0.3, kMargin = 1e-4;
  const TriangleMesh slab = test::boxMesh({kFloor, kFloor, 0.05}, {0.0, 0.0, -0.025});
  const TriangleMesh wall = test::boxMesh({0.05, kFloor, kFloor}, {-0.025 - 0.05, 0.0, 0.0});
  const TriangleMesh other = test::boxMesh({kFloor, 0.05, kFloor}, {0.0, -0.025 - 0.05, 0.0});
  return {name,
          stressScene({{slab}, {wall}, {other}}, test::boxMesh(glm::dvec3(kCube)), placedAt({0.0, 0.0, 0.03}),
                      kMargin),
          wanted};
}

/// An open sheet of quads over a grid, bent: a vertex for each place (u, v) of 0 to 1 each.
template <class Place>
TriangleMesh bentSheet(std::uint32_t alongU, std::uint32_t alongV, Place&& placeAt) {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  for (std::uint32_t v = 0; v <= alongV; ++v) {
    for (std::uint32_t u = 0; u <= alongU; ++u)
      vertices.push_back(placeAt(static_cast<double>(u) / alongU, static_cast<double>(v) / alongV));
  }
  for (std::uint32_t v = 0; v < alongV; ++v) {
    for (std::uint32_t u = 0; u < alongU; ++u) {
      const std::uint32_t corner = v * (alongU + 1) + u, above = corner + alongU + 1;
      triangles.push_back({corner, corner + 1, above + 1});
      triangles.push_back({corner, above + 1, above});
    }
  }
  return {std::move(vertices), std::move(triangles)};
}

/// A cup, a sheet with a rim, in a coil, a ribbon wound three times around: as a teapot in a spring, neither closed.
PressScene cupInCoil() {
  constexpr double kCoil = 0.03, kPitch = 0.02, kRibbon = 0.004, kCup = 0.025, kDepth = 0.03, kMargin = 1e-4;
  const auto turn = [](double share) { return 2.0 * std::numbers::pi * share; };
  const TriangleMesh coil = bentSheet(96, 2, [&](double u, double v) {
    const double angle = turn(3.0 * u);
    return glm::dvec3(kCoil * std::cos(angle), kCoil * std::sin(angle),
                      3.0 * kPitch * (u - 0.5) + kRibbon * (v - 0.5));
  });
  // A cone's side and no bottom: open at both ends, and along the seam.
  const TriangleMesh cup = bentSheet(24, 4, [&](double u, double v) {
    const double radius = kCup * (0.5 + 0.5 * v);
    return glm::dvec3(radius * std::cos(turn(u)), radius * std::sin(turn(u)), kDepth * (v - 0.5));
  });
  return {"cup-in-coil", stressScene({{coil}}, cup, placedAt({0.0, 0.0, 0.0}), kMargin),
          placedAt({0.012, 0.004, 0.002}, glm::angleAxis(0.1, glm::dvec3(0.0, 1.0, 0.0)))};
}

/// The wanted pose as a device has it that was in its origin when the servo began, the part's centre in hand.
RigidTransform onDevice(const PressScene& scene) {
  const RigidTransform& start = scene.scene.scene->moving.worldFromPart;
  const glm::dvec3& centre = scene.scene.scene->centreInPart;
  return {glm::normalize(scene.wanted.rotation * glm::conjugate(start.rotation)),
          (scene.wanted.applyToPoint(centre) - start.applyToPoint(centre)) / scene.scale};
}

/// Of the coupling, or of each spring as far as it is rendered [N/m].
double stiffnessInForce(StressServo& servo) {
  const HapticSettings& settings = servo.parameters().haptics;
  if (settings.mode == HapticMode::Proxy) return servo.snapshot().coupling.stiffness;
  return servo.snapshot().springShares.wrench * slopeOf(settings.springs);
}

}  // namespace

std::vector<PressScene> pressScenes() {
  const glm::dquat tilt = glm::angleAxis(0.3, glm::normalize(glm::dvec3(1.0, 2.0, 0.5)));
  const glm::dvec3 pulled(0.03, 0.01, 0.01);
  return {cubeAt("flat", placedAt({0.0, 0.0, 0.01})),
          cubeAt("edge", placedAt({0.01, 0.0, 0.0}, glm::angleAxis(0.6, glm::dvec3(0.0, 1.0, 0.0)))),
          cubeAt("corner", placedAt({-0.04, -0.04, 0.01}, tilt)),
          named("peg-bore", {0.01, 0.005, 0.0}, tilt),
          named("wedge-jam", {0.0, 0.0, -0.01}),
          named("slot-1um", {0.0, 0.002, 0.01}, tilt),
          named("thin-wall", {-0.045, 0.0, 0.0}, tilt),
          named("thin-wall-inside", {0.01, 0.02, 0.03}, tilt),
          threaded(named("needle-grid", {2e-3, 1e-3, 0.0}, tilt)),
          named("overlapping", {-0.04, -0.045, -0.035}, tilt),
          named("rings", pulled),
          named("tiny", 1e-2 * pulled, {1.0, 0.0, 0.0, 0.0}, 1e-2),
          named("huge", {220.0, 50.0, 50.0}, {1.0, 0.0, 0.0, 0.0}, 1e3),
          named("far", pulled),
          named("far-mesh", pulled),
          named("closed-box", {0.03, 0.04, 0.05}, tilt),
          named("open-sheet", {0.0, 0.0, -0.06}),
          cupInCoil()};
}

PressResult press(const PressScene& scene, const PressOptions& options) {
  const ServoScene& servoScene = *scene.scene.scene;
  std::mt19937_64 random(options.seed);
  StressServo servo(scene.scene.scene, parametersOf(scene, options), options.seed);
  servo.setArrival(Arrival::Usual);
  const RigidTransform wanted = onDevice(scene);
  const bool isOnSprings = options.mode != StressMode::Proxy;
  HandBody body{.damping = options.damping};
  if (isOnSprings) {
    body.strength = kLean;
    body.turnStrength = kLean * servoScene.metric.radius / scene.scale;
  }
  HeldHand hand(body, glm::dvec3(0.0), {});
  EnergyLedger ledger;
  ServoParameters atHandle = servo.parameters();
  atHandle.limits = limitsAtHandle(atHandle.limits, scene.scale);
  const auto before = std::make_unique<ServoSnapshot>();
  double forceStep = 0.0, lag = 0.0;
  Spread places, turns, forces, torques;
  Vibration vibration;
  const double radius = servoScene.metric.radius / scene.scale;
  double time = 0.0;
  Wrench held;
  for (bool isFirst = true; time < options.seconds; isFirst = false) {
    double period = options.period;
    if (options.isRough) {
      period *= 1.0 + kJitter * (2.0 * bench::uniform(random) - 1.0);
      if (bench::uniform(random) < kLost) period += options.period;
    }
    const bool isWaiting = isOnSprings && time < kLeansAfter;
    if (!isFirst) hand.step(isWaiting ? RigidTransform{} : wanted, held, period);
    const ServoSnapshot& s = servo.tick({.pose = hand.pose(), .hasOwnFrame = true}, period);
    held = s.deviceWrench;
    time += period;
    // A force that is ramped in gives what was stretched meanwhile its force.
    if (time < 2.0 * WrenchConditioner::kRampTime) ledger.cut();
    if (!isFirst) ledger.add(servoScene, atHandle, *before, s, period);
    const glm::dvec3 lastForce = before->unclampedWrench.force;
    *before = s;
    if (time < options.seconds - kWindow) continue;
    forceStep = std::max(forceStep, glm::distance(lastForce, s.unclampedWrench.force));
    lag =
        std::max(lag, glm::distance(s.centre, s.handle.applyToPoint(servoScene.centreInPart)) / scene.scale);
    places.add(hand.centre());
    const glm::dvec3 turn = turnBetween(servoScene.moving.worldFromPart.rotation, s.handle.rotation);
    turns.add(turn);
    vibration.add(time, hand.centre(), radius * turn);
    forces.add(held.force);
    torques.add(held.torque);
  }
  return {std::hypot(places.rms(), radius * turns.rms()),
          vibration.rms(kShakeSpan),
          forces.rms(),
          torques.rms(),
          stiffnessInForce(servo) * scene.scale,
          glm::length(forces.mean()),
          forceStep,
          ledger.largestGain(),
          lag,
          servo.snapshot().springShares.wrench,
          !scene.scene.isKept || scene.scene.isKept(servo.snapshot().proxy)};
}

}  // namespace nearfit::stress
