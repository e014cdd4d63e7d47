#include "tests/bench/check_report.h"

#include <gtest/gtest.h>

#include "core/path/path_certifier.h"

namespace nearfit::bench::check_report_test {
namespace {

TEST(CheckReport, APartIsLiftedOutOfAStackFreely) {
  const ManyPartsScene many =
      stackedParts("stack", {.parts = 30, .shapes = 3, .frequency = 2, .clashEvery = 10});
  const LiftedPart lifted = liftOut(many, 40);
  EXPECT_EQ(lifted.path.poses.size(), 40U);
  EXPECT_EQ(lifted.scene.parts().size(), 30U);
  const double rise = lifted.path.poses.back().worldFromLead.translation.z -
                      lifted.path.poses.front().worldFromLead.translation.z;
  EXPECT_GT(rise, 0.5 * many.diagonal);
  EXPECT_TRUE(PathCertifier(lifted.scene, lifted.path, lifted.separation).prove(lifted.path).isFree());
}

}  // namespace
}  // namespace nearfit::bench::check_report_test
