#include "core/proximity/query/contact_areas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/haptics/spring_law.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/blocked_minima.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::contact_areas_test {
namespace {

constexpr std::uint64_t kAllWork = std::numeric_limits<std::uint64_t>::max();

RigidTransform at(const glm::dvec3& translation, const glm::dquat& rotation = {1.0, 0.0, 0.0, 0.0}) {
  return {rotation, translation};
}

/// Two bodies and the minima between them, merged by area.
struct Bodies {
  Bodies(const TriangleMesh& sceneMesh, const TriangleMesh& partMesh, double range)
      : scene(sceneMesh), part(partMesh), cutoff(range), scratch(4096) {}

  std::vector<Lmd> minimaAt(const RigidTransform& pose) {
    std::vector<Lmd> lmds(4096);
    const LmdResult result = findLmds(scene, part, pose, cutoff, scratch, lmds);
    EXPECT_EQ(result.status, QueryStatus::Complete);
    lmds.resize(result.count);
    markBlocked(scene, part, pose, lmds, 0.0, scratch);
    return lmds;
  }
  AreaResult merge(const RigidTransform& pose, std::vector<Lmd>& lmds, std::uint64_t work = kAllWork) {
    return mergeAreas(scene, part, pose, cutoff, lmds, scratch, work);
  }
  std::uint32_t areasAt(const RigidTransform& pose) {
    std::vector<Lmd> lmds = minimaAt(pose);
    return merge(pose, lmds).areas;
  }

  NormalConeTree scene, part;
  double cutoff;
  LmdScratch scratch;
};

glm::dvec3 randomDirection(std::mt19937_64& random) {
  for (;;) {
    const auto coordinate = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1.0; };
    const glm::dvec3 v(coordinate(), coordinate(), coordinate());
    const double length = glm::length(v);
    if (length > 0.1 && length < 1.0) return v / length;
  }
}

/// A ball of 0.5 in a bowl of 1: the gap is smallest where the centre is off to, 0.5 less the way there.
class BallInBowlAreas : public testing::Test {
 protected:
  static constexpr double kBall = 0.5, kBowl = 1.0, kRange = 0.25;

  struct Errors {
    double raw = 0.0, grouped = 0.0;  ///< Root mean squares, of a spring that pushes with 1 N at contact.
    std::uint32_t mostAreas = 0;
  };

  static Errors errorsOf(std::uint32_t level) {
    const std::uint32_t segments = 8U << level;
    Bodies bodies(test::bowlMesh(kBowl, 1.2, segments, segments / 4), test::icosphereMesh(kBall, level),
                  kRange);
    const SpringParameters springs{.cutoff = kRange, .stiffness = 1.0 / kRange};
    std::mt19937_64 random(5);
    Errors errors;
    constexpr int kPoses = 40;
    for (int i = 0; i < kPoses; ++i) {
      glm::dvec3 aside = randomDirection(random);
      // Well below the rim, which has contacts of its own.
      aside.z = -std::abs(aside.z) - 0.6;
      aside = glm::normalize(aside);
      const double gap = 0.06 + 0.08 * static_cast<double>(random() >> 11U) * 0x1p-53;
      const RigidTransform pose =
          at((kBowl - kBall - gap) * aside, glm::angleAxis(0.1 * i, randomDirection(random)));
      std::vector<Lmd> lmds = bodies.minimaAt(pose);
      const glm::dvec3 truth = -(kRange - gap) / kRange * aside;
      const auto squaredError = [&] {
        const glm::dvec3 off = springWrench(lmds, springs, pose.translation, {}).force - truth;
        return glm::dot(off, off) / kPoses;
      };
      errors.raw += squaredError();
      errors.mostAreas = std::max(errors.mostAreas, bodies.merge(pose, lmds).areas);
      errors.grouped += squaredError();
    }
    return {std::sqrt(errors.raw), std::sqrt(errors.grouped), errors.mostAreas};
  }
};

