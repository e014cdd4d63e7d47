#include "core/haptics/guidance.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/haptics/virtual_coupling.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/refusal_of.h"

namespace nearfit::guidance_test {
namespace {

using testing::HasSubstr;

/// Peak of 1 N from 10 mm on; faded at 60 mm.
constexpr GuidanceSettings kPull{100.0, 1.0, 0.06};

GuidancePose at(const glm::dvec3& place, const glm::dvec3& turn = glm::dvec3(0.0)) {
  const double angle = glm::length(turn);
  return {place, angle > 0.0 ? glm::angleAxis(angle, turn / angle) : glm::dquat(1, 0, 0, 0)};
}

GuidancePath straightAlongX(std::size_t segments = 4) {
  std::vector<GuidancePose> poses;
  for (std::size_t i = 0; i <= segments; ++i)
    poses.push_back(at({0.1 * static_cast<double>(i), 0.0, 0.0}));
  return {poses, kPull};
}

/// A quarter turn about z in place, then 0.2 m along x while it turns by a radian about x, then 0.1 m along y without a turn.
std::vector<GuidancePose> turningWay() {
  const glm::dquat first = glm::angleAxis(0.5 * std::numbers::pi, glm::dvec3(0, 0, 1)),
                   second = glm::angleAxis(1.0, glm::dvec3(1, 0, 0)) * first;
  return {{glm::dvec3(0.0), {1, 0, 0, 0}},
          {glm::dvec3(0.0), first},
          {{0.2, 0, 0}, second},
          {{0.2, 0.1, 0}, second}};
}

/// The pull once the follower, which looks at some segments a tick, has found its way from the path's begin.
GuidancePull settled(GuidanceFollower& follower, const GuidancePath& path, const GuidanceSettings& settings,
                     const GuidancePose& hand) {
  GuidancePull pull;
  for (int tick = 0; tick < 4; ++tick)
    pull = follower.follow(path, settings, hand);
  return pull;
}

/// Energy of the pull by search: the least distance to thousands of poses of each stretch, whose rotations go on great circles and
/// whose angles are measured as such.
double searchedEnergy(const std::vector<GuidancePose>& way, const GuidanceSettings& settings,
                      const GuidancePose& hand) {
  constexpr int kSamples = 4000;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < way.size(); ++i) {
    for (int k = 0; k <= kSamples; ++k) {
      const double share = static_cast<double>(k) / kSamples;
      const glm::dquat rotation = glm::slerp(way[i - 1].rotation, way[i].rotation, share);
      const double cosine = std::min(1.0, std::abs(glm::dot(rotation, hand.rotation)));
      const double turn = 4.0 * std::sin(0.5 * std::acos(cosine)) * settings.reach / settings.turnReach;
      least = std::min(
          least,
          std::hypot(glm::distance(glm::mix(way[i - 1].place, way[i].place, share), hand.place), turn));
    }
  }
  return guidanceEnergy(settings, least);
}

TEST(Guidance, ForceRisesStaysAndFades) {
  EXPECT_EQ(guidanceForce(kPull, 0.0), 0.0);
  EXPECT_NEAR(guidanceForce(kPull, 0.004), 0.4, 1e-15);
  EXPECT_NEAR(guidanceForce(kPull, 0.01), 1.0, 1e-15);
  EXPECT_NEAR(guidanceForce(kPull, 0.03), 1.0, 1e-15);
  EXPECT_NEAR(guidanceForce(kPull, 0.045), 0.5, 1e-15);
  EXPECT_EQ(guidanceForce(kPull, 0.06), 0.0);
  EXPECT_EQ(guidanceForce(kPull, 1.0), 0.0);
  // Too soft to reach the max force before it fades.
  EXPECT_NEAR(guidanceForce({10.0, 1.0, 0.06}, 0.03), 0.3, 1e-15);
  EXPECT_EQ(guidanceForce({0.0, 1.0, 0.06}, 0.03), 0.0) << "a device that bears no stiffness";
}

TEST(Guidance, EnergyIsTheIntegralOfTheForce) {
  for (const GuidanceSettings& settings : {kPull, GuidanceSettings{10.0, 1.0, 0.06}}) {
    constexpr int kSteps = 20'000;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double step = 0.08 / kSteps;
      sum += step * guidanceForce(settings, (i + 0.5) * step);
      if (i % 1000 == 999) {
        EXPECT_NEAR(guidanceEnergy(settings, (i + 1) * step), sum, 1e-8) << i;
      }
    }
  }
}

