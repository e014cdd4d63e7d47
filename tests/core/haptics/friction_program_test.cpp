#include "core/haptics/friction_program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/support/allocation_hook.h"
#include "tests/support/step_problems.h"

namespace nearfit::friction_program_test {
namespace {

using test::makeStepProblem;
using test::StepProblem;
using test::StepProblemKind;

double valueOf(const StepVector& a, const StepVector& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < 6; ++k)
    sum += a[k] * b[k];
  return sum;
}

void addTo(StepVector& y, double factor, const StepVector& b) {
  for (std::size_t k = 0; k < 6; ++k)
    y[k] += factor * b[k];
}

double lengthOf(const StepVector& y) {
  return std::sqrt(valueOf(y, y));
}

/// What a unit push along an axis at an arm does, in the mass metric.
StepVector pushAt(const glm::dvec3& axis, const glm::dvec3& arm, const FrictionGoal& goal) {
  const glm::dvec3 turn = goal.principalFromStep * glm::cross(arm, axis) / goal.step.gyration;
  return {axis.x, axis.y, axis.z, turn.x, turn.y, turn.z};
}

/// Motion of the part's point at an arm, to first order.
glm::dvec3 motionAt(const StepVector& y, const glm::dvec3& arm, const FrictionGoal& goal) {
  return {valueOf(pushAt({1.0, 0.0, 0.0}, arm, goal), y), valueOf(pushAt({0.0, 1.0, 0.0}, arm, goal), y),
          valueOf(pushAt({0.0, 0.0, 1.0}, arm, goal), y)};
}

/// Contacts on a plane z = 0 below the part, at the margin; the floor keeps them there.
struct OnPlane {
  StepRows rows;
  std::vector<glm::dvec3> arms;
  FrictionGoal goal;

  explicit OnPlane(std::vector<glm::dvec3> at, double coefficient) : arms(std::move(at)) {
    goal.step.cost = {1.0, 1e4, 1.0};
    goal.step.gyration = {0.5, 0.7, 0.9};
    goal.step.radius = 2.0;
    goal.coefficient = coefficient;
    goal.arms = arms;
    for (const glm::dvec3& arm : arms)
      EXPECT_TRUE(rows.add(pushAt({0.0, 0.0, 1.0}, arm, goal), 1.0));
  }
};

std::vector<glm::dvec3> corners() {
  return {{0.5, 0.5, -0.3}, {-0.5, 0.5, -0.3}, {0.5, -0.5, -0.3}, {-0.5, -0.5, -0.3}};
}

TEST(FrictionProgram, WithoutFrictionTheStepIsThatOfTheStepProgram) {
  const StepProblem problem = makeStepProblem(StepProblemKind::Ring, 5, 32);
  const StepSolution expected = StepProgram().solve(problem.rows, problem.goal);
  const FrictionSolution solution =
      FrictionProgram().solve(problem.rows, {problem.goal, 0.0, problem.arms, glm::dmat3(1.0)});
  EXPECT_TRUE(solution.isSettled);
  EXPECT_EQ(solution.step.y, expected.y);
  EXPECT_EQ(solution.step.t, expected.t);
}

TEST(FrictionProgram, APushThatASingleContactCanHoldMovesNothing) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0), positive(0.05, 1.0);
  FrictionProgram program;
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 u = glm::normalize(glm::dvec3{any(random), any(random), any(random)});
    const glm::dvec3 side = glm::normalize(glm::cross(u, glm::dvec3{any(random), any(random), any(random)}));
    const std::vector<glm::dvec3> arms{{any(random), any(random), any(random)}};
    FrictionGoal goal;
    goal.coefficient = 0.5 * positive(random);
    goal.arms = arms;
    goal.principalFromStep =
        glm::mat3_cast(glm::normalize(glm::dquat{any(random), any(random), any(random), any(random)}));
    goal.step.gyration = {0.3 + positive(random), 0.3 + positive(random), 0.3 + positive(random)};
    goal.step.cost = {0.01, 1e4, 0.01};
    StepRows rows;
    ASSERT_TRUE(rows.add(pushAt(u, arms[0], goal), 0.01));
    // What a push of the wall in its cone would undo.
    const double push = positive(random);
    addTo(goal.step.wanted, -push, pushAt(u, arms[0], goal));
    addTo(goal.step.wanted, -0.9 * goal.coefficient * push, pushAt(side, arms[0], goal));
    const FrictionSolution solution = program.solve(rows, goal);
    EXPECT_TRUE(solution.isSettled) << i;
    EXPECT_LE(lengthOf(solution.step.y), 1e-13) << i;
    ASSERT_EQ(solution.pushCount, 1u);
    EXPECT_LE(glm::distance(solution.pushes[0].push, 0.9 * goal.coefficient * push * side), 1e-12) << i;
  }
}

