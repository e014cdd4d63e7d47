#include "core/proximity/tracking/lmd_tracker.h"

#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/trial_share.h"

namespace nearfit::lmd_tracker_test {
namespace {

using test::BodyPair;

constexpr double kCutoff = 0.15;
constexpr std::size_t kTicks = 400;

void expectSame(const std::vector<Lmd>& a, const std::vector<Lmd>& b, std::size_t tick) {
  ASSERT_EQ(a.size(), b.size()) << tick;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].scenePoint, b[i].scenePoint) << tick;
    EXPECT_EQ(a[i].partPoint, b[i].partPoint) << tick;
    EXPECT_EQ(a[i].direction, b[i].direction) << tick;
  }
}

/// Follows a part tick by tick with lists that arrive some ticks after they were asked for, as from another
/// thread, and holds every set against the cold query's, to the last bit, and against the oracle's.
struct Follower {
  const BodyPair pair{"stars", test::starMesh(61, 1.0, 1, 0.3), test::starMesh(62, 0.6, 1, 0.3)};
  const NormalConeTree scene{pair.scene}, part{pair.part};
  std::size_t listed = 0, late = 0, minima = 0;

  void follow(const std::function<RigidTransform(std::size_t)>& poseAt, std::size_t delay) {
    LmdTracker tracker(scene, part);
    LmdScratch scratch, aside;
    CandidateList lists[2];
    int front = 0;
    bool isUnderWay = false;
    std::size_t readyAt = 0;
    std::vector<Lmd> out(4096);
    for (std::size_t tick = 0; tick < kTicks; ++tick) {
      const RigidTransform pose = poseAt(tick);
      if (isUnderWay && tick >= readyAt) {
        front = 1 - front;
        isUnderWay = false;
      }
      const std::optional<LmdResult> result = lists[front].query(pose, kCutoff, scratch, out);
      if (result) {
        ++listed;
        EXPECT_EQ(result->status, QueryStatus::Complete);
        EXPECT_EQ(result->completeTo, kCutoff);
        const std::vector<Lmd> found(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(result->count));
        expectSame(found, test::allLmds(scene, part, pose, kCutoff), tick);
        // Brute force takes most of the time.
        if (tick % test::kTrialShare == 0) {
          test::LmdTally tally;
          test::compareAtPose(pair, pose, kCutoff, tally);
          minima += tally.minima;
        }
      } else {
        ++late;
      }
      tracker.observe(pose, 1.0);
      if (isUnderWay || !tracker.isDue(lists[front], kCutoff)) continue;
      tracker.refresh(lists[1 - front], kCutoff, aside);
      tracker.setLead(static_cast<double>(delay));
      readyAt = tick + 1 + delay;
      isUnderWay = true;
    }
  }
};

/// A pose with several minima, found among random ones.
RigidTransform poseInContact(const Follower& follower) {
  std::mt19937_64 random(68);
  RigidTransform pose = test::poseNearContact(follower.pair, kCutoff, random);
  while (test::allLmds(follower.scene, follower.part, pose, kCutoff).size() < 4)
    pose = test::poseNearContact(follower.pair, kCutoff, random);
  return pose;
}

/// A smooth way about a pose that turns as it goes.
RigidTransform onWay(const RigidTransform& pose, double t) {
  const glm::dvec3 aside(std::cos(1.3 * t) - 1.0, std::sin(0.9 * t), std::sin(2.1 * t));
  const glm::dquat turn = glm::angleAxis(0.4 * std::sin(0.7 * t), glm::normalize(glm::dvec3(1.0, -0.4, 0.6)));
  return {turn * pose.rotation, pose.translation + 0.5 * kCutoff * aside};
}

TEST(LmdTracker, IsExactAlongASmoothPathAndSeldomLate) {
  for (const std::size_t delay : {0U, 2U}) {
    Follower follower;
    const RigidTransform start = poseInContact(follower);
    follower.follow([&](std::size_t tick) { return onWay(start, 0.02 * static_cast<double>(tick)); }, delay);
    EXPECT_GT(follower.minima, kTicks / 4 / test::kTrialShare);
    EXPECT_LT(follower.late, kTicks / 10 + 10);
  }
}

