#include "core/haptics/guidance.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
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

GuidancePath straightAlongX(std::size_t segments = 4) {
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i <= segments; ++i)
    points.emplace_back(0.1 * static_cast<double>(i), 0.0, 0.0);
  return {points, kPull};
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
    const GuidancePull pull = follower.follow(path, kPull, {x, 0.003, -0.004});
    EXPECT_NEAR(pull.force.x, 0.0, 1e-15) << x;
    EXPECT_NEAR(pull.force.y, -0.3, 1e-12) << x;
    EXPECT_NEAR(pull.force.z, 0.4, 1e-12) << x;
    EXPECT_NEAR(pull.energy, 0.5 * 100.0 * 0.005 * 0.005, 1e-12) << x;
  }
  EXPECT_EQ(follower.follow(path, kPull, {0.2, 0.0, 0.0}).force, glm::dvec3(0.0)) << "on the path";
  EXPECT_EQ(follower.follow(path, kPull, {0.2, 0.07, 0.0}).force, glm::dvec3(0.0)) << "the hand has left it";
}

TEST(Guidance, AClosedWayOfTheHandGainsNothing) {
  // Round a corner of the path, within its reach and out of it.
  const GuidancePath path({{-0.2, 0, 0}, {0, 0, 0}, {0, 0.2, 0}}, kPull);
  GuidanceFollower follower;
  constexpr int kSteps = 40'000;
  double work = 0.0;
  const auto at = [](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kSteps;
    return glm::dvec3(-0.05 + 0.07 * std::cos(angle), 0.05 + 0.07 * std::sin(angle),
                      0.01 * std::sin(3.0 * angle));
  };
  for (int i = 0; i < kSteps; ++i) {
    const glm::dvec3 middle = 0.5 * (at(i) + at(i + 1));
    work += glm::dot(follower.follow(path, kPull, middle).force, at(i + 1) - at(i));
  }
  // Of some 0.1 J that go in and out. Where both segments are as near, a step is uncertain by 1 N times its 11 um.
  EXPECT_NEAR(work, 0.0, 5e-5);
}

TEST(Guidance, FindsAnotherStretchOnceNothingPulls) {
  // There and back, 0.2 m apart, in segments of 1 mm.
  std::vector<glm::dvec3> points;
  for (int i = 0; i <= 1000; ++i)
    points.emplace_back(0.001 * i, 0.0, 0.0);
  for (int i = 1000; i >= 0; --i)
    points.emplace_back(0.001 * i, 0.2, 0.0);
  const GuidancePath path(points, kPull);
  GuidanceFollower follower;
  EXPECT_GT(follower.follow(path, kPull, {0.0, 0.01, 0.0}).force.y, -1.01);
  EXPECT_LT(follower.follow(path, kPull, {0.0, 0.01, 0.0}).force.y, -0.99);
  // At once on the way back: within a scan of all segments it is pulled there.
  const int ticks = static_cast<int>(path.segments() / GuidanceFollower::kScan) + 2;
  GuidancePull pull;
  for (int i = 0; i < ticks; ++i)
    pull = follower.follow(path, kPull, {0.5, 0.19, 0.0});
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
    follower.follow(path, kPull, {0.5 * i, 0.05 * (i % 3), 0.0});
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
}

TEST(Guidance, RefusesWhatIsNoPathAndNoPull) {
  const auto refusal = [](std::vector<glm::dvec3> points, const GuidanceSettings& settings) {
    return test::refusalOf([&] { GuidancePath(std::move(points), settings); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal({{0, 0, 0}}, kPull), HasSubstr("less than two points"));
  EXPECT_THAT(refusal({{0, 0, 0}, {0, 0, 0}}, kPull), HasSubstr("the same"));
  EXPECT_THAT(refusal({{0, 0, 0}, {nan, 0, 0}}, kPull), HasSubstr("not finite"));
  EXPECT_THAT(refusal({{0, 0, 0}, {1, 0, 0}}, {0.0, 1.0, 0.1}), HasSubstr("stiffness"));
  EXPECT_THAT(refusal({{0, 0, 0}, {1, 0, 0}}, {10.0, 50.0, 0.1}), HasSubstr("max force"));
  EXPECT_THAT(refusal({{0, 0, 0}, {1, 0, 0}}, {10.0, 1.0, nan}), HasSubstr("reach"));
}

}  // namespace
}  // namespace nearfit::guidance_test
