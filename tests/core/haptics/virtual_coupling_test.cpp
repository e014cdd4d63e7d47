#include "core/haptics/virtual_coupling.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/math/rotation_vector.h"
#include "tests/support/random_values.h"

namespace nearfit::virtual_coupling_test {
namespace {

using test::RandomValues;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

MassMetric metricOf(const glm::dvec3& gyration, const glm::dquat& partFromPrincipal = {1, 0, 0, 0}) {
  return {partFromPrincipal, gyration, 2.0 * gyration.z};
}

DeviceLimits deviceWithDamping(double damping, double rotationalDamping) {
  DeviceLimits limits;
  limits.damping = damping;
  limits.rotationalDamping = rotationalDamping;
  return limits;
}

DeviceLimits deviceWithMax(double force, double torque) {
  DeviceLimits limits;
  limits.maxForce = force;
  limits.maxTorque = torque;
  return limits;
}

CouplingSettings wishFor(double stiffness, double damping, double rotationalStiffness,
                         double rotationalDamping) {
  return {false, stiffness, damping, rotationalStiffness, rotationalDamping};
}

TEST(StiffnessBound, IsThatOfColgate) {
  // K = 2 (b - |B|) / T, by hand.
  EXPECT_DOUBLE_EQ(stiffnessBound(1.0, 0.0, 1e-3), 2000.0);
  EXPECT_DOUBLE_EQ(stiffnessBound(2.0, 0.5, 5e-4), 6000.0);
  EXPECT_DOUBLE_EQ(stiffnessBound(2.0, -0.5, 5e-4), 6000.0);
}

TEST(StiffnessBound, IsZeroWhereThereIsNone) {
  EXPECT_EQ(stiffnessBound(1.0, 2.0, 1e-3), 0.0);
  EXPECT_EQ(stiffnessBound(0.0, 0.0, 1e-3), 0.0);
  EXPECT_EQ(stiffnessBound(1.0, 0.0, 0.0), 0.0);
  EXPECT_EQ(stiffnessBound(1.0, 0.0, -1e-3), 0.0);
  for (const double bad : {kNan, kInfinity}) {
    EXPECT_EQ(stiffnessBound(bad, 0.0, 1e-3), 0.0);
    EXPECT_EQ(stiffnessBound(1.0, bad, 1e-3), 0.0);
    EXPECT_EQ(stiffnessBound(1.0, 0.0, bad), 0.0);
  }
  EXPECT_EQ(stiffnessBound(1e300, 0.0, 1e-300), 0.0);
}

TEST(BoundedCoupling, AutomaticIsAStatedPartOfTheBound) {
  // Gyration of 10 mm: the rotation of the metric is far from its own bound.
  const CouplingState c =
      boundedCoupling({}, deviceWithDamping(1.0, 1.0), metricOf({0.005, 0.01, 0.01}), 1e-3);
  const double damping = kAutomaticDampingShare * 1.0;
  EXPECT_DOUBLE_EQ(c.damping, damping);
  EXPECT_DOUBLE_EQ(c.stiffness, kAutomaticStiffnessShare * 2.0 * (1.0 - damping) / 1e-3);
  EXPECT_DOUBLE_EQ(c.rotationalStiffness, c.stiffness * 0.01 * 0.01);
  EXPECT_DOUBLE_EQ(c.rotationalDamping, c.damping * 0.01 * 0.01);
  EXPECT_FALSE(c.isHeldToBound);
}

TEST(BoundedCoupling, AutomaticRotationStaysBelowItsOwnBound) {
  const CouplingState c = boundedCoupling({}, deviceWithDamping(1.0, 1e-3), metricOf({0.1, 0.5, 1.0}), 1e-3);
  EXPECT_DOUBLE_EQ(c.rotationalDamping, kAutomaticDampingShare * 1e-3);
  EXPECT_DOUBLE_EQ(c.rotationalStiffness,
                   kAutomaticStiffnessShare * 2.0 * (1.0 - kAutomaticDampingShare) * 1e-3 / 1e-3);
}

TEST(BoundedCoupling, WishWithinTheBoundIsGranted) {
  const CouplingState c = boundedCoupling(wishFor(900.0, 0.25, 0.5, 2e-4), deviceWithDamping(1.0, 1e-3),
                                          metricOf(glm::dvec3(0.01)), 1e-3);
  EXPECT_EQ(c.stiffness, 900.0);
  EXPECT_EQ(c.damping, 0.25);
  EXPECT_EQ(c.rotationalStiffness, 0.5);
  EXPECT_EQ(c.rotationalDamping, 2e-4);
  EXPECT_FALSE(c.isHeldToBound);
}

TEST(BoundedCoupling, WishBeyondTheBoundIsHeldToItAndSaidToBe) {
  const DeviceLimits device = deviceWithDamping(1.0, 1e-3);
  const MassMetric metric = metricOf(glm::dvec3(0.01));
  const CouplingState stiff = boundedCoupling(wishFor(5000.0, 0.25, 0.5, 0.0), device, metric, 1e-3);
  EXPECT_DOUBLE_EQ(stiff.stiffness, 1500.0);
  EXPECT_TRUE(stiff.isHeldToBound);
  const CouplingState damped = boundedCoupling(wishFor(100.0, 50.0, 0.5, 0.0), device, metric, 1e-3);
  EXPECT_DOUBLE_EQ(damped.damping, kMaxDampingShare * 1.0);
  EXPECT_DOUBLE_EQ(damped.stiffness, 100.0);
  EXPECT_TRUE(damped.isHeldToBound);
  const CouplingState turned = boundedCoupling(wishFor(100.0, 0.0, 9.0, 0.0), device, metric, 1e-3);
  EXPECT_DOUBLE_EQ(turned.rotationalStiffness, 2.0);
  EXPECT_TRUE(turned.isHeldToBound);
}

TEST(BoundedCoupling, SlowerServoMeansSofterCoupling) {
  const DeviceLimits device = deviceWithDamping(1.0, 1e-3);
  const MassMetric metric = metricOf(glm::dvec3(0.01));
  const CouplingState fast = boundedCoupling({}, device, metric, 1e-3);
  const CouplingState slow = boundedCoupling({}, device, metric, 4e-3);
  EXPECT_NEAR(slow.stiffness, fast.stiffness / 4.0, 1e-9);
}

TEST(BoundedCoupling, SenselessNumbersGiveZeroStiffnessAndNeverNan) {
  const double values[] = {kNan, kInfinity, -kInfinity, -1.0, 0.0, 1e-320, 1e-3, 1.0, 1e308};
  for (const double damping : values)
    for (const double period : values)
      for (const double number : values)
        for (const bool isAutomatic : {false, true}) {
          const CouplingSettings wish{isAutomatic, number, number, number, number};
          const CouplingState c = boundedCoupling(wish, deviceWithDamping(damping, damping),
                                                  metricOf(glm::dvec3(number)), period);
          for (const double result : {c.stiffness, c.damping, c.rotationalStiffness, c.rotationalDamping}) {
            EXPECT_TRUE(std::isfinite(result) && result >= 0.0)
                << damping << " " << period << " " << number << " " << isAutomatic;
          }
          if (!(period > 0.0) || !std::isfinite(period)) {
            EXPECT_EQ(c.stiffness, 0.0);
            EXPECT_EQ(c.rotationalStiffness, 0.0);
          }
        }
}

TEST(BoundedCoupling, RandomWishesNeverBreakTheBound) {
  RandomValues random(7);
  for (int i = 0; i < 10'000; ++i) {
    const DeviceLimits device = deviceWithDamping(random.in(0, 3), random.in(0, 0.01));
    CouplingSettings wish = wishFor(random.in(0, 1e4), random.in(0, 3), random.in(0, 20), random.in(0, 0.01));
    wish.isAutomatic = i % 2 == 0;
    const double period = random.in(1e-4, 1e-2);
    const CouplingState c = boundedCoupling(wish, device, metricOf(random.vector(0.1) + 0.11), period);
    // Rounding of the sums allowed for.
    EXPECT_LE(c.stiffness * period / 2.0 + c.damping, device.damping * (1.0 + 1e-12));
    EXPECT_LE(c.rotationalStiffness * period / 2.0 + c.rotationalDamping,
              device.rotationalDamping * (1.0 + 1e-12));
  }
}

const CouplingState kCoupling{1000.0, 2.0, 0.8, 0.004, false};

TEST(CouplingWrench, OnePoseAndTwistIsExactlyNoWrench) {
  RandomValues random(11);
  for (int i = 0; i < 1000; ++i) {
    const BodyMotion both{random.pose(), {random.vector(1.0), random.vector(1.0)}};
    const MassMetric metric = metricOf({0.01, 0.02, 0.03}, rotationOf(random.vector(3.0)));
    const Wrench w = couplingWrench(kCoupling, metric, random.vector(0.3), both, both);
    EXPECT_EQ(w.force, glm::dvec3(0.0));
    EXPECT_EQ(w.torque, glm::dvec3(0.0));
  }
}

TEST(CouplingWrench, SpringPullsTheHandTowardsThePart) {
  const BodyMotion handle{{{1, 0, 0, 0}, {0.5, 0, 0}}, {}}, part{{{1, 0, 0, 0}, {0.5, 0.003, 0}}, {}};
  const Wrench w = couplingWrench(kCoupling, metricOf(glm::dvec3(0.02)), {0.1, 0.2, 0.3}, handle, part);
  EXPECT_NEAR(w.force.y, 3.0, 1e-9);
  EXPECT_NEAR(glm::length(w.force), 3.0, 1e-9);
  EXPECT_EQ(w.torque, glm::dvec3(0.0));
}

TEST(CouplingWrench, DamperDragsTheHandAlong) {
  BodyMotion handle, part;
  handle.twist = {{0.5, 0, 0}, {0, 0, 2}};
  const Wrench w = couplingWrench(kCoupling, metricOf(glm::dvec3(0.02)), {}, handle, part);
  EXPECT_NEAR(glm::distance(w.force, {-1.0, 0, 0}), 0.0, 1e-15);
  EXPECT_NEAR(glm::distance(w.torque, {0, 0, -0.008}), 0.0, 1e-15);
}

TEST(CouplingWrench, TurnAboutTheCentreOfMassIsTorqueAlone) {
  // Turned by 0.1 rad about the centre, which is away from the part's origin.
  const glm::dvec3 centre(0.1, -0.2, 0.3);
  const glm::dquat turn = glm::angleAxis(0.1, glm::dvec3(0, 0, 1));
  const BodyMotion handle, part{{turn, centre - turn * centre}, {}};
  const Wrench w = couplingWrench(kCoupling, metricOf(glm::dvec3(0.02)), centre, handle, part);
  EXPECT_NEAR(glm::length(w.force), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(w.torque, {0, 0, 0.08}), 0.0, 1e-14);
}

TEST(CouplingWrench, TorqueAboutEachPrincipalAxisGoesWithItsGyrationSquared) {
  const glm::dvec3 gyration(0.01, 0.02, 0.04);
  const glm::dquat partFromPrincipal = rotationOf({0.3, -0.8, 1.1}),
                   worldFromPart = rotationOf({1.0, 0.4, -0.2});
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 principal(0.0);
    principal[axis] = 1.0;
    const glm::dvec3 world = worldFromPart * (partFromPrincipal * principal);
    const BodyMotion part{{worldFromPart, {}}, {}};
    const BodyMotion handle{{glm::angleAxis(-0.2, world) * worldFromPart, {}}, {}};
    const Wrench w = couplingWrench(kCoupling, metricOf(gyration, partFromPrincipal), {}, handle, part);
    const double ratio = gyration[axis] / 0.04;
    EXPECT_NEAR(glm::distance(w.torque, 0.8 * ratio * ratio * 0.2 * world), 0.0, 1e-14) << axis;
  }
}

TEST(CouplingWrench, RoundALoopOfLargeTurnsTheHandGainsNothing) {
  // Stiffness times turn is no derivative of an energy where it differs by axis: a hand that went round and
  // round was given energy each time.
  constexpr int kSteps = 20000;
  const MassMetric metric = metricOf({0.005, 0.02, 0.04}, rotationOf({0.3, -0.8, 1.1}));
  const BodyMotion part{{rotationOf({1.0, 0.4, -0.2}), {}}, {}};
  const auto handleAt = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kSteps;
    const glm::dvec3 turn(1.5 * std::cos(angle), 1.2 * std::sin(angle), 0.8 * std::sin(2.0 * angle + 0.5));
    return BodyMotion{{rotationOf(turn) * part.pose.rotation, {}}, {}};
  };
  double work = 0.0, turnover = 0.0;
  glm::dvec3 before = couplingWrench(kCoupling, metric, {}, handleAt(0), part).torque;
  for (int i = 0; i < kSteps; ++i) {
    const glm::dvec3 torque = couplingWrench(kCoupling, metric, {}, handleAt(i + 1), part).torque;
    const glm::dvec3 turn = turnBetween(handleAt(i).pose.rotation, handleAt(i + 1).pose.rotation);
    work += 0.5 * glm::dot(before + torque, turn);
    turnover += std::abs(glm::dot(torque, turn));
    before = torque;
  }
  EXPECT_GT(turnover, 0.1);
  EXPECT_LT(std::abs(work), 1e-6 * turnover);
}

