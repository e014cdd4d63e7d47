#include "tests/bench/agreement.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace nearfit::bench::agreement_test {
namespace {

constexpr double kCutoff = 0.05, kSize = 1.0, kFar = std::numeric_limits<double>::infinity();

const MethodEntry kSet{"set", AnswerKind::FullSet, "", 1e-9, {}};
const MethodEntry kOtherSet{"other set", AnswerKind::FullSet, "", 1e-9, {}};
const MethodEntry kDistance{"distance", AnswerKind::Distance, "", 1e-9, {}};

MethodRun runOf(const MethodEntry& method, std::vector<Answer> answers) {
  MethodRun run{&method, {}, {}, std::move(answers), {}};
  for (std::size_t i = 0; i < run.answers.size(); ++i)
    run.poses.push_back(i);
  return run;
}

/// How a set's answer compares with that of a library's distance.
Agreement compared(const Answer& set, double distance) {
  const std::vector<MethodRun> runs{runOf(kSet, {set}), runOf(kDistance, {{distance, 1, true}})};
  return compareRuns(runs, kCutoff, kSize).front();
}

TEST(CompareRuns, EqualDistancesAgree) {
  EXPECT_TRUE(compared({0.01, 3, true}, 0.01).holds);
  EXPECT_TRUE(compared({0.01, 3, true}, 0.01 + 1e-12).holds);
}

TEST(CompareRuns, ADifferentDistanceIsReported) {
  const Agreement agreement = compared({0.012, 3, true}, 0.01);
  EXPECT_FALSE(agreement.holds);
  EXPECT_NEAR(agreement.worstDistance, 0.002, 1e-15);
}

TEST(CompareRuns, NothingWithinTheCutoffAgreesWithADistanceBeyondIt) {
  EXPECT_TRUE(compared({kFar, 0, true}, 0.06).holds);
  EXPECT_TRUE(compared({kFar, 0, true}, kCutoff).holds);
}

TEST(CompareRuns, AMissedContactIsReported) {
  const Agreement agreement = compared({kFar, 0, true}, 0.04);
  EXPECT_FALSE(agreement.holds);
  EXPECT_TRUE(std::isinf(agreement.worstDistance));
}

TEST(CompareRuns, APathThatTouchesIsReported) {
  const Agreement agreement = compared({0.0, 1, true}, 0.0);
  EXPECT_FALSE(agreement.holds);
  EXPECT_EQ(agreement.touching, 1U);
}

TEST(CompareRuns, AnIncompleteSetIsReported) {
  EXPECT_FALSE(compared({0.01, 3, false}, 0.01).holds);
}

TEST(CompareRuns, SetsOfDifferentNumbersOfMinimaDoNotAgree) {
  const std::vector<MethodRun> runs{runOf(kSet, {{0.01, 3, true}, {0.02, 5, true}}),
                                    runOf(kOtherSet, {{0.01, 3, true}, {0.02, 4, true}})};
  const std::vector<Agreement> agreements = compareRuns(runs, kCutoff, kSize);
  EXPECT_TRUE(agreements[0].holds);
  EXPECT_FALSE(agreements[1].holds);
  EXPECT_EQ(agreements[1].differentCounts, 1U);
}

TEST(CompareRuns, AMethodThatSkipsPosesIsComparedAtItsOwn) {
  MethodRun sparse = runOf(kSet, {{0.03, 1, true}});
  sparse.poses = {2};
  const std::vector<MethodRun> runs{sparse,
                                    runOf(kDistance, {{0.01, 1, true}, {0.02, 1, true}, {0.03, 1, true}})};
  EXPECT_TRUE(compareRuns(runs, kCutoff, kSize).front().holds);
}

}  // namespace
}  // namespace nearfit::bench::agreement_test
