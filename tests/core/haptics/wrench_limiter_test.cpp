#include "core/haptics/wrench_limiter.h"

#include <gtest/gtest.h>

namespace nearfit {
namespace {

TEST(WrenchLimiter, AWrenchWithinTheLimitsIsLeftAlone) {
  const LimitedWrench r = limitWrench({{3.0, 4.0, 0.0}, {0.0, 0.6, 0.8}}, {5.0, 1.0});
  EXPECT_FALSE(r.isClamped);
  EXPECT_EQ(r.wrench.force, glm::dvec3(3.0, 4.0, 0.0));
  EXPECT_EQ(r.wrench.torque, glm::dvec3(0.0, 0.6, 0.8));
}

TEST(WrenchLimiter, ForceAndTorqueAreEachScaledToTheirLengthLimit) {
  // |(30, 40, 0)| = 50 to 5; |(0, 0.6, 0.8)| = 1 to 0.5.
  const LimitedWrench r = limitWrench({{30.0, 40.0, 0.0}, {0.0, 0.6, 0.8}}, {5.0, 0.5});
  EXPECT_TRUE(r.isClamped);
  EXPECT_DOUBLE_EQ(r.wrench.force.x, 3.0);
  EXPECT_DOUBLE_EQ(r.wrench.force.y, 4.0);
  EXPECT_DOUBLE_EQ(r.wrench.torque.y, 0.3);
  EXPECT_DOUBLE_EQ(r.wrench.torque.z, 0.4);
}

TEST(WrenchLimiter, ALargeForceLeavesASmallTorqueAlone) {
  const LimitedWrench r = limitWrench({{100.0, 0.0, 0.0}, {0.0, 0.1, 0.0}}, {5.0, 0.5});
  EXPECT_TRUE(r.isClamped);
  EXPECT_EQ(r.wrench.torque, glm::dvec3(0.0, 0.1, 0.0));
}

TEST(WrenchLimiter, NumbersWhoseSquareOverflowsKeepTheirDirection) {
  const LimitedWrench r = limitWrench({{0.0, -1e300, 0.0}, {}}, {5.0, 0.5});
  EXPECT_DOUBLE_EQ(r.wrench.force.y, -5.0);
}

TEST(WrenchLimiter, ALimitOfZeroGivesZero) {
  const LimitedWrench r = limitWrench({{1.0, 0.0, 0.0}, {0.0, 0.0, 0.0}}, {0.0, 0.0});
  EXPECT_TRUE(r.isClamped);
  EXPECT_EQ(r.wrench.force, glm::dvec3(0.0));
  EXPECT_EQ(r.wrench.torque, glm::dvec3(0.0));
}

}  // namespace
}  // namespace nearfit
