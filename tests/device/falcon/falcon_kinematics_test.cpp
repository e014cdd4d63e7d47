#include "device/falcon/falcon_kinematics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "tests/support/random_values.h"

namespace nearfit::falcon::falcon_kinematics_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  EXPECT_LE(glm::length(a - b), tolerance)
      << a.x << ' ' << a.y << ' ' << a.z << " against " << b.x << ' ' << b.y << ' ' << b.z;
}

/// The workspace, about four inches each way: places on a grid that the legs reach.
std::vector<glm::dvec3> workspace(double step) {
  std::vector<glm::dvec3> places;
  for (double x = -0.05; x <= 0.0501; x += step) {
    for (double y = -0.05; y <= 0.0501; y += step) {
      for (double z = 0.080; z <= 0.1701; z += step) {
        const auto angles = inverse({x, y, z});
        if (angles && isInRange(*angles)) places.emplace_back(x, y, z);
      }
    }
  }
  return places;
}

/// By rotation matrices as Stamper writes them, and not by the driver's triangles: the distance between thigh
/// end and grip corner less what thigh, bars and joints allow.
double legError(int leg, const glm::dvec3& p, double thigh) {
  const double angle = (105.0 - 120.0 * leg) * kDegree;
  const double u = std::cos(angle) * p.x + std::sin(angle) * p.y - 0.037233758;
  const double v = -std::sin(angle) * p.x + std::cos(angle) * p.y + 0.027330909;
  const double theta3 = std::acos((v - 0.025) / 0.1025);
  const double shin = 0.01125 + 0.01125 + 0.1025 * std::sin(theta3);
  return std::hypot(u + 0.014 - 0.060 * std::cos(thigh), p.z - 0.060 * std::sin(thigh)) - shin;
}

TEST(FalconKinematics, TheWorkspaceIsReached) {
  const std::vector<glm::dvec3> places = workspace(0.01);
  // Of 11 x 11 x 10 places the corners may be beyond the legs.
  EXPECT_GT(places.size(), 900U);
  EXPECT_TRUE(inverse(kCentre));
}

TEST(FalconKinematics, InverseFulfilsTheLegsEquationsOfStamper) {
  for (const glm::dvec3& p : workspace(0.01)) {
    const glm::dvec3 angles = *inverse(p);
    for (int leg = 0; leg < 3; ++leg)
      EXPECT_NEAR(legError(leg, p, angles[leg]), 0.0, 1e-14);
  }
}

TEST(FalconKinematics, PlacesOutOfReachHaveNoAngles) {
  EXPECT_FALSE(inverse({0.0, 0.0, 0.5}));
  EXPECT_FALSE(inverse({0.2, 0.0, 0.12}));
}

TEST(FalconKinematics, ForwardBringsBackEachPlaceFromTheCentre) {
  for (const glm::dvec3& p : workspace(0.01)) {
    const auto back = forward(*inverse(p), kCentre);
    ASSERT_TRUE(back) << p.x << ' ' << p.y << ' ' << p.z;
    expectNear(*back, p, 1e-10);
  }
}

TEST(FalconKinematics, ForwardConvergesBetweenAnyTwoPlaces) {
  const std::vector<glm::dvec3> places = workspace(0.025);
  ASSERT_GT(places.size(), 50U);
  for (const glm::dvec3& from : places) {
    for (const glm::dvec3& to : places) {
      const auto back = forward(*inverse(to), from);
      ASSERT_TRUE(back);
      expectNear(*back, to, 1e-10);
    }
  }
}

TEST(FalconKinematics, ForwardGetsOutOfPlacesThatLeadNowhere) {
  const glm::dvec3 angles = *inverse({0.01, -0.02, 0.11});
  for (const glm::dvec3& start :
       {glm::dvec3(0.0), glm::dvec3(1.0, 1.0, 1.0), glm::dvec3(NAN), glm::dvec3(0.0, 0.0, -0.12)}) {
    const auto back = forward(angles, start);
    ASSERT_TRUE(back);
    expectNear(*back, {0.01, -0.02, 0.11}, 1e-10);
  }
}

TEST(FalconKinematics, AnglesThatTheLegsCannotHaveTogetherAreRefused) {
  // One knee all the way in, two out, and angles that are none.
  EXPECT_FALSE(forward({NAN, 0.5, 0.5}, kCentre));
  test::RandomValues random(3);
  int refused = 0;
  for (int i = 0; i < 5000; ++i) {
    const glm::dvec3 angles(random.in(kMinAngle, kMaxAngle), random.in(kMinAngle, kMaxAngle),
                            random.in(kMinAngle, kMaxAngle));
    const auto place = forward(angles, kCentre);
    if (!place) {
      ++refused;
      continue;
    }
    for (int leg = 0; leg < 3; ++leg)
      EXPECT_NEAR(legError(leg, *place, angles[leg]), 0.0, 1e-11);
    const auto back = inverse(*place);
    ASSERT_TRUE(back);
    expectNear(*back, angles, 1e-6);
  }
  EXPECT_LT(refused, 2500) << "most angles within the range are possible";
}