TEST(TurnScale, MakesTheMetricWeighTurnsAsTheCouplingDoes) {
  // 1/2 K s^2 and 1/2 K_r a^2 are one energy where a turn a counts as the length s = sqrt(K_r / K) a.
  const MassMetric metric = metricOf({0.01, 0.02, 0.04});
  EXPECT_DOUBLE_EQ(turnScale({1000.0, 0.0, 1000.0 * 0.04 * 0.04, 0.0}, metric), 1.0);
  EXPECT_DOUBLE_EQ(turnScale({100.0, 0.0, 4.0, 0.0}, metric), std::sqrt(4.0 / 100.0) / 0.04);
  EXPECT_EQ(turnScale({0.0, 0.0, 1.0, 0.0}, metric), 1.0);
  EXPECT_EQ(turnScale({1000.0, 0.0, 0.0, 0.0}, metric), 1.0);
  EXPECT_EQ(turnScale({1e6, 0.0, 1e-6, 0.0}, metric), kMinTurnScale);
  EXPECT_EQ(turnScale({1.0, 0.0, 1e6, 0.0}, metric), kMaxTurnScale);
}

TEST(CouplingWrench, IsSquareToWhatTheMetricCallsFree) {
  // The nearest pose on a constraint, in the metric, leaves a residual that is no motion along it: a wrench
  // consistent with the metric does no work on motions that the contact allows. Contact at r with normal n:
  // the allowed twists are those with n . (v + w x r) = 0; the residual is M^-1 (n, r x n). For small turns:
  // of large ones the derivative of the energy has terms of higher order.
  RandomValues random(13);
  const double k = 1000.0;
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 gyration(0.01, 0.02, 0.03);
    const MassMetric metric = metricOf(gyration, rotationOf(random.vector(3.0)));
    const CouplingState consistent{k, 0.0, k * 0.03 * 0.03, 0.0, false};
    const BodyMotion part{random.pose(), {}};
    const glm::dvec3 n = glm::normalize(random.vector(1.0)), r = random.vector(0.05);
    const glm::dquat worldFromPrincipal = part.pose.rotation * metric.partFromPrincipal;
    const glm::dvec3 moment = glm::conjugate(worldFromPrincipal) * glm::cross(r, n);
    const double depth = 1e-8;
    const glm::dvec3 turn = worldFromPrincipal * (moment / (gyration * gyration)) * depth;
    BodyMotion handle = part;
    handle.pose.rotation = rotationOf(-turn) * part.pose.rotation;
    handle.pose.translation -= depth * n;
    const Wrench w = couplingWrench(consistent, metric, {}, handle, part);
    const glm::dvec3 angular = random.vector(1.0), free = random.vector(0.02);
    const glm::dvec3 linear = free - n * glm::dot(n, free + glm::cross(angular, r));
    const double power = glm::dot(w.force, linear) + glm::dot(w.torque, angular);
    EXPECT_NEAR(power, 0.0, 1e-12 * (glm::length(w.force) + glm::length(w.torque)) + 1e-12);
  }
}

