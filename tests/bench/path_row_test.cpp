#include "tests/bench/path_row.h"

#include <gtest/gtest.h>

namespace nearfit::bench::path_row_test {
namespace {

PathRow rowOf(double certified, double verified, std::size_t meetings) {
  return {.scene = "peg",
          .poses = 4000,
          .triangles = 576,
          .moving = 1,
          .others = 2,
          .certified = certified,
          .verified = verified,
          .looks = {.places = 1'000'000,
                    .looks = 2'000'000,
                    .tested = 300,
                    .measured = 40'000,
                    .boxed = 500'000,
                    .meetings = meetings},
          .goal = 10.0};
}

TEST(PathRow, IsMetWithinBothTimesAndWithoutAMeeting) {
  EXPECT_TRUE(rowOf(10.0, 20.0, 0).isMet());
  EXPECT_FALSE(rowOf(10.1, 1.0, 0).isMet());
  EXPECT_FALSE(rowOf(1.0, 20.1, 0).isMet());
  EXPECT_FALSE(rowOf(1.0, 1.0, 1).isMet());
}

TEST(PathRow, ProcessesAndPlainTestsHaveToMeetTheGoalToo) {
  PathRow row = rowOf(1.0, 1.0, 0);
  row.certifyProcess = 10.1;
  EXPECT_FALSE(row.isMet());
  row.certifyProcess = 10.0;
  row.verifyProcess = 20.1;
  EXPECT_FALSE(row.isMet());
  row.verifyProcess = 20.0;
  EXPECT_TRUE(row.isMet());
  row.plain = {.places = 10, .looks = 10, .tested = 10, .meetings = 1};
  EXPECT_FALSE(row.isMet());
}

TEST(PathRow, HasItsTimesRatioCountsAndGoalInTheTable) {
  EXPECT_EQ(
      pathCsvHeader(),
      "scene,poses,triangles,certified_s,verified_s,ratio,places,meetings,goal_s,met,within_twice_certified,"
      "moving,others,certify_process_s,verify_process_s,looks,tested,measured,boxed,argued,plainly_tested,"
      "plain_meetings\n");
  EXPECT_EQ(pathCsvLine(rowOf(2.0, 3.0, 0)),
            "peg,4000,576,2,3,1.5,1000000,0,10,yes,yes,1,2,,,2000000,300,40000,500000,1459700,,\n");
  EXPECT_NE(pathCsvLine(rowOf(2.0, 3.0, 7)).find(",1000000,7,10,no,"), std::string::npos);
  EXPECT_NE(pathTableLine(rowOf(12.0, 3.0, 0)).find("NO"), std::string::npos);
}

TEST(PathRow, ReadsTwiceThatAsTwiceTheGoalAndSaysTheOtherReadingBeside) {
  const PathRow row = rowOf(1.0, 3.0, 0);
  EXPECT_TRUE(row.isMet());
  EXPECT_FALSE(row.isWithinTwice());
}

TEST(PathRow, WithoutAGoalNothingIsMetOrMissed) {
  PathRow row = rowOf(2.0, 3.0, 0);
  row.goal = 0.0;
  EXPECT_NE(pathCsvLine(row).find(",1000000,0,,,yes,"), std::string::npos);
}

}  // namespace
}  // namespace nearfit::bench::path_row_test
