#include "core/placing/scale_bar.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace nearfit::scale_bar_test {
namespace {

TEST(ScaleBar, IsOneTwoOrFiveTimesAPowerOfTenUnits) {
  EXPECT_DOUBLE_EQ(scaleBarLength(0.0123, 1e-3), 0.01);
  EXPECT_DOUBLE_EQ(scaleBarLength(0.0456, 1e-3), 0.02);
  EXPECT_DOUBLE_EQ(scaleBarLength(0.0999, 1e-3), 0.05);
  EXPECT_DOUBLE_EQ(scaleBarLength(3.7, 1e-3), 2.0);
  EXPECT_DOUBLE_EQ(scaleBarLength(7.1e-7, 1e-3), 5e-7);
}

TEST(ScaleBar, IsRoundInItsOwnUnit) {
  EXPECT_DOUBLE_EQ(scaleBarLength(0.06, 0.0254), 2.0 * 0.0254);
  EXPECT_DOUBLE_EQ(scaleBarLength(0.02, 0.0254), 0.5 * 0.0254);
}

TEST(ScaleBar, LengthThatJustFitsIsTaken) {
  for (int exponent = -9; exponent <= 9; ++exponent) {
    const double power = std::pow(10.0, exponent);
    for (const double step : {1.0, 2.0, 5.0})
      EXPECT_NEAR(scaleBarLength(step * power, 1.0) / (step * power), 1.0, 1e-12) << step << " " << exponent;
  }
}

TEST(ScaleBar, FillsAtLeastTwoFifthsOfItsRoom) {
  for (double room = 1e-6; room < 1e6; room *= 1.0371) {
    const double length = scaleBarLength(room, 1e-3);
    EXPECT_LE(length, room * (1.0 + 1e-8));
    EXPECT_GE(length, 0.4 * room * (1.0 - 1e-8));
  }
}

TEST(ScaleBar, WithoutRoomThereIsNone) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double room : {0.0, -1.0, infinity, std::nan("")}) {
    EXPECT_EQ(scaleBarLength(room, 1e-3), 0.0);
    EXPECT_EQ(scaleBarLength(1.0, room), 0.0);
  }
}

}  // namespace
}  // namespace nearfit::scale_bar_test
