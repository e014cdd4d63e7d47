#include "core/math/euler_angles.h"

#include <numbers>

#include <gtest/gtest.h>

namespace nearfit::euler_angles_test {
namespace {

constexpr double kPi = std::numbers::pi;

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(a[i], b[i], 1e-12) << "component " << i;
}

TEST(EulerAngles, QuarterTurnAboutEachAxisMovesTheOtherAxes) {
  expectNear(rotationFromEulerAngles({kPi / 2, 0, 0}) * glm::dvec3(0, 1, 0), {0, 0, 1});
  expectNear(rotationFromEulerAngles({0, kPi / 2, 0}) * glm::dvec3(0, 0, 1), {1, 0, 0});
  expectNear(rotationFromEulerAngles({0, 0, kPi / 2}) * glm::dvec3(1, 0, 0), {0, 1, 0});
}

TEST(EulerAngles, TurnsAboutXFirstAndZLast) {
  // y goes to z by the turn about x; the turn about the fixed z then leaves it.
  expectNear(rotationFromEulerAngles({kPi / 2, 0, kPi / 2}) * glm::dvec3(0, 1, 0), {0, 0, 1});
}

TEST(EulerAngles, ComeBackFromTheirRotation) {
  for (double x = -3.0; x <= 3.0; x += 0.75) {
    for (double y = -1.5; y <= 1.5; y += 0.5) {
      for (double z = -3.0; z <= 3.0; z += 0.75)
        expectNear(eulerAnglesOf(rotationFromEulerAngles({x, y, z})), {x, y, z});
    }
  }
}

TEST(EulerAngles, RightAngleAboutYKeepsTheRotation) {
  for (const double y : {kPi / 2, -kPi / 2}) {
    const glm::dquat rotation = rotationFromEulerAngles({0.3, y, 0.9});
    const glm::dvec3 angles = eulerAnglesOf(rotation);
    EXPECT_EQ(angles.z, 0.0);
    const glm::dquat again = rotationFromEulerAngles(angles);
    EXPECT_NEAR(std::abs(glm::dot(rotation, again)), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace nearfit::euler_angles_test
