#include "core/haptics/spring_bound.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/haptics/virtual_coupling.h"

namespace nearfit::spring_bound_test {
namespace {

constexpr double kPeriod = 1e-3;
const SpringParameters kSoft{.cutoff = 0.01, .stiffness = 200.0};
const DeviceLimits kDevice{};  // 1 N s/m: 2000 N/m at 1 kHz.

Lmd springAt(const glm::dvec3& point, const glm::dvec3& direction, double distance = 0.005) {
  Lmd lmd;
  lmd.partPoint = point;
  lmd.scenePoint = point - distance * direction;
  lmd.direction = direction;
  lmd.distance = distance;
  return lmd;
}

SpringDirections directionsOf(const std::vector<Lmd>& lmds, const SpringParameters& springs,
                              const glm::dvec3& centre = glm::dvec3(0.0)) {
  SpringDirections directions;
  directions.add(lmds, springs, centre);
  return directions;
}

SpringShares sharesOf(const std::vector<Lmd>& lmds, const SpringParameters& springs,
                      const DeviceLimits& device = kDevice) {
  return boundedSprings(directionsOf(lmds, springs), springs, device, kPeriod);
}

/// Springs through the centre, all along one line.
std::vector<Lmd> alongX(std::size_t count) {
  return std::vector<Lmd>(count, springAt(glm::dvec3(0.0), {1.0, 0.0, 0.0}));
}

TEST(SpringDirections, CountWhatPushesAlongOneLineAndAboutOneAxis) {
  std::vector<Lmd> lmds = alongX(3);
  lmds.push_back(springAt({0.5, 0.0, 0.0}, {0.0, 1.0, 0.0}));
  EXPECT_NEAR(directionsOf(lmds, kSoft).alongOneLine(), 3.0, 1e-12);
  EXPECT_NEAR(directionsOf(lmds, kSoft).aboutOneAxis(), 0.25, 1e-12);
  lmds[0].isBlocked = true;
  lmds[1].isMerged = true;
  lmds[2].distance = kSoft.cutoff;
  EXPECT_NEAR(directionsOf(lmds, kSoft).alongOneLine(), 1.0, 1e-12);
}

TEST(SpringDirections, AllAroundInAPlaneHalfOfThemActAlongEachLine) {
  std::vector<Lmd> lmds;
  constexpr int kCount = 50;
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2.0 * std::acos(-1.0) * i / kCount;
    lmds.push_back(springAt(glm::dvec3(0.0), {std::cos(angle), std::sin(angle), 0.0}));
  }
  EXPECT_NEAR(directionsOf(lmds, kSoft).alongOneLine(), 0.5 * kCount, 1e-6);
}

TEST(BoundedSprings, WhatTheDeviceBearsIsFeltInFull) {
  EXPECT_EQ(sharesOf({}, kSoft), SpringShares{});
  EXPECT_EQ(sharesOf(alongX(10), kSoft), SpringShares{});
}

TEST(BoundedSprings, TheSumAlongOneLineIsHeldToTheBound) {
  const SpringShares shares = sharesOf(alongX(40), kSoft);
  EXPECT_NEAR(shares.wrench, 2000.0 / 8000.0, 1e-12);
  EXPECT_TRUE(shares.isHeld());
  // 20 springs of 0.02 N s/m leave 0.6 N s/m: 1200 N/m.
  SpringParameters damped = kSoft;
  damped.damping = 0.02;
  EXPECT_NEAR(sharesOf(alongX(20), damped).wrench, 1200.0 / 4000.0, 1e-12);
  EXPECT_EQ(sharesOf(alongX(20), damped).damping, 1.0);
  // 100 have 2 N s/m: half of the device's is left.
  EXPECT_NEAR(sharesOf(alongX(100), damped).damping, 0.25, 1e-12);
  EXPECT_NEAR(sharesOf(alongX(100), damped).wrench, 1000.0 / 20000.0, 1e-12);
}

TEST(BoundedSprings, ThePrintedLawCountsByItsLargestSlope) {
  SpringParameters printed = kSoft;
  printed.law = SpringLaw::Printed;
  printed.stiffness = 4e5;  // Times 10 mm: 4000 N/m.
  EXPECT_NEAR(sharesOf(alongX(1), printed).wrench, 0.5, 1e-12);
}

TEST(BoundedSprings, ALongLeverCountsAsTurns) {
  // 200 N/m of 2000 that are borne, and at half a metre 50 N m/rad of 2.
  const SpringShares shares = sharesOf({springAt({0.5, 0.0, 0.0}, {0.0, 1.0, 0.0})}, kSoft);
  EXPECT_NEAR(shares.wrench, 1.0 / (0.1 + 25.0), 1e-12);
  // A device without torque has nothing to hold back.
  DeviceLimits arm = kDevice;
  arm.maxTorque = arm.rotationalDamping = 0.0;
  EXPECT_EQ(sharesOf({springAt({0.5, 0.0, 0.0}, {0.0, 1.0, 0.0})}, kSoft, arm), SpringShares{});
}

TEST(BoundedSprings, NothingIsFeltWhereTheBoundHasNoMeaning) {
  DeviceLimits undamped = kDevice;
  undamped.damping = 0.0;
  EXPECT_EQ(sharesOf(alongX(1), kSoft, undamped).wrench, 0.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(boundedSprings(directionsOf(alongX(1), kSoft), kSoft, kDevice, nan).wrench, 0.0);
  // A wrench that overflows is to reach the servo as the fault that it is.
  SpringParameters huge = kSoft;
  huge.stiffness = std::numeric_limits<double>::max();
  EXPECT_EQ(sharesOf(alongX(9), huge), SpringShares{});
}

using Vector6 = std::array<double, 6>;
using Matrix6 = std::array<Vector6, 6>;

/// Largest eigenvalue of a positive semidefinite matrix, by powers.
double largestByPowers(const Matrix6& m) {
  Vector6 v{1.0, 0.9, 1.1, 0.8, 1.2, 0.7};
  double size = 0.0;
  for (int step = 0; step < 3000; ++step) {
    Vector6 next{};
    double squares = 0.0;
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t k = 0; k < 6; ++k)
        next[i] += m[i][k] * v[k];
      squares += next[i] * next[i];
    }
    size = std::sqrt(squares);
    for (std::size_t i = 0; i < 6; ++i)
      v[i] = next[i] / size;
  }
  return size;
}