TEST(Guidance, PullsAcrossThePathAndNeverAlongIt) {
  const GuidancePath path = straightAlongX();
  GuidanceFollower follower;
  for (const double x : {-0.2, 0.0, 0.05, 0.1, 0.23, 0.4, 0.7}) {
    const GuidancePull pull = follower.follow(path, kPull, at({x, 0.003, -0.004}));
    EXPECT_NEAR(pull.force.x, 0.0, 1e-15) << x;
    EXPECT_NEAR(pull.force.y, -0.3, 1e-12) << x;
    EXPECT_NEAR(pull.force.z, 0.4, 1e-12) << x;
    EXPECT_NEAR(pull.energy, 0.5 * 100.0 * 0.005 * 0.005, 1e-12) << x;
  }
  EXPECT_EQ(follower.follow(path, kPull, at({0.2, 0.0, 0.0})).force, glm::dvec3(0.0)) << "on the path";
  EXPECT_EQ(follower.follow(path, kPull, at({0.2, 0.07, 0.0})).force, glm::dvec3(0.0))
      << "the hand has left it";
}

TEST(Guidance, AClosedWayOfTheHandGainsNothing) {
  // Round a corner of the path, within its reach and out of it.
  const GuidancePath path({at({-0.2, 0, 0}), at({0, 0, 0}), at({0, 0.2, 0})}, kPull);
  GuidanceFollower follower;
  constexpr int kSteps = 40'000;
  double work = 0.0;
  const auto placeAt = [](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kSteps;
    return glm::dvec3(-0.05 + 0.07 * std::cos(angle), 0.05 + 0.07 * std::sin(angle),
                      0.01 * std::sin(3.0 * angle));
  };
  for (int i = 0; i < kSteps; ++i) {
    const glm::dvec3 middle = 0.5 * (placeAt(i) + placeAt(i + 1));
    work += glm::dot(follower.follow(path, kPull, at(middle)).force, placeAt(i + 1) - placeAt(i));
  }
  // Of some 0.1 J that go in and out. Where both segments are as near, a step is uncertain by 1 N times its 11 um.
  EXPECT_NEAR(work, 0.0, 5e-5);
}

TEST(Guidance, FindsAnotherStretchOnceNothingPulls) {
  // There and back, 0.2 m apart, in segments of 1 mm.
  std::vector<GuidancePose> poses;
  for (int i = 0; i <= 1000; ++i)
    poses.push_back(at({0.001 * i, 0.0, 0.0}));
  for (int i = 1000; i >= 0; --i)
    poses.push_back(at({0.001 * i, 0.2, 0.0}));
  const GuidancePath path(poses, kPull);
  GuidanceFollower follower;
  EXPECT_GT(follower.follow(path, kPull, at({0.0, 0.01, 0.0})).force.y, -1.01);
  EXPECT_LT(follower.follow(path, kPull, at({0.0, 0.01, 0.0})).force.y, -0.99);
  // At once on the way back: within a scan of all segments it is pulled there.
  const int ticks = static_cast<int>(path.segments() / GuidanceFollower::kScan) + 2;
  GuidancePull pull;
  for (int i = 0; i < ticks; ++i)
    pull = follower.follow(path, kPull, at({0.5, 0.19, 0.0}));
  EXPECT_NEAR(pull.force.y, 1.0, 1e-9);
}