TEST(SteepestTurn, IsWhereTheStoredEnergyFallsFastestAsThePartTurns) {
  RandomValues random(37);
  const glm::dvec3 gyration(0.02, 0.03, 0.04);
  const double k = 1000.0;
  const CouplingState spring{k, 0.0, k * 0.04 * 0.04, 0.0, false};
  const DeviceLimits unlimited = deviceWithMax(1e6, 1e6);
  double farthest = 0.0;
  for (int i = 0; i < 200; ++i) {
    const MassMetric metric = metricOf(gyration, rotationOf(random.vector(3.0)));
    const RigidTransform part = random.pose();
    const glm::dquat worldFromPrincipal = part.rotation * metric.partFromPrincipal;
    const glm::dvec3 turn = random.vector(0.6);  // To the hand, in principal axes.
    const RigidTransform handle{rotationOf(worldFromPrincipal * turn) * part.rotation, part.translation};
    const glm::dvec3 steepest = steepestTurn(turn, gyration);
    farthest = std::max(farthest, glm::distance(steepest, turn) / glm::length(turn));
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double kStep = 1e-5;
      glm::dvec3 principal(0.0);
      principal[axis] = kStep;
      const auto energyAt = [&](double sign) {
        const RigidTransform turned{rotationOf(sign * (worldFromPrincipal * principal)) * part.rotation,
                                    part.translation};
        return storedEnergy(spring, metric, {}, handle, turned, unlimited);
      };
      const double slope = (energyAt(1.0) - energyAt(-1.0)) / (2.0 * kStep);
      const double torque = k * gyration[axis] * gyration[axis] * steepest[axis];
      EXPECT_NEAR(-slope, torque, 1e-7) << i << ", " << axis;
    }
  }
  EXPECT_GT(farthest, 0.1) << "it is not the turn itself";
}

