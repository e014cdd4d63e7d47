#include "core/planning/pose_planner.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/planning/pose_sampler.h"

namespace nearfit::pose_planner_test {
namespace {

RigidTransform at(double x, double y, double z) {
  return {glm::dquat(1.0, 0.0, 0.0, 0.0), glm::dvec3(x, y, z)};
}

/// A point in the cube from -1 to 1, with a wall in the plane x = 0 that has a square hole of side 0.3 about (y, z) =
/// (0.5, 0.5).
class PointAndWall final : public PoseMotions {
 public:
  bool isFree(const RigidTransform&) override { return true; }
  bool isFree(const RigidTransform& from, const RigidTransform& to) override {
    ++work;
    const glm::dvec3 &a = from.translation, &b = to.translation;
    if (isWhole && (a.x < 0.0) != (b.x < 0.0)) return false;
    if ((a.x < 0.0) == (b.x < 0.0)) return true;
    const glm::dvec3 through = a + a.x / (a.x - b.x) * (b - a);
    return std::abs(through.y - 0.5) < 0.15 && std::abs(through.z - 0.5) < 0.15;
  }
  bool advance(const RigidTransform& from, const RigidTransform& toward, bool,
               std::vector<RigidTransform>& way) override {
    constexpr double kStep = 0.2;
    RigidTransform pose = from;
    for (int i = 0; i < 4; ++i) {
      const glm::dvec3 left = toward.translation - pose.translation;
      const bool isLast = glm::length(left) <= kStep;
      RigidTransform next = toward;
      if (!isLast) next = {pose.rotation, pose.translation + kStep * glm::normalize(left)};
      if (!isFree(pose, next)) return false;
      way.push_back(next);
      pose = next;
      if (isLast) return true;
    }
    return false;
  }
  bool reach(const RigidTransform& pose) override { return isOutBeyondHalf && pose.translation.x > 0.5; }

  std::uint64_t work = 0;
  bool isWhole = false;          ///< The wall has no hole.
  bool isOutBeyondHalf = false;  ///< Everything beyond x = 0.5 m is a goal.
};

PoseQuery throughTheWall(std::uint64_t seed) {
  PoseQuery query;
  query.bounds = {glm::dvec3(-1.0), glm::dvec3(1.0), 0.5, true};
  query.start = at(-0.5, -0.5, -0.5);
  query.goals = {at(0.5, -0.5, -0.5)};
  query.directions = {{1, 0, 0}};
  query.seed = seed;
  return query;
}

using Planner = PosePlan (*)(const PoseQuery&, PoseMotions&, const PlanLimit&);

class PosePlanner : public testing::TestWithParam<Planner> {
 protected:
  PosePlan plan(const PoseQuery& query, std::uint64_t maxWork = 200'000) {
    motions_.work = 0;
    return GetParam()(query, motions_, [&] { return motions_.work > maxWork; });
  }
  PointAndWall motions_;
};

TEST_P(PosePlanner, FindsAWayThroughAHole) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const PoseQuery query = throughTheWall(seed);
    const PosePlan found = plan(query);
    ASSERT_GE(found.way.size(), 3U) << seed;
    EXPECT_EQ(found.way.front().translation, query.start.translation);
    EXPECT_EQ(found.way.back().translation, query.goals[0].translation);
    for (std::size_t i = 1; i < found.way.size(); ++i)
      EXPECT_TRUE(motions_.isFree(found.way[i - 1], found.way[i])) << "seed " << seed << ", motion " << i;
    EXPECT_GE(found.poses, found.way.size());
  }
}

TEST_P(PosePlanner, TheSameSeedGivesTheSameWay) {
  const PosePlan a = plan(throughTheWall(3)), b = plan(throughTheWall(3)), c = plan(throughTheWall(4));
  ASSERT_FALSE(a.way.empty());
  EXPECT_EQ(a.way, b.way);
  EXPECT_NE(a.way, c.way);
}

TEST_P(PosePlanner, GivesUpWhereThereIsNoWay) {
  motions_.isWhole = true;
  const PosePlan found = plan(throughTheWall(1), 5000);
  EXPECT_TRUE(found.way.empty());
  EXPECT_GT(found.poses, 2U);
}

INSTANTIATE_TEST_SUITE_P(Both, PosePlanner, testing::Values(&planBySliding, &planByConnecting));

TEST(SlidingPlanner, EndsAtAnyPoseThatCountsAsAGoal) {
  PointAndWall motions;
  motions.isOutBeyondHalf = true;
  PoseQuery query = throughTheWall(1);
  query.goals.clear();
  const PosePlan found = planBySliding(query, motions, [&] { return motions.work > 200'000; });
  ASSERT_FALSE(found.way.empty());
  EXPECT_GT(found.way.back().translation.x, 0.5);
}

TEST(SlidingPlanner, TakesWaysThatAreKnown) {
  PointAndWall motions;
  PoseQuery query = throughTheWall(1);
  // Both lead to either side of the hole.
  query.startWays = {{query.start, at(-0.1, 0.5, 0.5)}};
  query.goalWays = {{query.goals[0], at(0.1, 0.5, 0.5)}};
  const PosePlan found = planBySliding(query, motions, [&] { return motions.work > 2000; });
  EXPECT_FALSE(found.way.empty());
}

TEST(PoseSampler, RotationsAreUnitAndTurnEveryWay) {
  PoseSampler sampler(1);
  glm::dvec3 sum(0.0);
  constexpr int kSamples = 20'000;
  for (int i = 0; i < kSamples; ++i) {
    const glm::dquat q = sampler.rotation();
    ASSERT_NEAR(glm::dot(q, q), 1.0, 1e-12);
    sum += q * glm::dvec3(1.0, 0.0, 0.0);
  }
  // The mean of uniform directions; 5 standard deviations of 1 / sqrt(3 n).
  EXPECT_LT(glm::length(sum) / kSamples, 5.0 / std::sqrt(3.0 * kSamples) * std::sqrt(3.0));
}

}  // namespace
}  // namespace nearfit::pose_planner_test