TEST(FrictionProgram, APointThatSlidesIsHeldBackByTheCoefficientTimesItsPush) {
  // Arm along the direction, so that nothing turns: the wall pushes by 1, friction by 0.5 of that.
  OnPlane scene({{0.0, 0.0, 0.0}}, 0.5);
  scene.goal.step.wanted = {3.0, -4.0, -1.0, 0.0, 0.0, 0.0};
  const FrictionSolution solution = FrictionProgram().solve(scene.rows, scene.goal);
  EXPECT_TRUE(solution.isSettled);
  EXPECT_NEAR(solution.step.y[0], 3.0 * (1.0 - 0.5 / 5.0), 1e-13);
  EXPECT_NEAR(solution.step.y[1], -4.0 * (1.0 - 0.5 / 5.0), 1e-13);
  EXPECT_NEAR(solution.step.y[2], 0.0, 1e-13);
}

TEST(FrictionProgram, ABoxStandsOnASlopeBelowTheAngleOfFrictionAndSlidesAboveIt) {
  // Angle of friction: atan 0.5 = 26.6 degrees. Wide and low, so that it does not tip.
  for (const double degrees : {5.0, 20.0, 26.0, 28.0, 40.0}) {
    OnPlane scene(corners(), 0.5);
    const double angle = degrees * 3.14159265358979323846 / 180.0;
    scene.goal.step.wanted = {0.01 * std::sin(angle), 0.0, -0.01 * std::cos(angle), 0.0, 0.0, 0.0};
    const FrictionSolution solution = FrictionProgram().solve(scene.rows, scene.goal);
    EXPECT_TRUE(solution.isSettled) << degrees;
    const double expected = 0.01 * std::max(0.0, std::sin(angle) - 0.5 * std::cos(angle));
    StepVector difference = solution.step.y;
    difference[0] -= expected;
    EXPECT_LE(lengthOf(difference), 3e-6) << degrees;
  }
}

/// What Coulomb's law asks of a push beyond what it is, without cases: the projection of f - slip / |T|^2 on
/// the disk, less f.
glm::dvec3 coulombLack(const FrictionSolution& solution, const FrictionGoal& goal, const StepRows& rows,
                       const ActivePair& pair) {
  const StepVector a = rows.row(pair.row);
  const glm::dvec3 u(a[0], a[1], a[2]), arm = goal.arms[pair.row];
  glm::dvec3 push(0.0);
  for (std::size_t i = 0; i < solution.pushCount; ++i)
    if (solution.pushes[i].row == pair.row) push = solution.pushes[i].push;
  EXPECT_LE(std::abs(glm::dot(push, u)), 1e-14 * glm::length(push));
  const glm::dvec3 motion = motionAt(solution.step.y, arm, goal);
  const glm::dvec3 slip = motion - glm::dot(motion, u) * u;
  const StepVector x = pushAt({1.0, 0.0, 0.0}, arm, goal), y = pushAt({0.0, 1.0, 0.0}, arm, goal),
                   z = pushAt({0.0, 0.0, 1.0}, arm, goal);
  glm::dvec3 next = push - slip / (valueOf(x, x) + valueOf(y, y) + valueOf(z, z));
  const double radius = goal.coefficient * pair.multiplier;
  if (glm::length(next) > radius) next *= radius / glm::length(next);
  return next - push;
}