TEST(SteepestTurn, OfASmallTurnOrAboutAPrincipalAxisIsTheTurnItself) {
  const glm::dvec3 gyration(0.02, 0.03, 0.04);
  const glm::dvec3 small(1e-6, -2e-6, 3e-6), about(0.0, 1.2, 0.0);
  EXPECT_LT(glm::distance(steepestTurn(small, gyration), small), 1e-5 * glm::length(small));
  EXPECT_LT(glm::distance(steepestTurn(about, gyration), about), 1e-14);
  EXPECT_EQ(steepestTurn(glm::dvec3(0.0), gyration), glm::dvec3(0.0));
}

TEST(SteepestTurn, StaysNearTheTurnWhereTheTorqueChangesFasterThanAStepBears) {
  // A needle: about its axis the energy of a turn across it is 1,600 times as steep as the metric says.
  const glm::dvec3 turn(1.5, 0.2, 0.1);
  const glm::dvec3 steepest = steepestTurn(turn, {0.04, 0.04, 0.001});
  EXPECT_LT(glm::distance(steepest, turn), 0.5 * glm::length(turn));
}

TEST(CouplingWrench, HalfATurnIsPulledTheShorterWay) {
  using std::numbers::pi;
  const auto torqueAt = [](double angle) {
    const BodyMotion handle, part{{glm::angleAxis(angle, glm::dvec3(1, 0, 0)), {}}, {}};
    return couplingWrench(kCoupling, metricOf(glm::dvec3(0.02)), {}, handle, part).torque.x;
  };
  EXPECT_NEAR(torqueAt(pi - 0.01), 0.8 * (pi - 0.01), 1e-12);
  EXPECT_NEAR(torqueAt(pi + 0.01), -0.8 * (pi - 0.01), 1e-12);
}

