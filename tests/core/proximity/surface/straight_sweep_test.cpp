#include "core/proximity/surface/straight_sweep.h"

#include <gtest/gtest.h>

namespace nearfit::straight_sweep_test {
namespace {

constexpr double kFar = 100.0;
const TriangleCorners kFloor{glm::dvec3(-5, -5, 0), glm::dvec3(5, -5, 0), glm::dvec3(0, 5, 0)};
/// Upright, its tip 0.5 below the floor and its base 1 below.
const TriangleCorners kTip{glm::dvec3(-0.1, 0, -1), glm::dvec3(0.1, 0, -1), glm::dvec3(0, 0, -0.5)};

TEST(StraightSweep, TrianglesMeetFromWhereTheFirstCornerArrivesToWhereTheLastOneLeaves) {
  const TriangleSweep sweep = sweepTriangles(kFloor, kTip, {0, 0, 1}, kFar);
  EXPECT_NEAR(sweep.stretch.from, 0.5, 1e-12);
  EXPECT_NEAR(sweep.stretch.to, 1.0, 1e-12);
  EXPECT_NEAR(sweep.firstNormal.z, -1.0, 1e-12);
  EXPECT_NEAR(sweep.lastNormal.z, 1.0, 1e-12);
}

TEST(StraightSweep, ThoseThatMeetAtTheStartHaveNoFirstNormalAndPartWhereTheyDo) {
  TriangleCorners through = kTip;
  for (glm::dvec3& p : through)
    p.z += 0.75;
  const TriangleSweep up = sweepTriangles(kFloor, through, {0, 0, 1}, kFar);
  EXPECT_EQ(up.stretch.from, 0.0);
  EXPECT_NEAR(up.stretch.to, 0.25, 1e-12);
  EXPECT_EQ(up.firstNormal, glm::dvec3(0.0));
  const TriangleSweep down = sweepTriangles(kFloor, through, {0, 0, -1}, kFar);
  EXPECT_NEAR(down.stretch.to, 0.25, 1e-12);
  EXPECT_NEAR(down.lastNormal.z, -1.0, 1e-12);
}

TEST(StraightSweep, TrianglesThatMissOrMeetOnlyBeyondTheTravelDoNotMeet) {
  EXPECT_TRUE(sweepTriangles(kFloor, kTip, {0, 0, -1}, kFar).stretch.isEmpty());
  EXPECT_TRUE(sweepTriangles(kFloor, kTip, {1, 0, 0}, kFar).stretch.isEmpty());
  EXPECT_TRUE(sweepTriangles(kFloor, kTip, {0, 0, 1}, 0.4).stretch.isEmpty());
}

}  // namespace
}  // namespace nearfit::straight_sweep_test