TEST(LmdTracker, IsExactBetweenTeleportsAndSaysThatItIsLateAfterEach) {
  Follower follower;
  std::mt19937_64 random(63);
  RigidTransform base;
  constexpr std::size_t kStay = 20;
  follower.follow(
      [&](std::size_t tick) {
        if (tick % kStay == 0) base = test::poseNearContact(follower.pair, kCutoff, random);
        RigidTransform pose = base;
        pose.translation += 1e-4 * static_cast<double>(tick % kStay) * glm::dvec3(1.0, 0.5, 0.0);
        return pose;
      },
      1);
  EXPECT_GE(follower.late, kTicks / kStay);
  EXPECT_GT(follower.listed, kTicks / 2);
  EXPECT_GT(follower.minima, 0U);
}

TEST(LmdTracker, IsExactWhenTheHandTurnsBackAgainAndAgain) {
  Follower follower;
  std::mt19937_64 random(64);
  const RigidTransform start = poseInContact(follower);
  double t = 0.0, step = 0.02;
  std::uniform_int_distribution<int> one(0, 12);
  follower.follow(
      [&](std::size_t) {
        if (one(random) == 0) step = -step;
        t += step;
        return onWay(start, t);
      },
      1);
  EXPECT_GT(follower.listed, kTicks / 4);
  EXPECT_GT(follower.minima, 0U);
}

TEST(LmdTracker, IsExactWhenThePartOnlyTurns) {
  Follower follower;
  const RigidTransform start = poseInContact(follower);
  follower.follow(
      [&](std::size_t tick) {
        const double angle =
            0.006 * static_cast<double>(tick) + 0.2 * std::sin(0.02 * static_cast<double>(tick));
        const glm::dquat turn = glm::angleAxis(angle, glm::normalize(glm::dvec3(0.2, 1.0, -0.7)));
        return RigidTransform{turn * start.rotation, start.translation};
      },
      1);
  EXPECT_GT(follower.listed, kTicks / 2);
  EXPECT_GT(follower.minima, 0U);
}

TEST(LmdTracker, BodiesFarApartAreSearchedOnceInALongTime) {
  const NormalConeTree scene(test::icosphereMesh(1.0, 2)), part(test::icosphereMesh(0.5, 2));
  LmdTracker tracker(scene, part);
  CandidateList list;
  LmdScratch scratch;
  std::size_t searches = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    tracker.observe({{1, 0, 0, 0}, {4.0 - 1e-3 * tick, 0.0, 0.0}}, 1.0);
    if (!tracker.isDue(list, kCutoff)) continue;
    tracker.refresh(list, kCutoff, scratch);
    EXPECT_EQ(list.size(), 0U);
    ++searches;
  }
  // A metre at a millimetre a tick, and the gap never less than 1.35 m: less than one search in fifty ticks.
  EXPECT_LE(searches, 20U);
}

TEST(FindNearestLmds, KeepsWhatIsNearestWhenItMayNotDoAllTheWork) {
  const BodyPair pair{"stars", test::starMesh(65, 1.0, 3, 0.2), test::starMesh(66, 0.6, 3, 0.2)};
  const NormalConeTree scene(pair.scene), part(pair.part);
  LmdScratch scratch;
  std::vector<Lmd> out(4096);
  std::mt19937_64 random(67);
  std::size_t truncated = 0, certain = 0;
  for (std::size_t i = 0; i < 100 / test::kTrialShare; ++i) {
    const RigidTransform pose = test::poseNearContact(pair, kCutoff, random);
    const std::vector<Lmd> all = test::allLmds(scene, part, pose, kCutoff);
    for (const std::uint64_t work : {0U, 10U, 100U, 400U, 1000U, 100000U}) {
      const LmdResult result = findNearestLmds(scene, part, pose, kCutoff, scratch, out, work);
      EXPECT_LE(result.nodePairs, work);
      if (result.status == QueryStatus::Complete) {
        EXPECT_EQ(result.completeTo, kCutoff);
        EXPECT_EQ(result.count, all.size());
        continue;
      }
      ++truncated;
      if (result.completeTo == 0.0) continue;
      ++certain;
      ASSERT_GT(result.count, 0U);
      EXPECT_EQ(result.completeTo, all[0].distance);
      EXPECT_EQ(out[0].scenePoint, all[0].scenePoint);
    }
  }
  EXPECT_GT(truncated, 0U);
  EXPECT_GT(certain, 0U);
}