TEST(Guidance, KeepsWithinWhatADeviceBears) {
  DeviceLimits limits;
  limits.damping = 0.5;
  limits.maxForce = 2.0;
  const GuidanceSettings bounded = boundedGuidance({1000.0, 5.0, 0.02}, limits, 1e-3);
  // Colgate: K <= 2 b / T.
  EXPECT_NEAR(bounded.stiffness, kGuidanceShare * 2.0 * 0.5 / 1e-3, 1e-9);
  EXPECT_NEAR(bounded.maxForce, kGuidanceForceShare * 2.0, 1e-12);
  EXPECT_EQ(boundedGuidance(kPull, limits, 0.0).stiffness, 0.0) << "no period is known";
}

TEST(Guidance, FollowsWithoutAllocating) {
  const GuidancePath path = straightAlongX(5000);
  GuidanceFollower follower;
  test::resetAllocationCount();
  test::startCountingAllocations();
  for (int i = 0; i < 1000; ++i)
    follower.follow(path, kPull, at({0.5 * i, 0.05 * (i % 3), 0.0}, {0.0, 0.0, 0.001 * i}));
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
}

TEST(Guidance, ATorqueTurnsTheHandBackAndFadesAsTheForceDoes) {
  const GuidancePath path = straightAlongX();
  GuidanceFollower follower;
  constexpr double kArm = 0.06;  // A radian counts as the reach.
  const glm::dvec3 axis = glm::normalize(glm::dvec3(1.0, -2.0, 0.5));
  for (const double angle : {0.05, 0.1, 0.3, 0.6, 0.9}) {
    const GuidancePull pull = follower.follow(path, kPull, at({0.2, 0.0, 0.0}, angle * axis));
    // Distance arm * 4 sin(angle / 4), of which the derivative is arm * cos(angle / 4).
    const double expected =
        guidanceForce(kPull, kArm * 4.0 * std::sin(angle / 4.0)) * kArm * std::cos(angle / 4.0);
    EXPECT_NEAR(glm::dot(pull.torque, axis), -expected, 1e-12) << angle;
    EXPECT_NEAR(glm::length(pull.torque), expected, 1e-12) << "it turns about no other axis";
    EXPECT_LE(glm::length(pull.torque), kArm * kPull.maxForce) << angle;
    EXPECT_NEAR(glm::length(pull.force), 0.0, 1e-12) << angle;
  }
  EXPECT_EQ(follower.follow(path, kPull, at({0.2, 0.0, 0.0})).torque, glm::dvec3(0.0)) << "on the path";
  EXPECT_EQ(follower.follow(path, kPull, at({0.2, 0.0, 0.0}, 1.1 * axis)).torque, glm::dvec3(0.0)) << "left";
  EXPECT_EQ(follower.follow(path, kPull, at({0.2, 0.0, 0.0}, 3.1 * axis)).torque, glm::dvec3(0.0))
      << "far off";
  EXPECT_EQ(follower.follow(path, kPull, at({0.2, 0.07, 0.0}, 0.1 * axis)).torque, glm::dvec3(0.0))
      << "aside";
  // Either sign of a quaternion is the same turn.
  GuidancePose hand = at({0.2, 0.0, 0.0}, 0.3 * axis);
  const GuidancePull pull = follower.follow(path, kPull, hand);
  hand.rotation = -hand.rotation;
  EXPECT_EQ(follower.follow(path, kPull, hand).torque, pull.torque);
}

TEST(Guidance, TurnsDoNotCountWhereTheyAreNotGuided) {
  GuidanceSettings settings = kPull;
  settings.turnReach = 0.0;
  const GuidancePath path(turningWay(), settings);
  GuidanceFollower follower;
  const GuidancePull pull = settled(follower, path, settings, at({0.2, 0.05, 0.004}, {2.0, 1.0, 0.0}));
  EXPECT_NEAR(pull.force.z, -0.4, 1e-12);
  EXPECT_EQ(pull.torque, glm::dvec3(0.0));
}

