#include "tests/stress/press_trial.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/haptics/virtual_coupling.h"
#include "tests/bench/portable_random.h"
#include "tests/stress/held_hand.h"
#include "tests/stress/stress_servo.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::stress {
namespace {

constexpr double kWindow = 1.0;  ///< At the end [s].
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

ServoParameters parametersOf(const PressScene& scene, const PressOptions& options) {
  ServoParameters parameters;
  HapticSettings& settings = parameters.haptics;
  settings.proxy = {.margin = scene.scene.margin, .friction = options.friction};
  settings.springs.cutoff = scene.scene.cutoff;
  settings.mapping.scale = scene.scale;
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

/// The wanted pose as a device has it that was in its origin when the servo began, the part's centre in hand.
RigidTransform onDevice(const PressScene& scene) {
  const RigidTransform& start = scene.scene.scene->moving.worldFromPart;
  const glm::dvec3& centre = scene.scene.scene->centreInPart;
  return {glm::normalize(scene.wanted.rotation * glm::conjugate(start.rotation)),
          (scene.wanted.applyToPoint(centre) - start.applyToPoint(centre)) / scene.scale};
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
          named("closed-box", {0.03, 0.04, 0.05}, tilt)};
}

PressResult press(const PressScene& scene, const PressOptions& options) {
  const ServoScene& servoScene = *scene.scene.scene;
  std::mt19937_64 random(options.seed);
  StressServo servo(scene.scene.scene, parametersOf(scene, options), options.seed);
  servo.setArrival(Arrival::Usual);
  const RigidTransform wanted = onDevice(scene);
  HeldHand hand({}, glm::dvec3(0.0), {});
  Spread places, turns, forces, torques;
  double time = 0.0;
  Wrench held;
  for (bool isFirst = true; time < options.seconds; isFirst = false) {
    double period = options.period;
    if (options.isRough) {
      period *= 1.0 + kJitter * (2.0 * bench::uniform(random) - 1.0);
      if (bench::uniform(random) < kLost) period += options.period;
    }
    if (!isFirst) hand.step(wanted, held, period);
    const ServoSnapshot& s = servo.tick({.pose = hand.pose(), .hasOwnFrame = true}, period);
    held = s.deviceWrench;
    time += period;
    if (time < options.seconds - kWindow) continue;
    places.add(hand.centre());
    turns.add(turnBetween(servoScene.moving.worldFromPart.rotation, s.handle.rotation));
    forces.add(held.force);
    torques.add(held.torque);
  }
  const double radius = servoScene.metric.radius / scene.scale;
  return {std::hypot(places.rms(), radius * turns.rms()),
          forces.rms(),
          torques.rms(),
          servo.snapshot().coupling.stiffness * scene.scale,
          glm::length(forces.mean()),
          !scene.scene.isKept || scene.scene.isKept(servo.snapshot().proxy)};
}

}  // namespace nearfit::stress
