#include "tests/bench/suggest_row.h"

#include <gtest/gtest.h>

namespace nearfit::bench::suggest_row_test {
namespace {

SuggestedPath confirmedPath(double seconds) {
  SuggestedPath path;
  path.isSaidFound = true;
  path.seconds = seconds;
  path.method = PathSearchMethod::Sliding;
  path.proof = {.isCertified = true, .isVerified = true};
  path.looks = {.places = 100, .looks = 100, .tested = 3};
  return path;
}

/// So many of ten seeds find a path in 2 s, the others search for 31 s.
SuggestRow rowWith(int found, bool isFoundLate) {
  SuggestRow row{.scene = "peg out"};
  for (int seed = 0; seed < 10; ++seed) {
    SuggestedPath path = confirmedPath(seed < found ? 2.0 : 31.0);
    path.isSaidFound = seed < found || isFoundLate;
    row.add(path);
  }
  return row;
}

TEST(SuggestRow, NineOfTenSeedsHaveToFindAPath) {
  EXPECT_EQ(rowWith(9, false).wanted(), 9U);
  EXPECT_TRUE(rowWith(9, false).isMet());
  EXPECT_FALSE(rowWith(8, false).isMet());
  EXPECT_EQ(
      suggestCsvHeader(),
      "scene,seeds,found,p50_s,max_s,goal,met,said_found,certified,verified,free,places,tested,meetings,"
      "straight,sliding,sliding_trees,connected_trees\n");
  EXPECT_EQ(suggestCsvLine(rowWith(9, false)),
            "peg out,10,9,2,31,9 of 10 within 30 s,yes,9,9,9,9,100,27,0,0,9,0,0\n");
}

TEST(SuggestRow, APathThatIsFoundAfterTheLimitDoesNotCount) {
  const SuggestRow row = rowWith(8, true);
  EXPECT_EQ(row.found, 8U);
  EXPECT_EQ(row.said, 10U);
  EXPECT_FALSE(row.isMet());
}

TEST(SuggestRow, OnePathThatMeetsOrIsNotVerifiedMissesTheGoal) {
  SuggestRow meeting = rowWith(9, false);
  SuggestedPath path = confirmedPath(2.0);
  path.looks.meetings = 1;
  meeting.add(path);
  EXPECT_EQ(meeting.found, 9U);
  EXPECT_FALSE(meeting.isMet());

  SuggestRow refused = rowWith(9, false);
  path = confirmedPath(2.0);
  path.proof.isVerified = false;
  refused.add(path);
  EXPECT_EQ(refused.found, 9U);
  EXPECT_FALSE(refused.isMet());
}

TEST(SuggestRow, APathThatWasNotLookedAtIsNotConfirmed) {
  SuggestedPath path = confirmedPath(2.0);
  path.looks = {};
  EXPECT_FALSE(path.isConfirmed());
}

}  // namespace
}  // namespace nearfit::bench::suggest_row_test