TEST(FrictionProgram, WhatHasSettledMeetsCoulombsLaw) {
  FrictionProgram program;
  std::size_t settled = 0, all = 0;
  for (const StepProblemKind kind : {StepProblemKind::Random, StepProblemKind::NearParallel,
                                     StepProblemKind::Ring, StepProblemKind::Wedge, StepProblemKind::Floor})
    for (const std::size_t rows : {1u, 2u, 5u, 16u, 64u})
      for (std::uint64_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(nameOf(kind) + ", rows " + std::to_string(rows) + ", seed " + std::to_string(seed));
        const StepProblem problem = makeStepProblem(kind, 1000 * rows + seed, rows);
        const FrictionGoal goal{problem.goal, 0.3, problem.arms, glm::dmat3(1.0)};
        const FrictionSolution solution = program.solve(problem.rows, goal);
        ++all;
        if (!solution.isSettled) continue;
        ++settled;
        const double length = test::lengthOf(problem);
        StepGoal pushed = problem.goal;
        for (std::size_t i = 0; i < solution.pushCount; ++i)
          addTo(pushed.wanted, 1.0,
                pushAt(solution.pushes[i].push, problem.arms[solution.pushes[i].row], goal));
        // What a push lacks may only be what would move nothing: the other rows hold the point. Where they
        // leave it one way to go, or none, friction is documented to be left out across it.
        const std::size_t holding =
            solution.step.activeCount + (solution.step.floorMultiplier > 0.0 ? 1u : 0u);
        for (const ActivePair& pair : solution.step.pairs()) {
          if (holding > ActiveRows::kMax - 2) continue;
          const glm::dvec3 lack = coulombLack(solution, goal, problem.rows, pair);
          StepGoal nearer = pushed;
          addTo(nearer.wanted, 1.0, pushAt(lack, problem.arms[pair.row], goal));
          StepVector change = StepProgram().solve(problem.rows, nearer).y;
          addTo(change, -1.0, solution.step.y);
          EXPECT_LE(lengthOf(change), 10.0 * FrictionProgram::kSettled * length);
        }
        // The step is that of the program whose goal has the pushes: y - y0 - pushes is what the rows push.
        StepVector left = solution.step.y;
        double sizes = length;
        addTo(left, -1.0, problem.goal.wanted);
        for (std::size_t i = 0; i < solution.pushCount; ++i) {
          const FrictionPush& push = solution.pushes[i];
          addTo(left, -1.0, pushAt(push.push, problem.arms[push.row], goal));
        }
        for (const ActivePair& pair : solution.step.pairs()) {
          addTo(left, -pair.multiplier, problem.rows.row(pair.row));
          sizes += pair.multiplier * problem.rows.largestNorm();
        }
        EXPECT_LE(lengthOf(left), 1e-12 * sizes);
      }
  EXPECT_GT(10 * settled, 8 * all);
}

TEST(FrictionProgram, RowsAndReachHoldWhetherPushesSettleOrNot) {
  FrictionProgram program;
  std::size_t unsettled = 0;
  for (const StepProblemKind kind : test::kStepProblemKinds)
    for (const std::size_t rows : {1u, 4u, 16u, 64u})
      for (std::uint64_t seed = 0; seed < 30; ++seed) {
        StepProblem problem = makeStepProblem(kind, 1000 * rows + seed, rows);
        problem.goal.reach = 1.5 * problem.goal.cost.margin;
        const FrictionSolution solution =
            program.solve(problem.rows, {problem.goal, 1.5, problem.arms, glm::dmat3(1.0)});
        EXPECT_LE(displacementOf(solution.step.y, problem.goal), problem.goal.reach);
        EXPECT_GE(solution.step.t, problem.goal.cost.floor - 1e-12 * test::lengthOf(problem));
        EXPECT_GE(problem.rows.leastClearance(solution.step.y).clearance,
                  solution.step.t - 1e-12 * test::lengthOf(problem))
            << nameOf(kind) << " " << rows << " " << seed;
        EXPECT_LE(solution.sweeps, (FrictionProgram::kMaxSweeps + 1) * FrictionProgram::kMaxScales);
        EXPECT_LE(solution.step.changes, FrictionProgram::kMaxChanges + 8 * solution.sweeps);
        if (!solution.isSettled) ++unsettled;
      }
  EXPECT_GT(unsettled, 0u);
}

TEST(FrictionProgram, AnUnusableGoalLeavesThePartWhereItIs) {
  OnPlane scene(corners(), 0.5);
  scene.goal.step.wanted = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const auto expectStill = [&](const FrictionGoal& goal) {
    const FrictionSolution solution = FrictionProgram().solve(scene.rows, goal);
    EXPECT_FALSE(solution.isSettled || solution.step.isExact);
    EXPECT_EQ(solution.step.y, StepVector{});
  };
  for (const double bad :
       {-0.1, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    FrictionGoal goal = scene.goal;
    goal.coefficient = bad;
    expectStill(goal);
  }
  FrictionGoal goal = scene.goal;
  goal.arms = goal.arms.first(3);
  expectStill(goal);
  std::vector<glm::dvec3> arms = corners();
  arms[2].y = std::numeric_limits<double>::quiet_NaN();
  goal.arms = arms;
  expectStill(goal);
}

TEST(FrictionProgram, AllocatesNothing) {
  StepProblem problem = makeStepProblem(StepProblemKind::Ring, 3, 64);
  problem.goal.reach = 1.5 * problem.goal.cost.margin;
  FrictionProgram program;
  test::resetAllocationCount();
  test::startCountingAllocations();
  const FrictionSolution solution =
      program.solve(problem.rows, {problem.goal, 0.4, problem.arms, glm::dmat3(1.0)});
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0u);
  EXPECT_GT(solution.sweeps, 1u);
}

}  // namespace
}  // namespace nearfit::friction_program_test