TEST(FalconKinematics, WithAllThighsAlikeTheGripIsNearTheAxis) {
  for (const double thigh : {0.2, 0.6, 1.0}) {
    const auto place = forward(glm::dvec3(thigh), kCentre);
    ASSERT_TRUE(place);
    // The legs are alike, 120 degrees apart: the only place that turning leaves as it is is on the axis.
    EXPECT_NEAR(std::hypot(place->x, place->y), 0.0, 1e-10);
  }
}

TEST(FalconKinematics, JacobianIsTheDerivativeOfThePlace) {
  constexpr double kStep = 1e-6;
  for (const glm::dvec3& p : workspace(0.02)) {
    const glm::dvec3 angles = *inverse(p);
    const glm::dmat3 exact = jacobian(p, angles);
    for (int i = 0; i < 3; ++i) {
      glm::dvec3 more = angles, less = angles;
      more[i] += kStep;
      less[i] -= kStep;
      const auto after = forward(more, p), before = forward(less, p);
      ASSERT_TRUE(after && before);
      const glm::dvec3 slope = (*after - *before) / (2.0 * kStep);
      // Newton's residual over the step, and the curvature, which grows towards the edge.
      expectNear(exact[i], slope, 1e-5 * std::max(1.0, glm::length(slope) / 0.06));
    }
  }
}

TEST(FalconKinematics, MotorsDoTheWorkThatTheHandFeels) {
  test::RandomValues random(11);
  for (const glm::dvec3& p : workspace(0.02)) {
    const glm::dvec3 angles = *inverse(p), force = random.vector(1.0), moved = random.vector(1e-7);
    const glm::dvec3 turn = *inverse(p + moved) - angles;
    const auto units = unitsFor(force, p, angles);
    if (std::any_of(units.begin(), units.end(), [](int each) { return std::abs(each) >= kMaxUnits - 1; }))
      continue;
    double work = 0.0, rounded = 0.0;
    for (int i = 0; i < 3; ++i) {
      work += -units[static_cast<std::size_t>(i)] / kUnitsPerNewtonMetre * turn[i];
      rounded += std::abs(turn[i]) / kUnitsPerNewtonMetre;
    }
    EXPECT_NEAR(work, glm::dot(force, moved), rounded + 1e-11);
  }
}

TEST(FalconKinematics, TheLegsShareAPullAlongTheAxis) {
  // On the axis each leg bears a third of the force, and all do the same work: t = F/3 dz/dt, where the grip
  // follows the thighs by symmetry as one leg in its plane does.
  const auto place = forward(glm::dvec3(0.6), kCentre);
  ASSERT_TRUE(place);
  constexpr double kStep = 1e-6;
  const double rise =
      (forward(glm::dvec3(0.6 + kStep), kCentre)->z - forward(glm::dvec3(0.6 - kStep), kCentre)->z) /
      (2.0 * kStep);
  const auto units = unitsFor({0.0, 0.0, 9.0}, *place, glm::dvec3(0.6));
  for (const int each : units) {
    EXPECT_NEAR(each, -3.0 * rise * kUnitsPerNewtonMetre, 1.0) << "rounding towards zero";
    EXPECT_LT(std::abs(each), kMaxUnits) << "nine newtons are within the motors' reach";
  }
}

TEST(FalconKinematics, LimitsKeepTheForcesDirection) {
  const glm::dvec3 angles = *inverse(kCentre), force(100.0, -200.0, 300.0);
  const auto units = unitsFor(force, kCentre, angles);
  int most = 0;
  glm::dvec3 torque(0.0);
  for (int i = 0; i < 3; ++i) {
    most = std::max(most, std::abs(int{units[static_cast<std::size_t>(i)]}));
    torque[i] = -units[static_cast<std::size_t>(i)] / kUnitsPerNewtonMetre;
  }
  EXPECT_LE(most, kMaxUnits);
  EXPECT_GE(most, kMaxUnits - 1);
  const glm::dvec3 felt = glm::inverse(glm::transpose(jacobian(kCentre, angles))) * torque;
  EXPECT_NEAR(glm::dot(glm::normalize(felt), glm::normalize(force)), 1.0, 1e-6);
}

TEST(FalconKinematics, AForceOrPlaceThatIsNoNumberMovesNoMotor) {
  const std::array<std::int16_t, 3> none{};
  EXPECT_EQ(unitsFor({NAN, 0.0, 0.0}, kCentre, *inverse(kCentre)), none);
  EXPECT_EQ(unitsFor({1.0, 0.0, 0.0}, {NAN, 0.0, 0.0}, *inverse(kCentre)), none);
}

TEST(FalconKinematics, EncodersCountFromTheIndexThroughTheGear) {
  expectNear(anglesOf({0, 0, 0}), glm::dvec3(35.0 * kDegree), 1e-15);
  // A turn of the motor is 1280 counts and moves the thigh by 14.25 / 110 of a turn.
  const glm::dvec3 angles = anglesOf({1280, -1280, 640});
  expectNear(
      angles,
      glm::dvec3(35.0 + 46.63636363636364, 35.0 - 46.63636363636364, 35.0 + 23.31818181818182) * kDegree,
      1e-12);
}

}  // namespace
}  // namespace nearfit::falcon::falcon_kinematics_test