TEST_F(BallInBowlAreas, TheForceOfOneSpringAnAreaConvergesAndTheRawSumDoesNot) {
  double last = 1.0;
  for (const std::uint32_t level : {2U, 3U, 4U, 5U}) {
    const Errors errors = errorsOf(level);
    // The direction of a facet's contact is off by its angle, which halves.
    EXPECT_LT(errors.grouped, 0.65 * last) << level;
    EXPECT_GT(errors.raw, 1.0) << level;
    // Coarse facets leave room between the surfaces that counts as a dent.
    if (level > 2) {
      EXPECT_EQ(errors.mostAreas, 1U) << level;
    }
    last = errors.grouped;
  }
  EXPECT_LT(last, 0.01);
}

/// A table upside up over a floor: legs of 10 mm at the corners of a square, 50 mm tall.
TriangleMesh table(double spacing, double height = 0.05) {
  TriangleMesh mesh = test::boxMesh({spacing + 0.02, spacing + 0.02, 0.01}, {0.0, 0.0, height + 0.005});
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5})
      mesh =
          test::joined(mesh, test::boxMesh({0.01, 0.01, height}, {spacing * x, spacing * y, 0.5 * height}));
  }
  return mesh;
}

TriangleMesh floorMesh() {
  return test::boxMesh({1.0, 1.0, 0.1}, {0.0, 0.0, -0.05});
}

TEST(MergeAreas, LegsOfATableKeepTheirSprings) {
  for (const double spacing : {0.02, 0.1, 0.5}) {
    Bodies bodies(floorMesh(), table(spacing), 0.01);
    EXPECT_EQ(bodies.areasAt(at({0.0, 0.0, 0.002})), 4U) << spacing;
    // Tilted too, when each touches with an edge or a corner.
    const glm::dquat tilt = glm::angleAxis(0.01, glm::normalize(glm::dvec3(1.0, 0.3, 0.0)));
    EXPECT_EQ(bodies.areasAt(at({0.0, 0.0, 0.002 + 0.006 * spacing}, tilt)), 4U) << spacing;
  }
}

TEST(MergeAreas, AGapThatOpensByMoreThanATwentiethOfTheCutoffParts) {
  // Feet so low that the gap between them decides: 5 % of 10 mm are 0.5 mm.
  for (const double height : {4e-4, 6e-4}) {
    Bodies bodies(floorMesh(), table(0.1, height), 0.01);
    EXPECT_EQ(bodies.areasAt(at({0.0, 0.0, 0.002})), height < 5e-4 ? 1U : 4U) << height;
  }
}

TEST(MergeAreas, WallsThatFaceOneAnotherAreTwo) {
  // A block in a slot of two walls, and on its floor.
  TriangleMesh slot = floorMesh();
  for (const double side : {-1.0, 1.0})
    slot = test::joined(slot, test::boxMesh({0.02, 0.5, 0.2}, {0.041 * side, 0.0, 0.1}));
  Bodies bodies(slot, test::boxMesh({0.06, 0.05, 0.04}, {0.0, 0.0, 0.02}), 0.01);
  EXPECT_EQ(bodies.areasAt(at({0.0, 0.0, 0.001})), 3U);
}

TEST(MergeAreas, ABallOverTwoPostsHasTwo) {
  TriangleMesh posts = test::boxMesh({0.01, 0.01, 0.1}, {-0.02, 0.0, -0.05});
  posts = test::joined(posts, test::boxMesh({0.01, 0.01, 0.1}, {0.02, 0.0, -0.05}));
  Bodies bodies(posts, test::icosphereMesh(0.1, 4), 0.01);
  const double height = std::sqrt(0.1 * 0.1 - 0.015 * 0.015) + 0.001;
  std::vector<Lmd> lmds = bodies.minimaAt(at({0.0, 0.0, height}));
  bodies.merge(at({0.0, 0.0, height}), lmds);
  // The nearest of each post is kept, whatever else is.
  for (const double side : {-1.0, 1.0}) {
    EXPECT_TRUE(std::ranges::any_of(lmds, [&](const Lmd& lmd) {
      return !lmd.isMerged && side * lmd.scenePoint.x > 0.0;
    })) << side;
  }
}