// Where threads lie in each other, attempts at lists that were too long took longer than the list that
// served.
TEST(BuildForPlan, WhatWasTooMuchOfLateIsNotTriedAgainAtOnce) {
  const TriangleMesh mesh = test::icosphereMesh(0.5, 2);
  const PartGeometryPtr ball = test::geometryOf(mesh);
  const RigidTransform pose{{1, 0, 0, 0}, {1.02, 0.0, 0.0}};
  MotionForecast forecast(mesh.bounds().centre(), 0.5 * mesh.bounds().diagonal());
  forecast.observe(pose, 1.0);
  const TrackedPair pair{ball->tree(), ball->tree(), {}};
  LmdScratch scratch;
  CandidateList list;
  ListPurpose purpose{.cutoff = 0.1, .planCutoff = 0.1, .whole = {0, 0}, .part = {0, 0}, .least = {0, 0}};
  PlanMemory memory;
  EXPECT_FALSE(buildForPlan(list, pair, forecast, purpose, scratch, memory));
  // There is one to be had now, of which a later attempt tells.
  purpose.whole = purpose.part = purpose.least = {1U << 20, 1U << 30};
  int attempts = 1;
  while (!buildForPlan(list, pair, forecast, purpose, scratch, memory)) {
    ASSERT_LT(attempts, 100);
    ++attempts;
  }
  EXPECT_GT(attempts, 4);
  EXPECT_TRUE(list.isUsable());
  // Lists far below the bounds lead back to the whole plan, one after the other.
  for (int i = 0; i < 4; ++i)
    EXPECT_TRUE(buildForPlan(list, pair, forecast, purpose, scratch, memory));
  EXPECT_EQ(memory.level, 0U);
}

// A list for half of the time held half of the way, with as much room aside as was foretold: what was pulled
// along at its hand's pace was past its end at once.
TEST(BuildForPlan, ListsOfLessKeepTheWayAndLeaveRoomAside) {
  const TriangleMesh mesh = test::icosphereMesh(0.5, 2);
  const PartGeometryPtr ball = test::geometryOf(mesh);
  MotionForecast forecast(mesh.bounds().centre(), 0.5 * mesh.bounds().diagonal());
  const auto along = [](int ticks, double aside = 0.0) {
    return RigidTransform{{1, 0, 0, 0}, {1.02, 0.01 * ticks, aside}};
  };
  constexpr int kSeen = 40;
  for (int tick = 0; tick <= kSeen; ++tick)
    forecast.observe(along(tick), 1.0);
  const TrackedPair pair{ball->tree(), ball->tree(), {}};
  const CandidateList::Bounds none{0, 0}, many{1U << 20, 1U << 30};
  ListPurpose purpose{.cutoff = 0.1, .planCutoff = 0.1, .leastRoom = {0.01, 0.01}, .whole = many};
  LmdScratch scratch;
  CandidateList whole, less;
  PlanMemory first, second;
  ASSERT_TRUE(buildForPlan(whole, pair, forecast, purpose, scratch, first));
  purpose.whole = none;
  purpose.part = purpose.least = many;
  ASSERT_TRUE(buildForPlan(less, pair, forecast, purpose, scratch, second));
  ASSERT_GT(second.level, 0U);
  // The way, and past its end, and beside it.
  const glm::dvec3 way = forecast.plan(purpose.planCutoff).range.stretch.shift;
  const int end = kSeen + static_cast<int>(2.0 * glm::length(way) / 0.01);
  ASSERT_GE(end - kSeen, 4);
  for (int tick = kSeen; tick < end; ++tick) {
    EXPECT_LE(whole.spent(along(tick)), 1.0) << tick;
    EXPECT_LE(less.spent(along(tick)), 1.0) << tick;
  }
  EXPECT_LE(whole.spent(along(kSeen + 3, 0.02)), 1.0);
  EXPECT_GT(less.spent(along(kSeen + 3, 0.02)), 1.0);
  EXPECT_LT(less.size(), whole.size());
}

