#include "core/path/path_rows.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/path_scenes.h"

namespace nearfit::path_rows_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(PathRows, PosesAreAddedEvenlyAndThoseOfThePathStay) {
  AssemblyPath path = test::pathThrough("Peg", {test::at(0, 0, 0), test::at(1, 0, 0), test::at(1, 2, 0)});
  path.poses[2].time = 1.25;
  const AssemblyPath sampled = sampledPath(path, 0.25, 100);
  ASSERT_EQ(sampled.poses.size(), 6U);
  for (std::size_t i = 0; i < sampled.poses.size(); ++i)
    EXPECT_DOUBLE_EQ(sampled.poses[i].time, 0.25 * static_cast<double>(i));
  EXPECT_NEAR(sampled.poses[1].worldFromLead.translation.x, 0.25, 1e-15);
  EXPECT_EQ(sampled.poses[4].worldFromLead.translation, path.poses[1].worldFromLead.translation);
  EXPECT_EQ(sampled.poses[5].worldFromLead.translation, path.poses[2].worldFromLead.translation);
  EXPECT_EQ(sampled.parts, path.parts);
}

TEST(PathRows, TheStepGrowsRatherThanTheNumberOfPoses) {
  const AssemblyPath path = test::pathThrough("Peg", {test::at(0, 0, 0), test::at(1, 0, 0)});
  EXPECT_EQ(sampledPath(path, 1e-6, 10).poses.size(), 11U);
  EXPECT_EQ(sampledPath(path, 1e-6, 0).poses.size(), 2U);
  EXPECT_EQ(sampledPath(path, 5.0, 10).poses.size(), 2U);
  EXPECT_LE(sampledPath(path, 1e-9, 10'000'000).poses.size(), kMaxPathPoses);
}

TEST(PathRows, BeginAtZeroWithHandAndPartAtThePose) {
  AssemblyPath path = test::pathThrough("Peg", {test::at(1, 0, 0), test::at(2, 0, 0)});
  path.poses[0].time = 7.0;
  path.poses[1].time = 9.5;
  const std::vector<MotionRow> rows = rowsOfPath(path);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].time, 0.0);
  EXPECT_EQ(rows[1].time, 2.5);
  EXPECT_EQ(rows[1].proxy.translation.x, 2.0);
  EXPECT_EQ(rows[1].handle.translation.x, 2.0);
  EXPECT_EQ(rows[0].distance, kInfinity);
}

TEST(PathRows, HaveTheLeastClearanceToAnyPart) {
  const AssemblyPath path =
      test::pathThrough("Peg", {test::at(0, 0, 0), test::at(1, 0, 0), test::at(2, 0, 0)});
  std::vector<MotionRow> rows = rowsOfPath(path);
  setDistances(rows, {{PartId{1}, {0.3, kInfinity, kInfinity}}, {PartId{2}, {0.2, 0.5, kInfinity}}});
  EXPECT_EQ(rows[0].distance, 0.2);
  EXPECT_EQ(rows[1].distance, 0.5);
  EXPECT_EQ(rows[2].distance, kInfinity);
}

}  // namespace
}  // namespace nearfit::path_rows_test
