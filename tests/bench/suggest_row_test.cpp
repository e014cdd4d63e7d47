#include "tests/bench/suggest_row.h"

#include <gtest/gtest.h>

namespace nearfit::bench::suggest_row_test {
namespace {

/// So many of ten seeds find a path in 2 s, the others search for 31 s.
SuggestRow rowWith(int found, bool isFoundLate) {
  SuggestRow row{.scene = "peg out"};
  for (int seed = 0; seed < 10; ++seed)
    row.add(seed < found || isFoundLate, seed < found ? 2.0 : 31.0);
  return row;
}

TEST(SuggestRow, NineOfTenSeedsHaveToFindAPath) {
  EXPECT_EQ(rowWith(9, false).wanted(), 9U);
  EXPECT_TRUE(rowWith(9, false).isMet());
  EXPECT_FALSE(rowWith(8, false).isMet());
  EXPECT_EQ(suggestCsvHeader(), "scene,seeds,found,p50_s,max_s,goal,met\n");
  EXPECT_EQ(suggestCsvLine(rowWith(9, false)), "peg out,10,9,2,31,9 of 10 within 30 s,yes\n");
}

TEST(SuggestRow, APathThatIsFoundAfterTheLimitDoesNotCount) {
  const SuggestRow row = rowWith(8, true);
  EXPECT_EQ(row.found, 8U);
  EXPECT_EQ(suggestCsvLine(row), "peg out,10,8,2,31,9 of 10 within 30 s,no\n");
}

}  // namespace
}  // namespace nearfit::bench::suggest_row_test
