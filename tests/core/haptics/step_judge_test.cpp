#include "core/haptics/step_judge.h"

#include <gtest/gtest.h>

namespace nearfit::step_judge_test {
namespace {

using Verdict = StepJudge::Verdict;

constexpr double kMargin = 1e-4;

/// A third of the way to a goal 3 m off, from the margin of 1 m, which the program thinks to keep.
StepTrial thirdOfTheWay() {
  StepGoal goal;
  goal.wanted = {3.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  goal.cost = {.margin = 1.0, .weight = 100.0, .floor = 0.5};
  StepSolution solution;
  solution.y = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  solution.t = 1.0;
  return StepTrial(goal, solution, 1.0);
}

TEST(StepJudge, WayAsLongAsTheDistanceIsNotProvedWhateverLiesAtItsEnd) {
  const StepJudge judge;
  EXPECT_EQ(judge.judge({kMargin, kMargin, 1.0, kMargin}, nullptr), Verdict::NotProved);
  EXPECT_EQ(judge.judge({0.99 * kMargin, kMargin, 1.0, kMargin}, nullptr), Verdict::Taken);
}

TEST(StepJudge, StepMayHalveTheMarginAndNoMore) {
  const StepJudge judge;
  EXPECT_EQ(judge.judge({0.6 * kMargin, kMargin, 0.5 * kMargin, kMargin}, nullptr), Verdict::Taken);
  EXPECT_EQ(judge.judge({0.6 * kMargin, kMargin, 0.49 * kMargin, kMargin}, nullptr), Verdict::NotProved);
  // From afar it may come down to half the margin, not to half of where it was.
  EXPECT_EQ(judge.judge({9.5 * kMargin, 10.0 * kMargin, 0.5 * kMargin, kMargin}, nullptr), Verdict::Taken);
}

TEST(StepJudge, BelowTheFloorOnlyStepsThatLeadAwayAreTaken) {
  StepJudge judge;
  judge.raiseFloor(0.02 * kMargin, kMargin, 0.0);  // To a quarter of the distance: 0.005 margins.
  const double here = 0.008 * kMargin, travel = 0.5 * here;
  EXPECT_EQ(judge.judge({travel, here, 0.0051 * kMargin, kMargin}, nullptr), Verdict::Taken);
  EXPECT_EQ(judge.judge({travel, here, 0.0049 * kMargin, kMargin}, nullptr), Verdict::NotProved);
  const double below = 0.003 * kMargin;
  EXPECT_EQ(judge.judge({0.5 * below, below, below, kMargin}, nullptr), Verdict::Taken);
  judge.dropFloor();
  EXPECT_EQ(judge.judge({travel, here, 0.0049 * kMargin, kMargin}, nullptr), Verdict::Taken);
}

TEST(StepJudge, LongStepIsProvedByItsWayAndKeepsMostOfTheMargin) {
  const StepJudge judge;
  const auto verdict = [&](double there, double onWay) {
    return judge.judge({20.0 * kMargin, kMargin, there, kMargin, 0.1 * kMargin, onWay}, nullptr);
  };
  EXPECT_EQ(verdict(0.95 * kMargin, 0.2 * kMargin), Verdict::Taken);
  EXPECT_EQ(verdict(0.95 * kMargin, 0.05 * kMargin), Verdict::NotProved) << "less than the deviation";
  EXPECT_EQ(verdict(0.8 * kMargin, 0.2 * kMargin), Verdict::NotProved) << "a shorter step may";
}

TEST(StepJudge, DeviationOfTheSearchedMeshShortensWhatIsProvedAndLeavesTheMargin) {
  const StepJudge judge;
  const double deviation = 0.2 * kMargin;
  EXPECT_EQ(judge.judge({0.79 * kMargin, kMargin, kMargin, kMargin, deviation}, nullptr), Verdict::Taken);
  EXPECT_EQ(judge.judge({0.81 * kMargin, kMargin, kMargin, kMargin, deviation}, nullptr), Verdict::NotProved);
  // From within the margin a step may halve the distance, but what is nearer than the deviation may touch.
  const double here = 0.3 * kMargin, travel = 0.05 * kMargin;
  EXPECT_EQ(judge.judge({travel, here, 1.01 * deviation, kMargin, deviation}, nullptr), Verdict::Taken);
  EXPECT_EQ(judge.judge({travel, here, 0.99 * deviation, kMargin, deviation}, nullptr), Verdict::NotProved);
}

TEST(StepJudge, StepWhoseEndIsTooNearToBeAGainIsBestShorter) {
  // At its end the goal is 2 m off: a cost of 4 m^2, of 9 m^2, and the lack of margin at 100 times its
  // square.
  StepTrial trial = thirdOfTheWay();
  EXPECT_TRUE(trial.isGain(0.8));   // 4 + 4 < 9
  EXPECT_FALSE(trial.isGain(0.7));  // 4 + 9 > 9
  // 9 - 6 s + 10 s^2 is least at 0.3.
  EXPECT_NEAR(trial.bestShare(), 0.3, 1e-12);
  StepJudge judge;
  EXPECT_EQ(judge.judge({0.9, 1.0, 0.7, 1.0}, &trial), Verdict::NoGain);
  trial.shorten(trial.bestShare());
  EXPECT_EQ(judge.judge({0.3, 1.0, 0.91, 1.0}, &trial), Verdict::Taken);  // 7.29 + 0.81 < 9
}

}  // namespace
}  // namespace nearfit::step_judge_test
