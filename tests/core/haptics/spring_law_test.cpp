#include "core/haptics/spring_law.h"

#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace nearfit::spring_law_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Lmd lmdAt(const glm::dvec3& partPoint, const glm::dvec3& direction, double distance) {
  Lmd lmd;
  lmd.partPoint = partPoint;
  lmd.scenePoint = partPoint - distance * direction;
  lmd.direction = direction;
  lmd.distance = distance;
  return lmd;
}

void expectNear(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance = 1e-12) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

Wrench wrenchOf(const std::vector<Lmd>& lmds, const SpringParameters& parameters,
                const glm::dvec3& centre = {}, const Twist& twist = {}) {
  return springWrench(lmds, parameters, centre, twist);
}

const SpringParameters kUndamped{
    .cutoff = 0.01, .stiffness = 200.0, .damping = 0.0, .law = SpringLaw::Linear};

TEST(SpringLaw, LinearSpringPushesByItsCompression) {
  // 200 N/m * (10 mm - 4 mm) = 1.2 N along +z; arm (0.1, 0, 0) x (0, 0, 1.2) = (0, -0.12, 0).
  const Wrench w = wrenchOf({lmdAt({0.1, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.004)}, kUndamped);
  expectNear(w.force, {0.0, 0.0, 1.2});
  expectNear(w.torque, {0.0, -0.12, 0.0});
}

TEST(SpringLaw, MergedAndBlockedMinimaDoNotPush) {
  std::vector<Lmd> lmds(3, lmdAt({0.1, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.004));
  lmds[0].isMerged = true;
  lmds[2].isBlocked = true;
  expectNear(wrenchOf(lmds, kUndamped).force, {0.0, 0.0, 1.2});
}

TEST(SpringLaw, PrintedLawFallsToZeroAtContactAndAtTheCutoff) {
  SpringParameters printed{.cutoff = 0.01, .stiffness = 5e4, .damping = 0.0, .law = SpringLaw::Printed};
  const auto push = [&](double d) {
    return wrenchOf({lmdAt({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, d)}, printed).force.x;
  };
  // 5e4 * (0.01 - 0.004) * 0.004 = 1.2; largest at half the cutoff: 5e4 * 0.005^2 = 1.25.
  EXPECT_NEAR(push(0.004), 1.2, 1e-12);
  EXPECT_NEAR(push(0.005), 1.25, 1e-12);
  EXPECT_NEAR(push(1e-9), 5e4 * 0.01 * 1e-9, 1e-10);
  EXPECT_EQ(push(0.01), 0.0);
}

TEST(SpringLaw, MinimaAtTheCutoffOrBeyondGiveNothingEvenWhenApproaching) {
  SpringParameters p = kUndamped;
  p.damping = 10.0;
  const Twist approaching{{0.0, 0.0, -1.0}, {}};
  for (const double distance : {0.01, 0.02}) {
    const Wrench w = wrenchOf({lmdAt({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, distance)}, p, {}, approaching);
    expectNear(w.force, {0.0, 0.0, 0.0}, 0.0);
    expectNear(w.torque, {0.0, 0.0, 0.0}, 0.0);
  }
}

TEST(SpringLaw, NoMinimaGiveNoWrench) {
  const Wrench w = wrenchOf({}, kUndamped, {1.0, 2.0, 3.0}, {{4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}});
  expectNear(w.force, {0.0, 0.0, 0.0}, 0.0);
  expectNear(w.torque, {0.0, 0.0, 0.0}, 0.0);
}

TEST(SpringLaw, WrenchesOfSeveralMinimaAddUp) {
  // 0.4 N and 1.6 N upward at x = 1 and x = -1: sum 2 N, torque about y of -0.4 + 1.6.
  const Wrench w = wrenchOf(
      {lmdAt({1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.008), lmdAt({-1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.002)},
      kUndamped);
  expectNear(w.force, {0.0, 0.0, 2.0});
  expectNear(w.torque, {0.0, 1.2, 0.0});
}

TEST(SpringLaw, TorqueAboutAnotherPointDiffersByTheMomentOfTheForce) {
  const std::vector<Lmd> lmds{lmdAt({0.3, -0.2, 0.5}, glm::normalize(glm::dvec3(1.0, 2.0, -2.0)), 0.003),
                              lmdAt({-0.1, 0.4, 0.2}, glm::normalize(glm::dvec3(-3.0, 0.5, 1.0)), 0.007)};
  const glm::dvec3 a(0.05, 0.1, -0.2), b(-1.0, 2.0, 0.7);
  const Wrench aboutA = wrenchOf(lmds, kUndamped, a), aboutB = wrenchOf(lmds, kUndamped, b);
  expectNear(aboutB.force, aboutA.force);
  expectNear(aboutB.torque, aboutA.torque + glm::cross(a - b, aboutA.force));
}

TEST(SpringLaw, DampingActsOnTheVelocityOfTheTouchingPointAlongTheDirection) {
  SpringParameters p = kUndamped;
  p.damping = 5.0;
  // Point velocity: linear (0.3, 0, -0.04) + angular (0, 2, 0) x arm (0.1, 0, 0) = (0, 0, -0.2): along u
  // -0.24. Push: 200 * 0.006 + 5 * 0.24 = 2.4 N. Sliding along x is not damped.
  const Wrench w =
      wrenchOf({lmdAt({0.1, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.004)}, p, {}, {{0.3, 0.0, -0.04}, {0.0, 2.0, 0.0}});
  expectNear(w.force, {0.0, 0.0, 2.4});
  expectNear(w.torque, {0.0, -0.24, 0.0});
}

TEST(SpringLaw, DampingNeverPullsAndOneMinimumDoesNotBorrowFromAnother) {
  SpringParameters p = kUndamped;
  p.damping = 100.0;
  // Leaving the first wall at 1 m/s (spring 1.2 N against damper 100 N: nothing left) while approaching the
  // other (0.4 N + 100 N).
  const Wrench w = wrenchOf(
      {lmdAt({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.004), lmdAt({0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, 0.008)}, p,
      {}, {{0.0, 0.0, 1.0}, {}});
  expectNear(w.force, {0.0, 0.0, -100.4});
}

TEST(SpringLaw, BlockedMinimaGiveNothing) {
  Lmd blocked = lmdAt({1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.002);
  blocked.isBlocked = true;
  const Wrench w = wrenchOf({lmdAt({0.1, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.004), blocked}, kUndamped);
  expectNear(w.force, {0.0, 0.0, 1.2});
  expectNear(w.torque, {0.0, -0.12, 0.0});
}

TEST(SpringLaw, NotANumberInAnyInputShowsInTheWrench) {
  const auto isVisible = [](const Wrench& w) {
    return std::isnan(w.force.x + w.force.y + w.force.z + w.torque.x + w.torque.y + w.torque.z);
  };
  SpringParameters damped = kUndamped;
  damped.damping = 1.0;
  const Lmd good = lmdAt({0.1, 0.0, 0.0}, {0.0, 0.0, 1.0}, 0.004);
  Lmd bad = good;
  bad.distance = kNan;
  EXPECT_TRUE(isVisible(wrenchOf({good, bad}, kUndamped)));
  bad = good;
  bad.direction.z = kNan;
  EXPECT_TRUE(isVisible(wrenchOf({bad}, kUndamped)));
  bad = good;
  bad.partPoint.y = kNan;
  EXPECT_TRUE(isVisible(wrenchOf({bad}, kUndamped)));
  SpringParameters p = kUndamped;
  p.stiffness = kNan;
  EXPECT_TRUE(isVisible(wrenchOf({good}, p)));
  p = kUndamped;
  p.cutoff = kNan;
  EXPECT_TRUE(isVisible(wrenchOf({good}, p)));
  EXPECT_TRUE(isVisible(wrenchOf({good}, damped, {kNan, 0.0, 0.0})));
  EXPECT_TRUE(isVisible(wrenchOf({good}, damped, {}, {{0.0, 0.0, kNan}, {}})));
}

}  // namespace
}  // namespace nearfit::spring_law_test