TEST(Guidance, ForceAndTorqueAreTheDerivativeOfTheEnergyThatASearchFinds) {
  const std::vector<GuidancePose> way = turningWay();
  const GuidancePath path(way, kPull);
  // Its last stretch goes straight on.
  std::vector<GuidancePose> searched = way;
  searched.push_back({{0.2, 0.3, 0.0}, way.back().rotation});
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const auto vector = [&](double size) { return size * glm::dvec3(any(random), any(random), any(random)); };
  int pulled = 0;
  for (int round = 0; round < 40; ++round) {
    const std::size_t i = static_cast<std::size_t>(round) % (way.size() - 1);
    const double share = 0.5 + 0.4 * any(random);
    GuidancePose hand{glm::mix(way[i].place, way[i + 1].place, share) + vector(0.02),
                      glm::slerp(way[i].rotation, way[i + 1].rotation, share)};
    hand.rotation = at({}, vector(0.25)).rotation * hand.rotation;
    GuidanceFollower follower;
    const GuidancePull pull = settled(follower, path, kPull, hand);
    // A segment is straight between quaternions, and the search takes steps: a ten thousandth of the reach.
    EXPECT_NEAR(pull.energy, searchedEnergy(searched, kPull, hand), 1e-5) << round;
    constexpr double kStep = 1e-4;
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 step(0.0);
      step[axis] = kStep;
      const auto slope = [&](const GuidancePose& more, const GuidancePose& less) {
        return -(searchedEnergy(searched, kPull, more) - searchedEnergy(searched, kPull, less)) /
               (2.0 * kStep);
      };
      const double force = slope({hand.place + step, hand.rotation}, {hand.place - step, hand.rotation});
      const double torque = slope({hand.place, at({}, step).rotation * hand.rotation},
                                  {hand.place, at({}, -step).rotation * hand.rotation});
      // Of up to 1 N and 0.06 N m.
      EXPECT_NEAR(pull.force[axis], force, 0.02) << round;
      EXPECT_NEAR(pull.torque[axis], torque, 0.0015) << round;
    }
    if (pull.energy > 1e-5) ++pulled;
  }
  EXPECT_GT(pulled, 30);
}

TEST(Guidance, IsContinuousAlongAPathThatTurns) {
  const std::vector<GuidancePose> way = turningWay();
  const GuidancePath path(way, kPull);
  GuidanceFollower follower;
  // Beside the path by 4 mm and 0.1 rad all along it, across its poses, in steps of a 2000th.
  constexpr int kSteps = 2000;
  std::optional<GuidancePull> before;
  for (std::size_t i = 1; i < way.size(); ++i) {
    for (int k = 0; k <= kSteps; ++k) {
      const double share = static_cast<double>(k) / kSteps;
      const glm::dquat on = glm::slerp(way[i - 1].rotation, way[i].rotation, share);
      const GuidancePose hand{glm::mix(way[i - 1].place, way[i].place, share) + glm::dvec3(0.0, 0.0, 0.004),
                              at({}, {0.0, 0.1, 0.0}).rotation * on};
      const GuidancePull pull = follower.follow(path, kPull, hand);
      EXPECT_GT(pull.energy, 0.0);
      if (before) {
        // A step is at most 0.1 mm, or 0.8 mrad, of a spring of 100 N/m and 0.36 N m/rad.
        EXPECT_LT(glm::distance(pull.force, before->force), 0.05) << i << ' ' << k;
        EXPECT_LT(glm::distance(pull.torque, before->torque), 0.005) << i << ' ' << k;
      }
      before = pull;
    }
  }
}

