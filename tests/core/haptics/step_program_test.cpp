#include "core/haptics/step_program.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/exact/exact_step.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/step_problems.h"
#include "tests/support/trial_share.h"

namespace nearfit::step_program_test {
namespace {

using test::kStepProblemKinds;
using test::makeStepProblem;
using test::StepProblem;
using test::StepProblemKind;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// What rounding may leave of a condition, as a fraction of the lengths in play or of the sum of pushes.
constexpr double kRounding = 1e-14;

/// Twice what the program promises of rows.
constexpr double kRows = 2.0 * DualStepSolver::kRowTolerance;

/// Of the optimum, as a fraction of the lengths in play: what the tolerance of rows can make of it where rows
/// meet at the angles that the problems have.
constexpr double kOptimum = 1e-9;

double valueOf(const StepVector& a, const StepVector& y) {
  double sum = 0.0;
  for (std::size_t k = 0; k < 6; ++k)
    sum += a[k] * y[k];
  return sum;
}

double distanceBetween(const StepVector& a, const StepVector& b) {
  double squared = 0.0;
  for (std::size_t k = 0; k < 6; ++k)
    squared += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(squared);
}

StepVector scaled(StepVector y, double factor) {
  for (double& value : y)
    value *= factor;
  return y;
}

/// By how much the worst row, or the floor, is violated [m].
double violation(const StepProblem& problem, const StepVector& y, double t) {
  double worst = problem.goal.cost.floor - t;
  for (std::size_t i = 0; i < problem.rows.size(); ++i)
    worst = std::max(worst, t - problem.rows.distance(i) - valueOf(problem.rows.row(i), y));
  return worst;
}

/// The conditions of Karush, Kuhn and Tucker, which a convex program's optimum meets and nothing else does.
void expectOptimal(const StepProblem& problem, const StepSolution& solution) {
  const ClearanceCost& cost = problem.goal.cost;
  const double length = test::lengthOf(problem);
  ASSERT_TRUE(solution.isExact);
  EXPECT_LE(violation(problem, solution.y, solution.t), kRows * length);
  StepVector push = scaled(problem.goal.wanted, solution.scale);
  double total = 0.0, sizes = length;
  for (const ActivePair& pair : solution.pairs()) {
    const StepVector a = problem.rows.row(pair.row);
    EXPECT_GE(pair.multiplier, 0.0);
    EXPECT_NEAR(valueOf(a, solution.y) + problem.rows.distance(pair.row), solution.t, kRounding * length);
    for (std::size_t k = 0; k < 6; ++k)
      push[k] += pair.multiplier * a[k];
    total += pair.multiplier;
    sizes += pair.multiplier * problem.rows.largestNorm();
  }
  EXPECT_GE(solution.floorMultiplier, 0.0);
  if (solution.floorMultiplier > 0.0) {
    EXPECT_NEAR(solution.t, cost.floor, kRounding * length);
  }
  EXPECT_LE(distanceBetween(solution.y, push), kRounding * sizes);
  EXPECT_NEAR(cost.weight * (solution.t - cost.margin), solution.floorMultiplier - total,
              kRounding * (sizes + cost.weight * length));
}

/// Calls with problems of all kinds and numbers of rows.
template <typename Check>
void forManyProblems(std::uint64_t seeds, std::initializer_list<std::size_t> rowCounts, Check check) {
  for (const StepProblemKind kind : kStepProblemKinds)
    for (const std::size_t rows : rowCounts)
      for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        SCOPED_TRACE(nameOf(kind) + ", rows " + std::to_string(rows) + ", seed " + std::to_string(seed));
        check(makeStepProblem(kind, 1000 * rows + seed, rows));
        if (testing::Test::HasFailure()) return;
      }
}

StepProblem problemOf(std::initializer_list<std::pair<StepVector, double>> rows, const StepVector& wanted,
                      const ClearanceCost& cost) {
  StepProblem out;
  for (const auto& [a, d] : rows)
    EXPECT_TRUE(out.rows.add(a, d));
  out.goal.wanted = wanted;
  out.goal.cost = cost;
  return out;
}

TEST(StepProgram, WithoutRowsTheStepIsTheOneWanted) {
  const StepProblem problem = problemOf({}, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, {0.5, 100.0, 0.0});
  const StepSolution solution = StepProgram().solve(problem.rows, problem.goal);
  EXPECT_TRUE(solution.isExact);
  EXPECT_EQ(solution.y, problem.goal.wanted);
  EXPECT_EQ(solution.t, 0.5);
  EXPECT_EQ(solution.scale, 1.0);
  EXPECT_EQ(solution.activeCount, 0u);
}

TEST(StepProgram, AWallStopsThePartWhereItsPushAndTheMarginsBalance) {
  // The row is y_z - t >= -3; with push l: y_z = -4 + l, t = 1 - l / 100. As an equality: l = 2 / 1.01.
  const StepProblem problem =
      problemOf({{{0.0, 0.0, 1.0, 0.0, 0.0, 0.0}, 3.0}}, {7.0, 0.0, -4.0, 0.0, 0.0, 0.0}, {1.0, 100.0, 0.0});
  const StepSolution solution = StepProgram().solve(problem.rows, problem.goal);
  const double push = 2.0 / 1.01;
  ASSERT_EQ(solution.activeCount, 1u);
  EXPECT_NEAR(solution.active[0].multiplier, push, 1e-14);
  EXPECT_NEAR(solution.y[2], -4.0 + push, 1e-14);
  EXPECT_NEAR(solution.t, 1.0 - push / 100.0, 1e-14);
  EXPECT_EQ(solution.y[0], 7.0);
}

TEST(StepProgram, TheFloorHoldsHoweverHardThePartIsPushed) {
  // Without a floor t would be 1 - 1e6 / 101 or so; with it y_z = 0.25 - 3.
  const StepProblem problem =
      problemOf({{{0.0, 0.0, 1.0, 0.0, 0.0, 0.0}, 3.0}}, {0.0, 0.0, -1e6, 0.0, 0.0, 0.0}, {1.0, 100.0, 0.25});
  const StepSolution solution = StepProgram().solve(problem.rows, problem.goal);
  EXPECT_NEAR(solution.t, 0.25, 1e-9);
  EXPECT_NEAR(solution.y[2], -2.75, 1e-9);
  EXPECT_GT(solution.floorMultiplier, 0.0);
}

TEST(StepProgram, InAGapNarrowerThanTwoMarginsThePartStandsInTheMiddle) {
  const StepProblem problem = problemOf(
      {{{1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.1}, {{-1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.3}}, {}, {1.0, 1e6, 0.0});
  const StepSolution solution = StepProgram().solve(problem.rows, problem.goal);
  // Both rows active: t = 0.2, y_x = 0.1.
  EXPECT_NEAR(solution.t, 0.2, 1e-14);
  EXPECT_NEAR(solution.y[0], 0.1, 1e-14);
}

TEST(StepProgram, SolutionsMeetTheConditionsOfKarushKuhnAndTucker) {
  StepProgram program;
  forManyProblems(100, {0, 1, 2, 3, 5, 8, 16, 33, 64, 128, 256}, [&](const StepProblem& problem) {
    const StepSolution solution = program.solve(problem.rows, problem.goal);
    expectOptimal(problem, solution);
    EXPECT_EQ(solution.scale, 1.0);
    EXPECT_LE(solution.changes, StepProgram::kMaxChanges);
  });
}

TEST(StepProgram, SolutionsEqualThoseOfExactArithmetic) {
  StepProgram program;
  forManyProblems(20 / test::kTrialShare, {0, 1, 3, 8, 32, 100, 256}, [&](const StepProblem& problem) {
    const StepSolution solution = program.solve(problem.rows, problem.goal);
    const test::ExactStep exact = test::exactStep(problem.rows, problem.goal.cost, problem.goal.wanted);
    const double length = test::lengthOf(problem);
    ASSERT_TRUE(exact.isSolved && solution.isExact);
    EXPECT_LE(distanceBetween(solution.y, exact.y), kOptimum * length);
    EXPECT_NEAR(solution.t, exact.t, kOptimum * length);
  });
}

TEST(StepProgram, NoPointMovesFartherThanTheReachAndTheStepIsTheOptimumForAShorterGoal) {
  StepProgram program;
  std::size_t shortened = 0, within = 0, parts = 0;
  forManyProblems(40, {0, 1, 2, 5, 16, 64, 256}, [&](StepProblem problem) {
    for (const double margins : {0.3, 1.5, 20.0}) {
      problem.goal.reach = margins * problem.goal.cost.margin;
      const StepSolution solution = program.solve(problem.rows, problem.goal);
      ASSERT_TRUE(solution.isExact);
      EXPECT_LE(displacementOf(solution.y, problem.goal), problem.goal.reach);
      EXPECT_LE(violation(problem, solution.y, solution.t), kRows * test::lengthOf(problem));
      EXPECT_LE(solution.solves, StepProgram::kMaxSolves);
      EXPECT_LE(solution.changes, StepProgram::kMaxChanges);
      if (solution.share < 1.0) {
        ++parts;
        EXPECT_GE(solution.displacement, (1.0 - 1e-9) * problem.goal.reach);
        continue;
      }
      expectOptimal(problem, solution);
      if (solution.scale == 1.0) continue;
      ++shortened;
      if (solution.displacement >= 0.9 * problem.goal.reach) ++within;
    }
  });
  EXPECT_GT(shortened, 1000u);
  EXPECT_GT(parts, 100u);
  // The search is bounded: where the step is almost the same for most scales it may end early.
  EXPECT_GT(static_cast<double>(within), 0.99 * static_cast<double>(shortened));
}

TEST(StepProgram, AShortenedStepEqualsThatOfExactArithmeticForTheShorterGoal) {
  StepProgram program;
  forManyProblems(4, {2, 8, 64}, [&](StepProblem problem) {
    problem.goal.reach = 1.5 * problem.goal.cost.margin;
    const StepSolution solution = program.solve(problem.rows, problem.goal);
    const StepVector wanted = scaled(problem.goal.wanted, solution.scale);
    const test::ExactStep exact = test::exactStep(problem.rows, problem.goal.cost, wanted);
    ASSERT_TRUE(exact.isSolved && solution.isExact);
    EXPECT_LE(distanceBetween(solution.y, scaled(exact.y, solution.share)),
              kOptimum * test::lengthOf(problem));
  });
}

TEST(StepProgram, WhereTheChangesAreUsedUpTheStepStillKeepsAllRows) {
  DualStepSolver solver;
  std::size_t ended = 0;
  forManyProblems(10, {1, 3, 16, 128}, [&](const StepProblem& problem) {
    for (unsigned most = 0; most < 12; ++most) {
      solver.begin(problem.rows, problem.goal.cost, most);
      const DualStepSolver::Point point = solver.solve(problem.goal.wanted);
      EXPECT_LE(violation(problem, point.y, point.t), kRows * test::lengthOf(problem));
      if (!point.isExact) ++ended;
    }
  });
  EXPECT_GT(ended, 1000u);
}

TEST(StepProgram, AFloorAboveTheLeastDistanceIsLoweredToItSoThatStandingStillIsAllowed) {
  const StepProblem problem = problemOf(
      {{{1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.1}, {{-1.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.1}}, {}, {1.0, 100.0, 0.7});
  const StepSolution solution = StepProgram().solve(problem.rows, problem.goal);
  EXPECT_TRUE(solution.isExact);
  EXPECT_NEAR(solution.t, 0.1, 1e-15);
  EXPECT_LE(distanceBetween(solution.y, {}), 1e-15);
}

TEST(StepProgram, AGoalThatIsNotANumberOrOutOfBoundsLeavesThePartWhereItIs) {
  StepProblem problem = makeStepProblem(StepProblemKind::Ring, 1, 16);
  const StepGoal good = problem.goal;
  const auto expectStill = [&](auto change) {
    problem.goal = good;
    change(problem.goal);
    const StepSolution solution = StepProgram().solve(problem.rows, problem.goal);
    EXPECT_FALSE(solution.isExact);
    EXPECT_EQ(solution.y, StepVector{});
    EXPECT_EQ(solution.t, problem.rows.leastClearance({}).clearance);
  };
  for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300}) {
    expectStill([&](StepGoal& goal) { goal.wanted[4] = bad; });
    expectStill([&](StepGoal& goal) { goal.cost.margin = bad; });
    expectStill([&](StepGoal& goal) { goal.radius = bad; });
    expectStill([&](StepGoal& goal) { goal.gyration.y = bad; });
  }
  for (const double bad : {kNaN, kInfinity, 0.0, -1.0})
    expectStill([&](StepGoal& goal) { goal.cost.weight = bad; });
  for (const double bad : {kNaN, -1.0})
    expectStill([&](StepGoal& goal) { goal.reach = bad; });
  for (const double bad : {kNaN, kInfinity})
    expectStill([&](StepGoal& goal) { goal.cost.floor = bad; });
  expectStill([](StepGoal& goal) { goal.gyration.x = 0.0; });
}

TEST(StepProgram, TheLargestNumbersAllowedGiveAFiniteStepWithinTheReach) {
  StepProgram program;
  for (const double size : {1e-300, 1e-12, 1e3, StepRows::kLargest}) {
    StepProblem problem;
    for (const double sign : {1.0, -1.0})
      for (const double turn : {size, -size, 0.5 * size})
        EXPECT_TRUE(problem.rows.add({0.0, 0.0, sign, turn, 0.0, -turn}, 1e-300 * size));
    problem.goal.wanted.fill(kLongestStep);
    problem.goal.cost = {kLongestStep, 1e6, 0.0};
    problem.goal.gyration = glm::dvec3(kShortestGyration);
    problem.goal.radius = kLongestStep;
    problem.goal.reach = 1.0;
    const StepSolution solution = program.solve(problem.rows, problem.goal);
    EXPECT_TRUE(std::isfinite(distanceBetween(solution.y, {})) && std::isfinite(solution.t)) << size;
    EXPECT_LE(displacementOf(solution.y, problem.goal), 1.0) << size;
  }
}

TEST(StepProgram, WithoutReachNothingMoves) {
  StepProblem problem = makeStepProblem(StepProblemKind::Floor, 1, 16);
  problem.goal.reach = 0.0;
  const StepSolution solution = StepProgram().solve(problem.rows, problem.goal);
  EXPECT_EQ(solution.y, StepVector{});
  EXPECT_EQ(solution.displacement, 0.0);
}

TEST(StepProgram, AllocatesNothing) {
  StepProblem problem = makeStepProblem(StepProblemKind::Ring, 3, 256);
  problem.goal.reach = 1.5 * problem.goal.cost.margin;
  StepProgram program;
  test::resetAllocationCount();
  test::startCountingAllocations();
  const StepVector first = problem.rows.row(0);
  problem.rows.add(first, problem.rows.distance(0));
  const StepSolution solution = program.solve(problem.rows, problem.goal);
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0u);
  EXPECT_GT(solution.solves, 1u);
}

}  // namespace
}  // namespace nearfit::step_program_test