TEST(LimitedCoupling, StaysWithinTheLimitsAndSaysWhatWasWanted) {
  RandomValues random(31);
  const DeviceLimits limits = deviceWithMax(3.0, 0.1);
  CouplingState spring = kCoupling;
  spring.damping = spring.rotationalDamping = 0.0;
  int forceReached = 0, torqueReached = 0;
  for (int i = 0; i < 2000; ++i) {
    const MassMetric metric = metricOf({0.01, 0.02, 0.04}, rotationOf(random.vector(3.0)));
    const BodyMotion handle{random.pose(), {}};
    const RigidTransform apart{rotationOf(random.vector(0.3)), random.vector(0.01)};
    const BodyMotion part{(handle.pose * apart).normalized(), {}};
    const LimitedCoupling w = limitedCoupling(spring, metric, {}, handle, part, limits);
    const Wrench wanted = couplingWrench(spring, metric, {}, handle, part);
    EXPECT_EQ(w.wanted.force, wanted.force);
    EXPECT_EQ(w.wanted.torque, wanted.torque);
    EXPECT_LE(glm::length(w.rendered.force), 3.0 * (1.0 + 1e-12));
    EXPECT_LE(glm::length(w.rendered.torque), 0.1 * (1.0 + 1e-12));
    forceReached += glm::length(wanted.force) > 3.0;
    torqueReached += glm::length(wanted.torque) > 0.1;
  }
  EXPECT_GT(forceReached, 100);
  EXPECT_GT(torqueReached, 100);
}