TEST(BoundedSprings, InAllSixDirectionsTogetherTheDeviceDampsMoreThanSpringsAndTheirDampingBring) {
  std::mt19937_64 random(3);
  const auto number = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1.0; };
  int held = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t count = 1 + random() % 30;
    std::vector<Lmd> lmds;
    for (std::size_t i = 0; i < count; ++i)
      lmds.push_back(springAt(0.3 * glm::dvec3(number(), number(), number()),
                              glm::normalize(glm::dvec3(number(), number(), 1.5 + number()))));
    SpringParameters springs = kSoft;
    springs.damping = trial % 2 == 0 ? 0.0 : 0.1;
    const SpringShares shares = sharesOf(lmds, springs);
    held += shares.isHeld() ? 1 : 0;
    // K T / 2 + B over the device's damping, each held back by its share.
    Matrix6 load{};
    for (const Lmd& lmd : lmds) {
      const glm::dvec3 turn = glm::cross(lmd.partPoint, lmd.direction);
      for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t k = 0; k < 6; ++k) {
          const auto of = [&](std::size_t axis) {
            const auto at = static_cast<glm::length_t>(axis % 3);
            return axis < 3 ? lmd.direction[at] / std::sqrt(kDevice.damping)
                            : turn[at] / std::sqrt(kDevice.rotationalDamping);
          };
          load[i][k] +=
              (0.5 * kPeriod * shares.wrench * springs.stiffness + shares.damping * springs.damping) * of(i) *
              of(k);
        }
      }
    }
    EXPECT_LE(largestByPowers(load), 1.0 + 1e-7) << trial;
  }
  EXPECT_GT(held, 100);
}

TEST(RisenShares, FallAtOnceAndRiseInTime) {
  const SpringShares low{0.2, 0.4};
  EXPECT_EQ(risenShares({}, low, kPeriod), low);
  SpringShares shares = low;
  for (double time = 0.0; time < kShareRiseTime; time += kPeriod)
    shares = risenShares(shares, {}, kPeriod);
  // To a fraction 1 / e of the way, to first order in the period.
  EXPECT_NEAR(shares.wrench, 1.0 - 0.8 * std::exp(-1.0), 0.01);
  for (double time = 0.0; time < 20.0 * kShareRiseTime; time += kPeriod)
    shares = risenShares(shares, {}, kPeriod);
  EXPECT_EQ(shares, SpringShares{}) << "ends";
}

}  // namespace
}  // namespace nearfit::spring_bound_test
