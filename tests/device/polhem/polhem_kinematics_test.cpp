#include "device/polhem/polhem_kinematics.h"

#include <cmath>
#include <functional>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "device/polhem/polhem_protocol.h"
#include "tests/support/random_values.h"

namespace nearfit::polhem::polhem_kinematics_test {
namespace {

/// Rounding of a few sines and lengths below a metre.
constexpr double kRounding = 1e-12;

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  EXPECT_LE(glm::length(a - b), tolerance)
      << a.x << ' ' << a.y << ' ' << a.z << " against " << b.x << ' ' << b.y << ' ' << b.z;
}

Calibration withOriginAtBase() {
  Calibration calibration;
  calibration.origin = {0.0, 0.0, 0.0};
  return calibration;
}

/// Calls with arms of the elbow-up branch all over the joints' ranges.
void forEachArm(const Calibration& calibration, const std::function<void(const glm::dvec3&)>& call) {
  constexpr int kSteps = 14;
  /// Elbows nearer to straight or folded have no inverse to compare with: rounding decides.
  constexpr double kClear = 0.05;
  const auto at = [&](std::size_t joint, int step) {
    const Joint& j = calibration.joints[joint].joint;
    return j.lower + (j.upper - j.lower) * step / kSteps;
  };
  int calls = 0;
  for (int a = 0; a <= kSteps; ++a) {
    for (int b = 0; b <= kSteps; ++b) {
      for (int c = 0; c <= kSteps; ++c) {
        const glm::dvec3 arm(at(0, a), at(1, b), at(2, c));
        const double elbow = arm.y + arm.z;
        const double out = calibration.lowerArm * std::sin(arm.y) + calibration.upperArm * std::sin(arm.z);
        if (elbow < kClear || elbow > std::numbers::pi - kClear || out < 0.01) continue;
        call(arm);
        ++calls;
      }
    }
  }
  EXPECT_GT(calls, 500) << "the sweep has missed the workspace";
}

TEST(PolhemKinematics, PlacesThatCanBeSeenByEye) {
  const Kinematics arm(withOriginAtBase());
  // Lower arm upright, upper arm level: out by the one, up by column and other.
  expectNear(arm.positionOf({0.0, 0.0, degrees(90)}), {0.245, 0.0, 0.080 + 0.205}, kRounding);
  // The same with the base turned left by a right angle.
  expectNear(arm.positionOf({degrees(90), 0.0, degrees(90)}), {0.0, 0.245, 0.285}, kRounding);
  // Lower arm level, upper arm hanging.
  expectNear(arm.positionOf({0.0, degrees(90), 0.0}), {0.205, 0.0, 0.080 - 0.245}, kRounding);
}

TEST(PolhemKinematics, TheOriginIsWhereTheCalibrationPutsIt) {
  Calibration calibration;
  calibration.origin = {0.245, 0.0, 0.285};
  expectNear(Kinematics(calibration).positionOf({0.0, 0.0, degrees(90)}), {0.0, 0.0, 0.0}, kRounding);
}

TEST(PolhemKinematics, JacobianIsTheDerivativeOfThePosition) {
  const Calibration calibration;
  const Kinematics kinematics(calibration);
  /// Central differences: the error is a sixth of its square, and rounding over it [rad].
  constexpr double kStep = 1e-5;
  forEachArm(calibration, [&](const glm::dvec3& arm) {
    const glm::dmat3 jacobian = kinematics.jacobian(arm);
    for (int i = 0; i < 3; ++i) {
      glm::dvec3 more = arm, less = arm;
      more[i] += kStep;
      less[i] -= kStep;
      const glm::dvec3 slope = (kinematics.positionOf(more) - kinematics.positionOf(less)) / (2.0 * kStep);
      expectNear(jacobian[i], slope, 1e-9);
    }
  });
}

TEST(PolhemKinematics, InverseBringsBackTheAnglesAllOverTheWorkspace) {
  const Calibration calibration;
  const Kinematics kinematics(calibration);
  forEachArm(calibration, [&](const glm::dvec3& arm) {
    const auto back = kinematics.armFor(kinematics.positionOf(arm));
    ASSERT_TRUE(back);
    expectNear(*back, arm, 1e-9);
  });
}

TEST(PolhemKinematics, PlacesOutOfReachHaveNoAngles) {
  const Kinematics kinematics(withOriginAtBase());
  EXPECT_TRUE(kinematics.armFor({0.449, 0.0, 0.080}));
  EXPECT_FALSE(kinematics.armFor({0.451, 0.0, 0.080})) << "longer than both arms";
  EXPECT_FALSE(kinematics.armFor({0.039, 0.0, 0.080})) << "nearer than the arms can fold";
  EXPECT_FALSE(kinematics.armFor({0.0, 0.0, 0.300})) << "on the column's axis";
}

TEST(PolhemKinematics, MotorsDoTheWorkThatTheHandFeels) {
  Calibration calibration;
  calibration.joints[1].joint.isReversed = true;
  // Torque for each ampere high enough that no current is at its limit and rounding to milliamps is small.
  for (DrivenJoint& driven : calibration.joints)
    driven.torqueConstant = 1.0;
  const Kinematics kinematics(calibration);
  test::RandomValues random(7);
  forEachArm(calibration, [&](const glm::dvec3& arm) {
    const glm::dvec3 force = random.vector(5.0), turn = random.vector(1e-6);
    const glm::dvec3 moved = kinematics.positionOf(arm + turn) - kinematics.positionOf(arm);
    const auto milliamps = kinematics.milliampsFor(force, arm);
    double work = 0.0, rounded = 0.0;
    for (int i = 0; i < 3; ++i) {
      const DrivenJoint& driven = calibration.joints[static_cast<std::size_t>(i)];
      const double shaft = turn[i] * driven.joint.gearRatio * (driven.joint.isReversed ? -1.0 : 1.0);
      work += 1e-3 * milliamps[static_cast<std::size_t>(i)] * driven.torqueConstant * shaft;
      rounded += 1e-3 * driven.torqueConstant * std::abs(shaft);
    }
    // Besides the rounding, the arm bends away from its tangent by the turn squared.
    EXPECT_NEAR(work, glm::dot(force, moved), rounded + 1e-11);
  });
}

TEST(PolhemKinematics, LimitsOfCurrentKeepTheForcesDirection) {
  const Calibration calibration;
  const Kinematics kinematics(calibration);
  const glm::dvec3 arm(0.3, 0.2, 1.4), force(200.0, -300.0, 100.0);
  const auto milliamps = kinematics.milliampsFor(force, arm);
  int most = 0;
  glm::dvec3 torque(0.0);
  for (int i = 0; i < 3; ++i) {
    const auto index = static_cast<std::size_t>(i);
    most = std::max(most, std::abs(milliamps[index]));
    torque[i] = 1e-3 * milliamps[index] * 0.0259 * calibration.joints[index].joint.gearRatio;
  }
  EXPECT_GE(most, kMaxMilliamps - 1);
  EXPECT_LE(most, kMaxMilliamps);
  // What is felt is what undoes those torques.
  const glm::dvec3 felt = glm::inverse(glm::transpose(kinematics.jacobian(arm))) * torque;
  EXPECT_NEAR(glm::dot(glm::normalize(felt), glm::normalize(force)), 1.0, 1e-6);
  EXPECT_LT(glm::length(felt), glm::length(force));
}

TEST(PolhemKinematics, AMotorsOwnLimitHolds) {
  Calibration calibration;
  calibration.joints[2].maxCurrent = 0.25;
  const auto milliamps = Kinematics(calibration).milliampsFor({50.0, 0.0, 80.0}, {0.0, 0.3, 1.2});
  EXPECT_LE(std::abs(milliamps[2]), 250);
  EXPECT_GE(std::abs(milliamps[2]), 249);
}

TEST(PolhemKinematics, AForceThatIsNoNumberMovesNoMotor) {
  const auto milliamps = Kinematics({}).milliampsFor({NAN, 1.0, INFINITY}, {0.1, 0.2, 1.0});
  for (const int each : milliamps)
    EXPECT_LE(std::abs(each), kMaxMilliamps);
  EXPECT_EQ(Kinematics({}).milliampsFor({NAN, NAN, NAN}, {0.1, 0.2, 1.0}), (std::array<int, 3>{0, 0, 0}));
}

TEST(PolhemKinematics, CountsAreTurnedIntoAnglesFromTheRest) {
  Calibration calibration;
  calibration.joints[1].joint.isReversed = true;
  const Kinematics kinematics(calibration);
  expectNear(kinematics.restAngles().arm, {0.0, 0.0, degrees(90)}, kRounding);
  // A turn of each motor: 360 degrees over gears of 16, 12 and 12.
  const auto angles = kinematics.anglesOf({2100, 2050, 2000, 0, 0, 0}, {100, 50, 0, 0, 0, 0});
  expectNear(angles.arm, {degrees(22.5), -degrees(30), degrees(120)}, kRounding);
}

TEST(PolhemKinematics, CountersThatWrapDoNotMoveTheArm) {
  const Kinematics kinematics{Calibration{}};
  const auto before = kinematics.anglesOf({32767, 0, 0, 0, 0, 0}, {32760, 0, 0, 0, 0, 0});
  const auto after = kinematics.anglesOf({-32768, 0, 0, 0, 0, 0}, {32760, 0, 0, 0, 0, 0});
  EXPECT_NEAR(after.arm.x - before.arm.x, degrees(360.0 / 2000.0 / 16.0), kRounding);
}

TEST(PolhemKinematics, ThePenPointsAlongTheUpperArmAndTurnsWithTheBase) {
  Calibration calibration = withOriginAtBase();
  calibration.hasGimbal = true;
  const Kinematics kinematics(calibration);
  const glm::dvec3 along(1.0, 0.0, 0.0);
  // Upper arm level, base turned left: along y.
  expectNear(kinematics.orientationOf({{degrees(90), 0.0, degrees(90)}, {}}) * along, {0.0, 1.0, 0.0},
             kRounding);
  // Upper arm hanging: down.
  expectNear(kinematics.orientationOf({{0.0, 0.5, 0.0}, {}}) * along, {0.0, 0.0, -1.0}, kRounding);
  // Everywhere it is the upper arm's own direction: what the handle is from the arms' joint.
  const glm::dvec3 arm(0.4, -0.2, 1.1);
  Calibration shorter = calibration;
  shorter.upperArm = calibration.upperArm - 0.1;
  const glm::dvec3 link = kinematics.positionOf(arm) - Kinematics(shorter).positionOf(arm);
  expectNear(kinematics.orientationOf({arm, {}}) * along, glm::normalize(link), kRounding);
}

TEST(PolhemKinematics, TheGimbalRollsPitchesAndRollsThePen) {
  Calibration calibration;
  calibration.hasGimbal = true;
  const Kinematics kinematics(calibration);
  const glm::dvec3 level(0.0, 0.0, degrees(90));
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0);
  // Pitch about y by a right angle: x looks down.
  expectNear(kinematics.orientationOf({level, {0.0, degrees(90), 0.0}}) * x, {0.0, 0.0, -1.0}, kRounding);
  // Rolled first by a right angle, the same pitch looks left.
  expectNear(kinematics.orientationOf({level, {degrees(90), degrees(90), 0.0}}) * x, {0.0, 1.0, 0.0},
             kRounding);
  // The last roll does not move where it points, but what lies across.
  const glm::dquat rolled = kinematics.orientationOf({level, {0.0, 0.0, degrees(90)}});
  expectNear(rolled * x, x, kRounding);
  expectNear(rolled * y, {0.0, 0.0, 1.0}, kRounding);
}

TEST(PolhemKinematics, WithoutAGimbalThePenDoesNotTurn) {
  const glm::dquat rotation = Kinematics(Calibration{}).orientationOf({{1.0, 0.5, 0.7}, {0.1, 0.2, 0.3}});
  EXPECT_EQ(rotation, glm::dquat(1.0, 0.0, 0.0, 0.0));
}

TEST(PolhemKinematics, RangesBoundTheJoints) {
  const Kinematics kinematics{Calibration{}};
  EXPECT_TRUE(kinematics.isInRange({0.0, 0.0, degrees(90)}));
  EXPECT_FALSE(kinematics.isInRange({degrees(101), 0.0, degrees(90)}));
  EXPECT_FALSE(kinematics.isInRange({0.0, degrees(-81), degrees(90)}));
  EXPECT_FALSE(kinematics.isInRange({0.0, 0.0, NAN}));
}

}  // namespace
}  // namespace nearfit::polhem::polhem_kinematics_test
