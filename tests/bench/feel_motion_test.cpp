#include "tests/bench/feel_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/haptics/virtual_coupling.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::bench::feel_motion_test {
namespace {

constexpr double kTick = 1e-3;

PressingMotion allOfIt() {
  PressingMotion motion;
  motion.start = {glm::angleAxis(0.4, glm::normalize(glm::dvec3(1.0, 2.0, 3.0))), {0.1, 0.2, 0.3}};
  motion.centreInPart = {0.01, 0.02, 0.03};
  motion.press = 2e-3;
  motion.swing = 1.0;
  motion.slide = 3e-3;
  motion.turn = 0.3;
  motion.tilt = 0.02;
  return motion;
}

TEST(HandAt, BeginsAtTheStartAndAtRest) {
  const PressingMotion motion = allOfIt();
  const RigidTransform first = handAt(motion, 0.0), next = handAt(motion, kTick);
  EXPECT_LT(glm::distance(first.translation, motion.start.translation), 1e-15);
  EXPECT_LT(glm::length(turnBetween(first.rotation, motion.start.rotation)), 1e-15);
  EXPECT_LT(glm::distance(first.translation, next.translation), 1e-9);
}

TEST(HandAt, PressesAsFarAsItSaysAroundTheAxis) {
  PressingMotion motion;
  motion.axis = {0.0, 1.0, 0.0};
  motion.towards = {0.0, 0.0, 1.0};
  motion.press = 2e-3;
  motion.swing = std::numbers::pi;
  double least = 1.0, most = -1.0;
  for (double time = kApproachTime; time < 12.0; time += 0.01) {
    const glm::dvec3 shift = handAt(motion, time).translation;
    EXPECT_NEAR(glm::length(shift), motion.press, 1e-15);
    EXPECT_EQ(shift.y, 0.0);
    const double angle = std::atan2(shift.x, shift.z);
    least = std::min(least, angle);
    most = std::max(most, angle);
  }
  EXPECT_LT(least, -3.1);
  EXPECT_GT(most, 3.1);
}

TEST(HandAt, AThreadLeadsTheTurn) {
  PressingMotion motion;
  motion.turn = 2.0;
  motion.lead = 3e-4;
  for (double time = kApproachTime; time < 10.0; time += 0.37) {
    const RigidTransform pose = handAt(motion, time);
    const double turn = turnBetween(motion.start.rotation, pose.rotation).z;
    EXPECT_NEAR(pose.translation.z, motion.lead * turn, 1e-15);
  }
}

TEST(HandAt, AFinerTickIsASmallerStepEverywhere) {
  const PressingMotion motion = allOfIt();
  for (double time = 0.0; time < 10.0; time += 0.05) {
    const auto place = [&](double t) { return handAt(motion, t).translation; };
    const double whole = glm::distance(place(time), place(time + kTick));
    const double tenth = glm::distance(place(time), place(time + 0.1 * kTick));
    // The acceleration bounds how much a tenth of the way can differ from a tenth of the step.
    EXPECT_NEAR(tenth, 0.1 * whole, 1e-7) << time;
  }
}

/// Two spheres of radius 0.5: their distance is known.
PreparedScene spheres() {
  const TriangleMesh sphere = test::icosphereMesh(0.5, 3);
  return PreparedScene({"spheres", sphere, sphere, std::nullopt, std::nullopt}, 0.05);
}

TEST(SeekingPath, BeginsFreeAndThenPressesTheWholeTime) {
  const PreparedScene scene = spheres();
  SeekingPathOptions options;
  options.ticks = 1500;
  options.press = 0.02;
  const std::vector<RigidTransform> path = seekingPath(scene, options);
  ASSERT_EQ(path.size(), options.ticks);
  EXPECT_GT(glm::length(path.front().translation), 1.0);
  std::size_t pressed = 0;
  // The smoothing has settled after some of its time constants.
  for (std::size_t i = 400; i < path.size(); ++i) {
    const double depth = 1.0 - glm::length(path[i].translation);
    pressed += depth > 0.5 * options.press ? 1 : 0;
    // What the smoothing is behind by, on the way there and in the displacement.
    EXPECT_LT(depth, options.press + 2.0 * options.speed * kSmoothing);
  }
  EXPECT_GT(pressed, 1000U);
}

TEST(SeekingPath, GoesAtTheSpeedItIsTold) {
  const PreparedScene scene = spheres();
  SeekingPathOptions options;
  options.ticks = 1000;
  for (const double speed : {0.05, 0.2}) {
    options.speed = speed;
    const std::vector<RigidTransform> path = seekingPath(scene, options);
    double way = 0.0;
    for (std::size_t i = 401; i < path.size(); ++i)
      way += glm::distance(path[i - 1].translation, path[i].translation);
    const double mean = way / (static_cast<double>(path.size() - 401) * kTick);
    EXPECT_GT(mean, 0.5 * speed);
    EXPECT_LT(mean, 1.5 * speed);
  }
}

}  // namespace
}  // namespace nearfit::bench::feel_motion_test
