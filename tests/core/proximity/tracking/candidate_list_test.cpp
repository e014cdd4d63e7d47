#include "core/proximity/tracking/candidate_list.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::candidate_list_test {
namespace {

using test::BodyPair;

constexpr double kCutoff = 0.1;
const MotionBudget kBudget{0.02, 0.03};
constexpr double kTurn = 0.02;  ///< Of a step, for lists of contacts.
constexpr CandidateList::Bounds kNoBounds{1U << 20, 1U << 30};

class Stars {
 public:
  const BodyPair pair{"stars", test::starMesh(21, 1.0, 3, 0.25), test::starMesh(22, 0.7, 3, 0.25)};
  const NormalConeTree scene{pair.scene}, part{pair.part};
  LmdScratch scratch;

  std::vector<Lmd> cold(const RigidTransform& pose, double cutoff = kCutoff) {
    std::vector<Lmd> out(4096);
    out.resize(findLmds(scene, part, pose, cutoff, scratch, out).count);
    return out;
  }
  std::vector<Lmd> listed(const CandidateList& list, const RigidTransform& pose, double cutoff = kCutoff) {
    std::vector<Lmd> out(4096);
    out.resize(list.query(pose, cutoff, scratch, out).value().count);
    return out;
  }
};

void expectSame(const std::vector<Lmd>& a, const std::vector<Lmd>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].scenePoint, b[i].scenePoint);
    EXPECT_EQ(a[i].partPoint, b[i].partPoint);
    EXPECT_EQ(a[i].direction, b[i].direction);
  }
}

/// A pose as far from another as the budget allows, in a random sense: turned about the part's middle, then
/// moved.
RigidTransform movedWithin(const RigidTransform& pose, const NormalConeTree& part, const MotionBudget& budget,
                           double share, std::mt19937_64& random) {
  const double radius = 0.5 * part.size();
  const glm::dvec3 axis = test::randomRotation(random).rotation * glm::dvec3(1, 0, 0);
  const glm::dvec3 way = test::randomRotation(random).rotation * glm::dvec3(1, 0, 0);
  const double angle = share * std::min(budget.turn, budget.travel / (2.0 * radius));
  const double travel = share * budget.travel - 2.0 * std::sin(0.5 * angle) * radius;
  const glm::dquat turned = glm::normalize(glm::angleAxis(angle, axis) * pose.rotation);
  return {turned, pose.applyToPoint(part.centre()) + travel * way - turned * part.centre()};
}

TEST(CandidateList, HoldsTheExactSetAtEveryPoseWithinItsBudget) {
  Stars stars;
  std::mt19937_64 random(1);
  CandidateList list;
  std::size_t compared = 0;
  for (int i = 0; i < 40; ++i) {
    const RigidTransform start = test::poseNearContact(stars.pair, kCutoff, random);
    list.build({stars.scene, stars.part, start, kCutoff}, {{}, kBudget}, stars.scratch, kNoBounds);
    for (int k = 0; k < 25; ++k) {
      const RigidTransform pose = movedWithin(start, stars.part, kBudget, 0.999, random);
      ASSERT_TRUE(list.covers(pose, kCutoff));
      const std::vector<Lmd> expected = stars.cold(pose);
      expectSame(stars.listed(list, pose), expected);
      expectSame(stars.listed(list, pose, 0.5 * kCutoff), stars.cold(pose, 0.5 * kCutoff));
      compared += expected.size();
    }
  }
  EXPECT_GT(compared, 1000U);
}

TEST(CandidateList, HoldsTheExactSetAlongAStretchOfAWayAndAsideOfIt) {
  Stars stars;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> time(-1.0, 1.0), share(0.0, 1.0);
  const auto vector = [&](double length) {
    return length * (test::randomRotation(random).rotation * glm::dvec3(1, 0, 0));
  };
  CandidateList list;
  std::size_t compared = 0;
  for (int i = 0; i < 30; ++i) {
    const RigidTransform middle = test::poseNearContact(stars.pair, kCutoff, random);
    const MotionRange range{{vector(0.03), vector(0.04)}, {0.005, 0.01}};
    list.build({stars.scene, stars.part, middle, kCutoff}, range, stars.scratch, kNoBounds);
    const glm::dvec3 centre = stars.part.centre();
    for (int k = 0; k < 25; ++k) {
      const RigidTransform on =
          poseOn(range.stretch, {middle.rotation, middle.applyToPoint(centre)}, time(random));
      const RigidTransform back{on.rotation, on.translation - on.rotation * centre};
      const RigidTransform pose = movedWithin(back, stars.part, range.budget, 0.9 * share(random), random);
      if (!list.covers(pose, kCutoff)) continue;
      const std::vector<Lmd> expected = stars.cold(pose);
      expectSame(stars.listed(list, pose), expected);
      compared += expected.size();
    }
  }
  EXPECT_GT(compared, 1000U);
}

