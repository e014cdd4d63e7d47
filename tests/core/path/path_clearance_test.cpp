#include "core/path/path_clearance.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/path_scenes.h"

namespace nearfit::path_clearance_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// The cube past the post, in 61 poses.
test::PathScene manyPoses(double gap) {
  test::PathScene made = test::cubePastCube(gap);
  made.path.poses.clear();
  for (int i = 0; i <= 60; ++i)
    made.path.poses.push_back({i / 60.0, test::at(-3.0 + 0.1 * i, 1.0 + gap, 0.0)});
  return made;
}

TEST(PathClearance, FollowsTheFormulaWithinTheRangeAndIsInfiniteBeyond) {
  const double gap = 0.25, range = 1.0;
  const test::PathScene made = manyPoses(gap);
  const std::vector<PathClearance> found = clearancesAlong(made.scene, made.path, range);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].other, made.part("Post").id);
  ASSERT_EQ(found[0].distances.size(), made.path.poses.size());
  for (std::size_t i = 0; i < made.path.poses.size(); ++i) {
    const double wanted = test::cubeDistance(gap, made.path.poses[i].time);
    if (wanted > range)
      EXPECT_TRUE(std::isinf(found[0].distances[i])) << i;
    else
      EXPECT_NEAR(found[0].distances[i], wanted, 1e-12) << i;
  }
  const std::optional<LeastPathClearance> least = leastOf(found, made.path);
  ASSERT_TRUE(least.has_value());
  EXPECT_NEAR(least->distance, gap, 1e-12);
  EXPECT_LE(std::abs(-3.0 + 6.0 * least->time), 1.0 + 1e-9);
}

TEST(PathClearance, ASurfaceThatIsMetIsAtZero) {
  const std::vector<PathClearance> found = [] {
    const test::PathScene made = manyPoses(-0.25);
    return clearancesAlong(made.scene, made.path, 0.5);
  }();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].distances[30], 0.0, 1e-12);
}

TEST(PathClearance, PartsThatStayBeyondTheRangeAreLeftOut) {
  const test::PathScene made = manyPoses(2.0);
  const std::vector<PathClearance> found = clearancesAlong(made.scene, made.path, 0.5);
  EXPECT_TRUE(found.empty());
  EXPECT_FALSE(leastOf(found, made.path).has_value());
}

TEST(PathClearance, CsvHasAColumnForEachPartAndNoFormulas) {
  test::PathScene made = manyPoses(0.25);
  Part post = made.part("Post");
  post.name = "=1+1";
  made.scene.replace(post);
  const std::string text =
      pathClearanceCsv(made.scene, made.path, clearancesAlong(made.scene, made.path, 1.0));
  EXPECT_THAT(text, StartsWith("t_s,\"'=1+1 [m]\"\n0,inf\n"));
  EXPECT_THAT(text, HasSubstr("\n0.5,0.2"));
}

TEST(PathClearance, ARangeThatIsNoLengthIsRefused) {
  const test::PathScene made = manyPoses(0.25);
  for (const double range : {0.0, -1.0, std::nan(""), static_cast<double>(INFINITY)})
    EXPECT_THROW(clearancesAlong(made.scene, made.path, range), UsageError);
}

}  // namespace
}  // namespace nearfit::path_clearance_test