TEST(Guidance, AHandThatTurnsAndMovesInACircleGainsNothing) {
  const GuidancePath path(turningWay(), kPull);
  GuidanceFollower follower;
  constexpr int kSteps = 40'000;
  double work = 0.0, moved = 0.0;
  const auto poseOf = [](double i) {
    const double angle = 2.0 * std::numbers::pi * i / kSteps;
    // About the middle of the stretch that shifts and turns.
    const glm::dquat on = glm::angleAxis(0.5 + 0.3 * std::sin(angle), glm::dvec3(1, 0, 0)) *
                          glm::angleAxis(0.5 * std::numbers::pi, glm::dvec3(0, 0, 1));
    return GuidancePose{{0.1 + 0.03 * std::cos(angle), 0.01 * std::sin(angle), 0.008 * std::cos(2.0 * angle)},
                        at({}, {0.0, 0.15 * std::cos(angle), 0.1 * std::sin(2.0 * angle)}).rotation * on};
  };
  for (int i = 0; i < kSteps; ++i) {
    const GuidancePose from = poseOf(i), to = poseOf(i + 1);
    const GuidancePull pull = follower.follow(path, kPull, poseOf(i + 0.5));
    glm::dquat turn = to.rotation * glm::conjugate(from.rotation);
    if (turn.w < 0.0) turn = -turn;
    const double step = glm::dot(pull.force, to.place - from.place) +
                        glm::dot(pull.torque, 2.0 * glm::dvec3(turn.x, turn.y, turn.z));
    work += step;
    moved += std::abs(step);
  }
  EXPECT_GT(moved, 0.01) << "it goes in and out";
  EXPECT_NEAR(work, 0.0, 1e-5);
}

TEST(Guidance, TorqueKeepsWithinWhatADeviceBears) {
  DeviceLimits limits;
  limits.maxTorque = 0.1;
  const GuidanceSettings wish{100.0, 1.0, 0.02, 1.0};
  // 0.02 m/rad of 1 N are within a quarter of 0.1 N m.
  EXPECT_EQ(boundedGuidance(wish, limits, 1e-3).turnReach, 1.0);
  limits.maxTorque = 0.04;
  const GuidanceSettings weaker = boundedGuidance(wish, limits, 1e-3);
  EXPECT_NEAR(guidanceArm(weaker) * 1.0, kGuidanceForceShare * 0.04, 1e-12);
  EXPECT_GT(weaker.turnReach, 1.0);
  // Too weak for a pull that fades before half a turn; and a device without torque.
  for (const double torque : {0.02, 0.0}) {
    limits.maxTorque = torque;
    EXPECT_EQ(boundedGuidance(wish, limits, 1e-3).turnReach, 0.0) << torque;
  }
  limits.maxTorque = 10.0;
  limits.rotationalDamping = 1e-4;
  const GuidanceSettings softer = boundedGuidance(wish, limits, 1e-3);
  // Colgate: K <= 2 b / T, of which a tenth; a turn has the stiffness times the square of its arm.
  EXPECT_NEAR(100.0 * guidanceArm(softer) * guidanceArm(softer), kGuidanceShare * 2.0 * 1e-4 / 1e-3, 1e-12);
}

TEST(Guidance, RefusesWhatIsNoPathAndNoPull) {
  const auto refusal = [](std::vector<GuidancePose> poses, const GuidanceSettings& settings) {
    return test::refusalOf([&] { GuidancePath(std::move(poses), settings); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal({at({0, 0, 0})}, kPull), HasSubstr("less than two poses"));
  EXPECT_THAT(refusal({at({0, 0, 0}), at({0, 0, 0})}, kPull), HasSubstr("the same"));
  EXPECT_THAT(refusal({at({0, 0, 0}), at({nan, 0, 0})}, kPull), HasSubstr("not finite"));
  EXPECT_THAT(refusal({at({0, 0, 0}), at({1, 0, 0})}, {0.0, 1.0, 0.1}), HasSubstr("stiffness"));
  EXPECT_THAT(refusal({at({0, 0, 0}), at({1, 0, 0})}, {10.0, 50.0, 0.1}), HasSubstr("max force"));
  EXPECT_THAT(refusal({at({0, 0, 0}), at({1, 0, 0})}, {10.0, 1.0, nan}), HasSubstr("reach"));
  EXPECT_THAT(refusal({at({0, 0, 0}), at({1, 0, 0})}, {10.0, 1.0, 0.1, 3.0}), HasSubstr("reach of turns"));
  EXPECT_THAT(refusal({at({0, 0, 0}), {{1, 0, 0}, {2, 0, 0, 0}}}, kPull), HasSubstr("not of unit length"));
}

}  // namespace
}  // namespace nearfit::guidance_test