TEST(CandidateList, TheRoomAlongAWayIsThereAllAlongIt) {
  Stars stars;
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const glm::dvec3 centre = stars.part.centre();
  const auto vector = [&](double length) {
    return length * (test::randomRotation(random).rotation * glm::dvec3(1, 0, 0));
  };
  CandidateList list;
  std::size_t ways = 0, farTurns = 0, tight = 0;
  for (int i = 0; i < 400; ++i) {
    const RigidTransform middle = test::poseNearContact(stars.pair, kCutoff, random);
    // The way turns about nearly the same axis as the list's, or about any other.
    const glm::dvec3 axis = vector(1.0);
    const MotionRange range{{vector(0.02), (0.01 + 0.09 * share(random)) * axis}, {0.02, 0.03}};
    list.build({stars.scene, stars.part, middle, kCutoff}, range, stars.scratch, kNoBounds, kTurn);
    const RigidTransform from{middle.rotation, middle.applyToPoint(centre)};
    const glm::dvec3 offAxis = i % 2 == 0 ? vector(0.03) : vector(0.8);
    const RigidTransform at = poseOn(range.stretch, from, 0.4 * (share(random) - 0.5));
    const double length = 0.7 * share(random);
    const MotionStretch way{length * range.stretch.shift,
                            length * glm::length(range.stretch.spin) * glm::normalize(axis + offAxis)};
    const auto uncentred = [&](const RigidTransform& pose) {
      return RigidTransform{pose.rotation, pose.translation - pose.rotation * centre};
    };
    const std::optional<MotionBudget> room =
        list.roomAlong(uncentred(poseOn(way, at, -1.0)), uncentred(poseOn(way, at, 1.0)), {kCutoff, kTurn});
    if (!room) continue;
    ++ways;
    farTurns += glm::length(way.spin) > 0.03 && room->turn > 0.5 * range.budget.turn ? 1 : 0;
    tight += room->turn == 0.0 || room->travel == 0.0 ? 1 : 0;
    for (double time = -1.0; time <= 1.0; time += 0.05) {
      const RigidTransform on = uncentred(poseOn(way, at, time));
      EXPECT_LE(list.spent(on), 1.0) << i << ", time " << time;
      const RigidTransform aside = movedWithin(on, stars.part, *room, 0.98, random);
      EXPECT_LE(list.spent(aside), 1.0) << i << ", aside at time " << time;
    }
  }
  EXPECT_GT(ways, 200U);
  EXPECT_GT(farTurns, 20U) << "where axes agree, a large turn takes little room";
  EXPECT_LT(tight, ways);
}

TEST(CandidateList, RotationAloneSpendsTheBudgetToo) {
  Stars stars;
  std::mt19937_64 random(2);
  CandidateList list;
  const MotionBudget turnOnly{0.5, 0.2};
  for (int i = 0; i < 10; ++i) {
    const RigidTransform start = test::poseNearContact(stars.pair, kCutoff, random);
    list.build({stars.scene, stars.part, start, kCutoff}, {{}, turnOnly}, stars.scratch, kNoBounds);
    const glm::dvec3 axis = test::randomRotation(random).rotation * glm::dvec3(0, 1, 0);
    for (const double angle : {0.05, -0.1, 0.15, -0.199}) {
      // About the part's own origin, which is not where its box is centred.
      const RigidTransform pose{glm::angleAxis(angle, axis) * start.rotation, start.translation};
      ASSERT_TRUE(list.covers(pose, kCutoff));
      expectSame(stars.listed(list, pose), stars.cold(pose));
    }
    const RigidTransform tooFar{glm::angleAxis(0.21, axis) * start.rotation, start.translation};
    EXPECT_FALSE(list.covers(tooFar, kCutoff));
  }
}

TEST(CandidateList, CoversNothingBeyondItsBudgetItsCutoffOrItsRoom) {
  Stars stars;
  CandidateList list, small;
  RigidTransform pose{{1, 0, 0, 0}, {1.3, 0.3, 0.2}};
  EXPECT_FALSE(list.covers(pose, kCutoff));  // Nothing was built.
  list.build({stars.scene, stars.part, pose, kCutoff}, {{}, kBudget}, stars.scratch, kNoBounds);
  ASSERT_GT(list.size(), 8U);
  EXPECT_TRUE(list.covers(pose, kCutoff));
  EXPECT_FALSE(list.covers(pose, 1.01 * kCutoff));
  RigidTransform moved = pose;
  moved.translation.x += 0.999 * kBudget.travel;
  EXPECT_TRUE(list.covers(moved, kCutoff));
  moved.translation.x = pose.translation.x + 1.001 * kBudget.travel;
  EXPECT_FALSE(list.covers(moved, kCutoff));
  moved.translation.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(list.covers(moved, kCutoff));
  small.build({stars.scene, stars.part, pose, kCutoff}, {{}, kBudget}, stars.scratch, {.pairs = 8});
  EXPECT_FALSE(small.covers(pose, kCutoff));
}

