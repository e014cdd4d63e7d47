#include "tests/bench/skip_row.h"

#include <sstream>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/bench/skips.h"

namespace nearfit::bench::skip_row_test {
namespace {

SkipRow rowOf(std::vector<std::uint64_t> with, std::vector<std::uint64_t> without) {
  return {"skip", "where", "query", "remark", {{1e-6}, 0, std::move(with)}, {{4e-6}, 0, std::move(without)}};
}

TEST(SkipRow, AnotherAnswerOrNoneIsNotTheSame) {
  EXPECT_TRUE(rowOf({1, 2}, {1, 2}).isSame());
  EXPECT_FALSE(rowOf({1, 2}, {1, 3}).isSame());
  EXPECT_FALSE(rowOf({1, 2}, {1}).isSame());
  EXPECT_FALSE(rowOf({}, {}).isSame());
}

TEST(SkipRow, AnswersThatDifferAreAnError) {
  const std::vector<SkipRow> good{rowOf({1}, {1})}, bad{rowOf({1}, {1}), rowOf({1}, {2})};
  EXPECT_NO_THROW(checkSame(good));
  EXPECT_THROW(checkSame(bad), Error);
}

TEST(SkipRow, RatiosSayHowManyTimesAsLongItTakesWithoutTheSkip) {
  EXPECT_EQ(skipCsvLine(rowOf({1}, {1})),
            "skip,where,query,1,1.000,4.000,1.000,4.000,4.0000,4.0000,0,0,1,remark\n");
}

TEST(SkipRow, RowsReadBackAsTheyWereWritten) {
  const SkipRow row = rowOf({1, ~std::uint64_t{0}}, {3});
  std::stringstream text;
  writeSkipRows(text, {&row, 1});
  const std::vector<SkipRow> read = readSkipRows(text);
  ASSERT_EQ(read.size(), 1U);
  EXPECT_EQ(skipCsvLine(read[0]), skipCsvLine(row));
  EXPECT_EQ(read[0].with.answers, row.with.answers);
  EXPECT_EQ(read[0].without.seconds, row.without.seconds);
  std::istringstream nonsense("no rows");
  EXPECT_THROW(readSkipRows(nonsense), Error);
}

TEST(TakeTurns, BothWaysGetEachQuestionInEachRoundAndAnswerItOnce) {
  std::size_t asked = 0, last = 0;
  const SkipWay way{[&](std::size_t question) {
                      ++asked;
                      last = question;
                    },
                    [&] { return std::uint64_t{last}; }};
  SkipRow row;
  RunOptions options;
  options.block = 4;
  options.warmUp = 2;
  options.rounds = 3;
  takeTurns(row, 10, way, way, options);
  EXPECT_EQ(row.with.seconds.size(), 30U);
  EXPECT_EQ(row.without.seconds.size(), 30U);
  EXPECT_EQ(row.with.answers, (std::vector<std::uint64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_TRUE(row.isSame());
  // Before the blocks that begin at 4 and 8 two questions each warm up.
  EXPECT_EQ(asked, 2U * 3U * (10U + 4U));
}

/// Each skip in short, but for pictures, which need a display.
TEST(Skips, AnswersAreTheSameWithoutThem) {
  SkipOptions options;
  options.path.poses = 40;
  options.run.block = 20;
  options.repeats = 1;
  options.farParts = 30;
  options.instances = 4;
  options.sceneParts = 5;
  std::vector<SkipEntry> skips = tickSkips();
  for (const SkipEntry& skip : loadSkips())
    skips.push_back(skip);
  for (const SkipEntry& skip : skips) {
    const std::vector<SkipRow> rows = skip.measure(options);
    EXPECT_FALSE(rows.empty()) << skip.name;
    for (const SkipRow& row : rows) {
      EXPECT_TRUE(row.isSame()) << skip.name << ' ' << row.where;
      EXPECT_EQ(row.skip, skip.name);
      EXPECT_EQ(row.with.seconds.size(), row.without.seconds.size());
    }
  }
}

}  // namespace
}  // namespace nearfit::bench::skip_row_test