// A list that is to serve long was renewed each tick, as what was foretold strayed from tick to tick.
TEST(BuildForPlan, AListAlongAWayIsRenewedInItsMiddleWhicheverWayThePartGoes) {
  const TriangleMesh mesh = test::icosphereMesh(0.5, 2);
  const PartGeometryPtr ball = test::geometryOf(mesh);
  const TrackedPair pair{ball->tree(), ball->tree(), {}};
  const auto along = [](double ticks) { return RigidTransform{{1, 0, 0, 0}, {1.02, 2e-3 * ticks, 0.0}}; };
  MotionForecast forecast(mesh.bounds().centre(), 0.5 * mesh.bounds().diagonal());
  for (int tick = -40; tick <= 0; ++tick)
    forecast.observe(along(tick), 1.0);
  const CandidateList::Bounds many{1U << 20, 1U << 30};
  const ListPurpose purpose{.cutoff = 0.1,
                            .planCutoff = 0.1,
                            .leastRoom = {0.01, 0.01},
                            .isAlong = true,
                            .whole = many,
                            .part = many,
                            .least = many};
  LmdScratch scratch;
  CandidateList list;
  PlanMemory memory;
  const MotionForecast start = forecast;
  ASSERT_TRUE(buildForPlan(list, pair, start, purpose, scratch, memory));
  ASSERT_EQ(memory.level, 0U);
  // Its way is as long as eight min budgets, at both ends a tenth longer.
  for (const int tick : {0, 10, 20, 30, 40})
    EXPECT_LE(list.spent(along(tick)), 1.0) << tick;
  EXPECT_GT(list.spent(along(50)), 1.0);
  MotionForecast ofSlowSearch = forecast;
  for (int tick = 1; tick <= 40; ++tick) {
    forecast.observe(along(tick), 1.0);
    // In the next tick it is in the middle.
    if (tick < 18) {
      EXPECT_TRUE(willServe(list, pair, forecast, purpose)) << tick;
    }
    if (tick > 22) {
      EXPECT_FALSE(willServe(list, pair, forecast, purpose)) << tick;
    }
    // Where a search takes long it is renewed earlier, so as to be there in time.
    ofSlowSearch.observe(along(tick), 1.0);
    ofSlowSearch.setLead(20.0);
    if (tick < 8) {
      EXPECT_TRUE(willServe(list, pair, ofSlowSearch, purpose)) << tick;
    }
    if (tick > 12) {
      EXPECT_FALSE(willServe(list, pair, ofSlowSearch, purpose)) << tick;
    }
  }
  // The next then begins where it is told to.
  ListPurpose later = purpose;
  later.begin = 20.0;
  CandidateList next;
  ASSERT_TRUE(buildForPlan(next, pair, start, later, scratch, memory));
  EXPECT_GT(next.spent(along(8)), 1.0);
  for (const int tick : {20, 40, 60})
    EXPECT_LE(next.spent(along(tick)), 1.0) << tick;
  // One that stops, and stirs to either side, needs no other.
  MotionForecast resting = forecast;
  ASSERT_TRUE(buildForPlan(list, pair, forecast, purpose, scratch, memory));
  for (int tick = 0; tick < 200; ++tick) {
    resting.observe(along(40.0 + 1e-3 * (tick % 7)), 1.0);
    if (tick > 40) {
      EXPECT_TRUE(willServe(list, pair, resting, purpose)) << tick;
    }
  }
  ASSERT_TRUE(buildForPlan(list, pair, start, purpose, scratch, memory));
  // The other way it serves until it is before its middle.
  for (int tick = 40; tick >= 0; --tick) {
    forecast.observe(along(tick), 1.0);
    if (tick < 34 && tick > 24) {
      EXPECT_TRUE(willServe(list, pair, forecast, purpose)) << tick;
    }
    if (tick < 16) {
      EXPECT_FALSE(willServe(list, pair, forecast, purpose)) << tick;
    }
  }
}

}  // namespace
}  // namespace nearfit::lmd_tracker_test
