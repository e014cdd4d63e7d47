#include "core/proximity/query/lmd_query.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/trial_share.h"

namespace nearfit::lmd_query_test {
namespace {

using test::BodyPair;
using test::LmdTally;

TEST(LmdQuery, RandomClosedMeshesHaveTheBruteForceSetAtEveryScale) {
  std::mt19937_64 random(42);
  LmdTally sum;
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const double partScale = scale * std::pow(10.0, static_cast<double>(seed % 3) - 1.0);
      BodyPair pair{
          fmt::format("stars {} at scale {}", seed, scale),
          test::transformed(test::starMesh(seed, 1.0, 2, 0.4), scale),
          test::transformed(test::starMesh(seed + 100, 1.0, seed % 2 == 0 ? 1 : 2, 0.4), partScale)};
      const LmdTally tally = test::compareWithOracle(pair, 40 / test::kTrialShare, 0.2, random());
      sum.poses += tally.poses;
      sum.minima += tally.minima;
      sum.marginal += tally.marginal;
    }
  }
  EXPECT_EQ(sum.poses, 1440 / test::kTrialShare);
  EXPECT_GT(sum.minima, 3 * sum.poses);
  EXPECT_LT(sum.marginal, sum.minima / 1000 + 5);
}

TEST(LmdQuery, MeshesTenThousandDiagonalsFromTheirOriginsHaveTheBruteForceSet) {
  // Coordinates are rounded where the mesh lies; the oracle gets the same rounded mesh.
  LmdTally sum;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const RigidTransform away{{1, 0, 0, 0}, {1e4, -2e4, 1.5e4}}, back{{1, 0, 0, 0}, {-3e4, 1e3, 2e4}};
    const BodyPair pair{fmt::format("far {}", seed),
                        test::transformed(test::starMesh(seed, 1.0, 2, 0.3), 1.0, away),
                        test::transformed(test::starMesh(seed + 50, 1.0, 2, 0.3), 1.0, back)};
    const LmdTally tally = test::compareWithOracle(pair, 40 / test::kTrialShare, 0.2, seed);
    sum.poses += tally.poses;
    sum.minima += tally.minima;
  }
  EXPECT_GT(sum.minima, sum.poses);  // One a pose: there is something to compare.
}

TEST(LmdQuery, SwappingTheBodiesSwapsTheResult) {
  const BodyPair pair{"stars", test::starMesh(1, 1.0, 3, 0.3), test::starMesh(2, 0.5, 2, 0.3)};
  const NormalConeTree scene(pair.scene), part(pair.part);
  std::mt19937_64 random(5);
  std::size_t compared = 0;
  for (int i = 0; i < 200; ++i) {
    const RigidTransform pose = test::poseNearContact(pair, 0.1, random);
    const std::vector<Lmd> there = test::allLmds(scene, part, pose, 0.1),
                           back = test::allLmds(part, scene, pose.inverse(), 0.1);
    ASSERT_EQ(there.size(), back.size());
    for (const Lmd& a : there) {
      const bool isThere = std::any_of(back.begin(), back.end(), [&](const Lmd& b) {
        return glm::distance(a.scenePoint, pose.applyToPoint(b.partPoint)) < 1e-9 &&
               glm::distance(a.partPoint, pose.applyToPoint(b.scenePoint)) < 1e-9 &&
               a.sceneIndex == b.partIndex && a.partIndex == b.sceneIndex &&
               a.sceneFeature == b.partFeature && a.partFeature == b.sceneFeature &&
               glm::distance(a.direction, -(pose.rotation * b.direction)) < 1e-7;
      });
      EXPECT_TRUE(isThere);
      ++compared;
    }
  }
  EXPECT_GT(compared, 100U);
}

TEST(LmdQuery, MovingBothBodiesTogetherChangesNothing) {
  const BodyPair pair{"stars", test::starMesh(3, 1.0, 3, 0.3), test::starMesh(4, 0.5, 2, 0.3)};
  std::mt19937_64 random(6);
  const NormalConeTree scene(pair.scene), part(pair.part);
  for (std::size_t i = 0; i < 50 / test::kTrialShare; ++i) {
    const RigidTransform pose = test::poseNearContact(pair, 0.1, random);
    RigidTransform world = test::randomRotation(random);
    world.translation = {3.0, -2.0, 7.0};
    // Both meshes given in another frame: the same set, moved.
    const TriangleMesh moved = test::transformed(pair.scene, 1.0, world);
    const std::vector<Lmd> before = test::allLmds(scene, part, pose, 0.1);
    const std::vector<Lmd> after = test::allLmds(NormalConeTree(moved), part, world * pose, 0.1);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t k = 0; k < before.size(); ++k) {
      EXPECT_NEAR(before[k].distance, after[k].distance, 1e-12);
      EXPECT_LT(glm::distance(world.applyToPoint(before[k].scenePoint), after[k].scenePoint), 1e-9);
    }
  }
}

TEST(LmdQuery, EachInstructionSetGivesTheSameSet) {
  const BodyPair pair{"stars", test::starMesh(11, 1.0, 4, 0.2), test::starMesh(12, 0.7, 3, 0.3)};
  const NormalConeTree scene(pair.scene), part(pair.part);
  std::mt19937_64 random(7);
  std::vector<Lmd> expected(4096), found(4096);
  LmdScratch portable(LmdScratch::kDefaultCapacity, SimdLevel::Portable);
  ASSERT_EQ(availableSimdLevels().front(), SimdLevel::Portable);
  std::size_t compared = 0;
  for (int i = 0; i < 60; ++i) {
    const RigidTransform pose = test::poseNearContact(pair, 0.1, random);
    const std::size_t count = findLmds(scene, part, pose, 0.15, portable, expected).count;
    for (const SimdLevel level : availableSimdLevels()) {
      LmdScratch scratch(LmdScratch::kDefaultCapacity, level);
      ASSERT_EQ(findLmds(scene, part, pose, 0.15, scratch, found).count, count);
      for (std::size_t k = 0; k < count; ++k) {
        EXPECT_EQ(found[k].scenePoint, expected[k].scenePoint);
        EXPECT_EQ(found[k].partPoint, expected[k].partPoint);
      }
      compared += count;
    }
  }
  EXPECT_GT(compared, 100U);
}

}  // namespace
}  // namespace nearfit::lmd_query_test