TEST(LimitedCoupling, AForceBeyondItsLimitTakesTheTorqueDownWithIt) {
  // Clamped apart, a force through a contact would get the torque of another line of action, and drag.
  const MassMetric metric = metricOf({0.01, 0.02, 0.04}, rotationOf({0.3, -0.8, 1.1}));
  const BodyMotion part, handle{{rotationOf({0.05, -0.1, 0.02}), {0.004, -0.006, 0.012}}, {}};
  const LimitedCoupling w = limitedCoupling(kCoupling, metric, {}, handle, part, deviceWithMax(3.0, 10.0));
  const double share = glm::length(w.rendered.force) / glm::length(w.wanted.force);
  EXPECT_LT(share, 0.3);
  EXPECT_NEAR(glm::distance(w.rendered.force, share * w.wanted.force), 0.0, 1e-14);
  EXPECT_NEAR(glm::distance(w.rendered.torque, share * w.wanted.torque), 0.0, 1e-14);
}

TEST(LimitedCoupling, IsTheCouplingItselfWithinTheLimits) {
  const MassMetric metric = metricOf({0.01, 0.02, 0.04});
  const BodyMotion part, handle{{rotationOf({0.05, -0.1, 0.02}), {0.0004, -0.0006, 0.0012}}, {}};
  const LimitedCoupling w = limitedCoupling(kCoupling, metric, {}, handle, part, deviceWithMax(10.0, 1.0));
  EXPECT_EQ(w.rendered.force, w.wanted.force);
  EXPECT_EQ(w.rendered.torque, w.wanted.torque);
}

TEST(LimitedCoupling, RoundALoopBeyondTheLimitsTheHandGainsNothing) {
  // Out, turned, back and turned back: had the factor depended on the force alone, the turn out there would have cost
  // less than it gives back.
  constexpr int kSteps = 20000;
  CouplingState spring = kCoupling;
  spring.damping = spring.rotationalDamping = 0.0;
  const MassMetric metric = metricOf({0.005, 0.02, 0.04}, rotationOf({0.3, -0.8, 1.1}));
  const DeviceLimits limits = deviceWithMax(3.0, 10.0);
  const BodyMotion part{{rotationOf({1.0, 0.4, -0.2}), {}}, {}};
  const auto handleAt = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kSteps;
    const glm::dvec3 turn(0.6 * std::cos(angle), 0.5 * std::sin(angle), 0.4 * std::sin(2.0 * angle + 0.5));
    const glm::dvec3 shift(0.006 * std::sin(angle + 0.7), 0.004 * std::cos(angle), 0.008 * std::sin(angle));
    return BodyMotion{{rotationOf(turn) * part.pose.rotation, shift}, {}};
  };
  const auto wrenchAt = [&](int i) {
    return limitedCoupling(spring, metric, {}, handleAt(i), part, limits).rendered;
  };
  double work = 0.0, turnover = 0.0;
  int limited = 0;
  Wrench before = wrenchAt(0);
  for (int i = 0; i < kSteps; ++i) {
    const Wrench after = wrenchAt(i + 1);
    const RigidTransform from = handleAt(i).pose, to = handleAt(i + 1).pose;
    const double step =
        0.5 * (glm::dot(before.force + after.force, to.translation - from.translation) +
               glm::dot(before.torque + after.torque, turnBetween(from.rotation, to.rotation)));
    work += step;
    turnover += std::abs(step);
    limited += after.force != couplingWrench(spring, metric, {}, handleAt(i + 1), part).force;
    before = after;
  }
  EXPECT_GT(limited, kSteps / 4);
  EXPECT_GT(turnover, 0.01);
  EXPECT_LT(std::abs(work), 1e-6 * turnover);
}