TEST(MergeAreas, KeepsTheNearestAndLeavesBlockedOnesOut) {
  Bodies bodies(test::bowlMesh(1.0, 1.2, 64, 16), test::icosphereMesh(0.5, 4), 0.25);
  const RigidTransform pose = at({0.02, 0.01, -0.42});
  std::vector<Lmd> lmds = bodies.minimaAt(pose);
  ASSERT_GT(lmds.size(), 2U);
  EXPECT_EQ(bodies.merge(pose, lmds).areas, 1U);
  EXPECT_FALSE(lmds[0].isMerged);
  lmds[0].isBlocked = true;
  EXPECT_EQ(bodies.merge(pose, lmds).areas, 1U);
  EXPECT_FALSE(lmds[0].isMerged);
  EXPECT_FALSE(lmds[1].isMerged);
  EXPECT_TRUE(lmds[2].isMerged);
}

TEST(MergeAreas, TheFrameOfTheBodiesDoesNotMatter) {
  const TriangleMesh bowl = test::bowlMesh(1.0, 1.2, 48, 12), ball = test::icosphereMesh(0.8, 3);
  const RigidTransform place =
      at({30.0, -20.0, 10.0}, glm::angleAxis(1.0, glm::normalize(glm::dvec3(1.0, 2.0, 3.0))));
  const RigidTransform other =
      at({-5.0, 2.0, 1.0}, glm::angleAxis(2.0, glm::normalize(glm::dvec3(0.0, 2.0, 1.0))));
  Bodies plain(bowl, ball, 0.25);
  Bodies moved(test::transformed(bowl, 1.0, place), test::transformed(ball, 1.0, other), 0.25);
  for (const double down : {0.05, 0.1, 0.15}) {
    const RigidTransform pose = at({0.013, 0.007, -down});
    EXPECT_EQ(plain.areasAt(pose), moved.areasAt((place * pose * other.inverse()).normalized())) << down;
  }
}

TEST(MergeAreas, StopsWithinItsWorkAndLeavesTheRestAlone) {
  Bodies bodies(test::bowlMesh(1.0, 1.2, 128, 32), test::icosphereMesh(0.8, 5), 0.25);
  const RigidTransform pose = at({0.02, 0.01, -0.14});
  std::vector<Lmd> lmds = bodies.minimaAt(pose);
  const AreaResult all = bodies.merge(pose, lmds);
  EXPECT_TRUE(all.isComplete);
  ASSERT_GT(all.work, 3 * kMaxAreaExcess);
  std::vector<Lmd> half = lmds;
  const AreaResult some = bodies.merge(pose, half, all.work / 2);
  EXPECT_FALSE(some.isComplete);
  EXPECT_LE(some.work, all.work / 2 + kMaxAreaExcess);
  EXPECT_GT(some.areas, all.areas);
  const AreaResult none = bodies.merge(pose, half, 0);
  EXPECT_EQ(none.areas, half.size());
  EXPECT_TRUE(std::ranges::none_of(half, &Lmd::isMerged)) << "set anew";
}

TEST(MergeAreas, AllocatesNothing) {
  Bodies bodies(test::bowlMesh(1.0, 1.2, 64, 16), test::icosphereMesh(0.5, 4), 0.25);
  const RigidTransform pose = at({0.02, 0.01, -0.42});
  std::vector<Lmd> lmds = bodies.minimaAt(pose);
  test::resetAllocationCount();
  test::startCountingAllocations();
  bodies.merge(pose, lmds);
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
}

}  // namespace
}  // namespace nearfit::contact_areas_test