TEST(CandidateList, FlatContactIsOneRegionFromTheListToo) {
  const TriangleMesh floor = test::squareMesh(2.0, 8), box = test::boxMesh({0.5, 0.5, 0.5});
  const NormalConeTree scene(floor), part(box);
  LmdScratch scratch;
  CandidateList list;
  std::vector<Lmd> out(64);
  list.build({scene, part, {{1, 0, 0, 0}, {0.1, 0.2, 0.31}}, kCutoff}, {{}, {0.05, 0.01}}, scratch);
  const std::optional<LmdResult> result = list.query({{1, 0, 0, 0}, {0.13, 0.2, 0.3}}, kCutoff, scratch, out);
  ASSERT_TRUE(result);
  ASSERT_EQ(result->count, 1U);
  EXPECT_TRUE(out[0].isRegion);
  EXPECT_NEAR(out[0].distance, 0.05, 1e-12);
  EXPECT_LT(glm::distance(out[0].scenePoint, glm::dvec3(0.13, 0.2, 0.0)), 1e-9);
}

TEST(MotionBetween, BoundsTheMotionOfEveryPointWithinTheRadius) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  constexpr double kRadius = 0.7;
  for (int i = 0; i < 500; ++i) {
    RigidTransform a = test::randomRotation(random), b = test::randomRotation(random);
    if (i % 2 == 0)
      b.rotation = glm::normalize(glm::angleAxis(0.01 * unit(random), glm::dvec3(0, 0, 1)) * a.rotation);
    a.translation = {unit(random), unit(random), unit(random)};
    b.translation = {unit(random), unit(random), unit(random)};
    const MotionBudget motion = motionBetween(a, b, kRadius);
    for (int k = 0; k < 20; ++k) {
      const glm::dvec3 p = kRadius * (test::randomRotation(random).rotation * glm::dvec3(1, 0, 0));
      EXPECT_LE(glm::distance(a.applyToPoint(p), b.applyToPoint(p)), motion.travel + 1e-12);
      const glm::dvec3 d = test::randomRotation(random).rotation * glm::dvec3(1, 0, 0);
      const double angle = std::acos(std::clamp(glm::dot(a.rotation * d, b.rotation * d), -1.0, 1.0));
      EXPECT_LE(angle, motion.turn + 1e-7);
    }
  }
}

/// What a truncated set says of itself is true: every minimum nearer than `completeTo` is there.
void expectHonest(const LmdResult& result, const std::vector<Lmd>& some, const std::vector<Lmd>& all) {
  EXPECT_EQ(result.status == QueryStatus::Complete, result.completeTo == kCutoff);
  for (const Lmd& minimum : all) {
    if (minimum.distance >= result.completeTo) break;
    EXPECT_TRUE(std::any_of(some.begin(), some.end(),
                            [&](const Lmd& lmd) { return lmd.partPoint == minimum.partPoint; }));
  }
  if (result.completeTo > 0.0 && !all.empty()) {
    EXPECT_EQ(some.front().distance, all.front().distance);
  }
}

TEST(CandidateList, WithLittleWorkKeepsTheNearestAndSaysHowFarItIsComplete) {
  Stars stars;
  CandidateList list;
  const RigidTransform pose{{1, 0, 0, 0}, {1.5, 0.1, 0.0}};
  list.build({stars.scene, stars.part, pose, kCutoff}, {{}, kBudget}, stars.scratch, kNoBounds);
  const std::vector<Lmd> all = stars.cold(pose);
  ASSERT_GT(all.size(), 3U);
  std::vector<Lmd> out(4096);
  bool wasTruncated = false, wasCompleteToTheNearest = false;
  for (std::uint64_t work = 1; work < 1U << 16; work += 1 + work / 8) {
    const LmdResult result = list.query(pose, kCutoff, stars.scratch, out, work).value();
    EXPECT_LE(result.nodePairs + result.leafPairs, work);
    expectHonest(result, {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(result.count)}, all);
    wasTruncated = wasTruncated || result.completeTo == 0.0;
    wasCompleteToTheNearest = wasCompleteToTheNearest || result.completeTo == all.front().distance;
  }
  EXPECT_TRUE(wasTruncated);
  EXPECT_TRUE(wasCompleteToTheNearest);
  expectSame(stars.listed(list, pose), all);
}

TEST(CandidateList, WithLittleRoomKeepsTheNearestAsAQueryDoes) {
  Stars stars;
  CandidateList list;
  const RigidTransform pose{{1, 0, 0, 0}, {1.5, 0.1, 0.0}};
  list.build({stars.scene, stars.part, pose, kCutoff}, {{}, kBudget}, stars.scratch, kNoBounds);
  const std::vector<Lmd> all = stars.cold(pose);
  std::vector<Lmd> out(4096);
  for (const std::size_t room : {0UL, 1UL, 2UL, 3UL, 5UL, 100000UL}) {
    stars.scratch.holdAtMost(room);
    const LmdResult listed = list.query(pose, kCutoff, stars.scratch, out).value();
    EXPECT_LE(listed.pieces, std::max<std::size_t>(room, 1));
    expectHonest(listed, {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(listed.count)}, all);
    const LmdResult cold = findLmds(stars.scene, stars.part, pose, kCutoff, stars.scratch, out);
    EXPECT_LE(cold.pieces, std::max<std::size_t>(room, 1));
    expectHonest(cold, {out.begin(), out.begin() + static_cast<std::ptrdiff_t>(cold.count)}, all);
  }
}

}  // namespace
}  // namespace nearfit::candidate_list_test
