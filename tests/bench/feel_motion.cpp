#include "tests/bench/feel_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/math/rotation_vector.h"
#include "core/proximity/query/lmd_query.h"
#include "device/servo/servo_loop.h"
#include "tests/bench/scene_path.h"

namespace nearfit::bench {
namespace {

/// Of the sines [1/s]: a hand's pace, no two in a simple ratio.
constexpr double kSwingRate = 0.41, kSlideRate = 0.53, kTurnRate = 0.47, kTiltRate = 0.37,
                 kTiltRateAside = 0.31;

/// How close to the scene the path stays that the hand presses down from, in cutoffs: near enough that its
/// nearest points are where the part then touches.
constexpr double kPathWithin = 0.2;
/// Of the path: turn a way [rad], in parts of the size. As the query benchmark's.
constexpr double kTurnOfStep = 3.49066;

/// From 0 to 1 with neither speed nor acceleration at the ends.
double smoothStep(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * s * (10.0 + s * (6.0 * s - 15.0));
}

double wave(double rate, double time) {
  return std::sin(2.0 * std::numbers::pi * rate * time);
}

}  // namespace

RigidTransform handAt(const PressingMotion& m, double time) {
  const double begun = smoothStep(time / kApproachTime);
  const glm::dvec3 aside = glm::cross(m.axis, m.towards);
  const double swing = m.swing * wave(kSwingRate, time), turn = m.turn * wave(kTurnRate, time);
  const glm::dvec3 shift = begun * m.press * (std::cos(swing) * m.towards + std::sin(swing) * aside) +
                           begun * (m.slide * wave(kSlideRate, time) + m.lead * turn) * m.axis;
  const glm::dvec3 spin = begun * (turn * m.axis + m.tilt * wave(kTiltRate, time) * aside +
                                   m.tilt * wave(kTiltRateAside, time) * m.towards);
  const glm::dquat rotation = glm::normalize(rotationOf(spin) * m.start.rotation);
  const glm::dvec3 centre = m.start.applyToPoint(m.centreInPart) + shift;
  return {rotation, centre - rotation * m.centreInPart};
}

std::vector<RigidTransform> seekingPath(const PreparedScene& scene, const SeekingPathOptions& options) {
  HandPathOptions walk;
  walk.poses = options.ticks;
  walk.step = options.speed * ServoLoop::kPeriod / scene.size;
  walk.turn = kTurnOfStep * walk.step;
  walk.cutoff = kPathWithin * scene.cutoff;
  walk.seed = options.seed;
  std::vector<RigidTransform> path = makePath(scene, walk);
  LmdScratch scratch;
  glm::dvec3 wanted(0.0), displaced(0.0);
  for (RigidTransform& pose : path) {
    std::array<Lmd, 1> nearest;
    const LmdResult found = findLmds(scene.sceneTree, scene.partTree, pose, scene.cutoff, scratch, nearest);
    if (found.count > 0) wanted = -(nearest[0].distance + options.press) * nearest[0].direction;
    pose.translation += displaced;
    displaced += ServoLoop::kPeriod / kSmoothing * (wanted - displaced);
  }
  return path;
}

}  // namespace nearfit::bench