TEST(LimitedCoupling, ALimitOfZeroRendersNothingOfItsOwnAndAllOfTheOther) {
  const MassMetric metric = metricOf(glm::dvec3(0.02));
  const BodyMotion part, handle{{rotationOf({0.05, -0.1, 0.02}), {0.0004, -0.0006, 0.0012}}, {}};
  const LimitedCoupling noForce =
      limitedCoupling(kCoupling, metric, {}, handle, part, deviceWithMax(0.0, 1.0));
  EXPECT_EQ(noForce.rendered.force, glm::dvec3(0.0));
  EXPECT_EQ(noForce.rendered.torque, noForce.wanted.torque);
  const LimitedCoupling noTorque =
      limitedCoupling(kCoupling, metric, {}, handle, part, deviceWithMax(10.0, 0.0));
  EXPECT_EQ(noTorque.rendered.force, noTorque.wanted.force);
  EXPECT_EQ(noTorque.rendered.torque, glm::dvec3(0.0));
}

/// Work that takes the handle away from the part along a straight way, against the limited wrench.
double workOfStretching(const MassMetric& metric, const glm::dvec3& shift, const glm::dvec3& turn,
                        const DeviceLimits& limits) {
  const int steps = 20'000;
  double work = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double middle = (i + 0.5) / steps;
    const BodyMotion part, handle{{rotationOf(middle * turn), middle * shift}, {}};
    const Wrench w = limitedCoupling(kCoupling, metric, {}, handle, part, limits).rendered;
    work -= (glm::dot(w.force, shift) + glm::dot(w.torque, turn)) / steps;
  }
  return work;
}

TEST(StoredEnergy, IsTheWorkThatStretchesTheCoupling) {
  const MassMetric metric = metricOf({0.01, 0.02, 0.04}, rotationOf({0.3, -0.8, 1.1}));
  const glm::dvec3 shift(0.002, -0.003, 0.006), turn(0.3, 0.2, -0.5);
  const DeviceLimits wide = deviceWithMax(1e3, 1e3);
  const DeviceLimits narrow = deviceWithMax(3.0, 0.1);  // Both are reached on the way.
  for (const DeviceLimits& limits : {wide, narrow}) {
    const RigidTransform handle{rotationOf(turn), shift};
    const double work = workOfStretching(metric, shift, turn, limits);
    // Where it is clamped, a torque that does not quite grow as the turn does is reckoned as if it did.
    const double tolerance = limits.maxTorque == narrow.maxTorque ? 1e-2 : 1e-7;
    EXPECT_NEAR(storedEnergy(kCoupling, metric, {}, handle, {}, limits), work, tolerance * work);
  }
}

TEST(StoredEnergy, IsHalfTheStiffnessTimesTheSquareOfTheStretch) {
  const RigidTransform handle{{1, 0, 0, 0}, {0.004, 0, 0}};
  EXPECT_NEAR(storedEnergy(kCoupling, metricOf(glm::dvec3(0.02)), {}, handle, {}, {}), 0.008, 1e-15);
}

TEST(TurnBetween, OppositeQuaternionsAreTheSameTurn) {
  const glm::dquat q = rotationOf({0.3, -0.8, 1.1});
  EXPECT_EQ(glm::length(turnBetween(q, -q)), 0.0);
  const glm::dvec3 turn(0.02, -0.5, 0.7);
  EXPECT_NEAR(glm::distance(turnBetween(q, -(rotationOf(turn) * q)), turn), 0.0, 1e-14);
}

}  // namespace
}  // namespace nearfit::virtual_coupling_test
