#include "tests/bench/path_row.h"

#include <gtest/gtest.h>

namespace nearfit::bench::path_row_test {
namespace {

PathRow rowOf(double certified, double verified, std::size_t meetings) {
  return {.scene = "peg",
          .poses = 4000,
          .triangles = 576,
          .certified = certified,
          .verified = verified,
          .places = 1'000'000,
          .meetings = meetings,
          .goal = 10.0};
}

TEST(PathRow, IsMetWithinBothTimesAndWithoutAMeeting) {
  EXPECT_TRUE(rowOf(10.0, 20.0, 0).isMet());
  EXPECT_FALSE(rowOf(10.1, 1.0, 0).isMet());
  EXPECT_FALSE(rowOf(1.0, 20.1, 0).isMet());
  EXPECT_FALSE(rowOf(1.0, 1.0, 1).isMet());
}

TEST(PathRow, HasItsTimesRatioCountsAndGoalInTheTable) {
  EXPECT_EQ(pathCsvHeader(),
            "scene,poses,triangles,certified_s,verified_s,ratio,places,meetings,goal_s,met\n");
  EXPECT_EQ(pathCsvLine(rowOf(2.0, 3.0, 0)), "peg,4000,576,2,3,1.5,1000000,0,10,yes\n");
  EXPECT_EQ(pathCsvLine(rowOf(2.0, 3.0, 7)), "peg,4000,576,2,3,1.5,1000000,7,10,no\n");
  EXPECT_NE(pathTableLine(rowOf(12.0, 3.0, 0)).find("NO"), std::string::npos);
}

TEST(PathRow, WithoutAGoalNothingIsMetOrMissed) {
  PathRow row = rowOf(2.0, 3.0, 0);
  row.goal = 0.0;
  EXPECT_EQ(pathCsvLine(row), "peg,4000,576,2,3,1.5,1000000,0,,\n");
}

}  // namespace
}  // namespace nearfit::bench::path_row_test
