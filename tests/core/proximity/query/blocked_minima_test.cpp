#include "core/proximity/query/blocked_minima.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/passage_oracle.h"

namespace nearfit::blocked_minima_test {
namespace {

using test::BodyPair;
using test::Passage;

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

/// The set at a pose, each minimum marked.
std::vector<Lmd> marked(const TriangleMesh& scene, const TriangleMesh& part, const RigidTransform& pose,
                        double cutoff) {
  const NormalConeTree sceneTree(scene), partTree(part);
  std::vector<Lmd> lmds = test::allLmds(sceneTree, partTree, pose, cutoff);
  LmdScratch scratch;
  markBlocked(sceneTree, partTree, pose, lmds, 0.0, scratch);
  return lmds;
}

/// A cone that stands on its tip at the origin.
TriangleMesh tip() {
  const double pi = std::acos(-1.0);
  return test::transformed(test::coneMesh(0.5, 1.0, 7), 1.0,
                           {glm::angleAxis(pi, glm::dvec3(1, 0, 0)), {0, 0, 1}});
}

/// Blocks side by side along x on a common back.
TriangleMesh comb(int teeth, double toothWidth, double pitch, double depth) {
  TriangleMesh mesh = test::boxMesh({pitch * teeth, 0.3, 0.1}, {0, 0, 0.05});
  for (int i = 0; i < teeth; ++i) {
    const double x = pitch * (i - 0.5 * (teeth - 1));
    mesh = test::joined(mesh, test::boxMesh({toothWidth, 0.28, depth + 0.02}, {x, 0, -0.5 * depth + 0.01}));
  }
  return mesh;
}

TriangleMesh clamp() {
  TriangleMesh mesh = test::boxMesh({1.0, 0.2, 0.1}, {0, 0, 0.45});
  mesh = test::joined(mesh, test::boxMesh({1.0, 0.2, 0.1}, {0, 0, -0.45}));
  return test::joined(mesh, test::boxMesh({0.1, 0.19, 0.95}, {-0.44, 0, 0}));
}

TriangleMesh shell(double size, double wall) {
  return test::joined(test::boxMesh(glm::dvec3(size)),
                      test::turned(test::boxMesh(glm::dvec3(size - 2.0 * wall))));
}

struct Agreement {
  std::size_t free = 0, blocked = 0, marginal = 0, apartPoses = 0;
};

/// Compares at random poses with the oracle, for each instruction set, and where the surfaces do not meet
/// also with the least distance.
Agreement compare(const BodyPair& pair, std::size_t poses, double cutoff, std::uint64_t seed) {
  // Beyond twice what counts as touching here, and the oracle's grid.
  constexpr double kTolerance = 1e-7;
  const NormalConeTree sceneTree(pair.scene), partTree(pair.part);
  std::mt19937_64 random(seed);
  Agreement tally;
  for (std::size_t i = 0; i < poses; ++i) {
    const RigidTransform pose = test::poseNearContact(pair, 0.5 * cutoff, random);
    const test::PassageOracle scene(pair.scene, {}), part(pair.part, pose);
    std::vector<Lmd> lmds = test::allLmds(sceneTree, partTree, pose, cutoff);
    const bool isApart = !lmds.empty() && !scene.meets(part);
    tally.apartPoses += isApart ? 1 : 0;
    for (const SimdLevel level : availableSimdLevels()) {
      LmdScratch scratch(16, level);
      markBlocked(sceneTree, partTree, pose, lmds, 0.0, scratch);
      if (isApart) {
        std::vector<Lmd> short_(lmds);
        markBlocked(sceneTree, partTree, pose, short_, lmds.front().distance, scratch);
        for (std::size_t k = 0; k < lmds.size(); ++k)
          EXPECT_EQ(short_[k].isBlocked, lmds[k].isBlocked) << pair.name << ", pose " << i;
        EXPECT_FALSE(short_.front().isBlocked);
      }
      for (const Lmd& lmd : lmds) {
        const Passage a = scene.passage(lmd.scenePoint, lmd.partPoint, kTolerance),
                      b = part.passage(lmd.scenePoint, lmd.partPoint, kTolerance);
        if (a == Passage::Blocked || b == Passage::Blocked) {
          EXPECT_TRUE(lmd.isBlocked) << pair.name << ", pose " << i << " at " << lmd.distance;
          ++tally.blocked;
        } else if (a == Passage::Free && b == Passage::Free) {
          EXPECT_FALSE(lmd.isBlocked) << pair.name << ", pose " << i << " at " << lmd.distance;
          ++tally.free;
        } else {
          ++tally.marginal;
        }
      }
    }
  }
  return tally;
}

/// The poses have minima of either kind to compare.
void expectAgreement(const BodyPair& pair, std::size_t poses, double cutoff, std::uint64_t seed) {
  const Agreement tally = compare(pair, poses, cutoff, seed);
  EXPECT_GT(tally.free, poses / 4) << pair.name;
  EXPECT_GT(tally.blocked, poses / 10) << pair.name;
  EXPECT_LT(tally.marginal, (tally.free + tally.blocked) / 200 + 5) << pair.name;
}

TEST(BlockedMinima, PlateBetweenTwoFacesBlocksThem) {
  const TriangleMesh scene =
      test::joined(test::boxMesh({2, 2, 1}, {0, 0, -0.5}), test::boxMesh({2, 2, 0.001}, {0, 0, 0.1}));
  const std::vector<Lmd> lmds = marked(scene, test::boxMesh({1, 1, 1}), at({0, 0, 0.7}), 0.5);
  ASSERT_EQ(lmds.size(), 2U);  // The top of the plate, then the floor below it.
  EXPECT_NEAR(lmds[0].distance, 0.2 - 0.1 - 0.0005, 1e-12);
  EXPECT_FALSE(lmds[0].isBlocked);
  EXPECT_NEAR(lmds[1].distance, 0.2, 1e-12);
  EXPECT_TRUE(lmds[1].isBlocked);
}

TEST(BlockedMinima, OverlappingComponentOfThePartBlocks) {
  // The lower of two blocks that overlap is what the floor meets; the upper one's bottom is inside of it.
  const TriangleMesh part =
      test::joined(test::boxMesh({0.5, 0.5, 0.5}, {0, 0, 0.25}), test::boxMesh({1, 1, 1}, {0, 0, 0.6}));
  const std::vector<Lmd> lmds = marked(test::squareMesh(4.0, 3), part, at({0.1, 0.2, 0.05}), 0.3);
  ASSERT_EQ(lmds.size(), 2U);
  EXPECT_FALSE(lmds[0].isBlocked);
  EXPECT_NEAR(lmds[1].distance, 0.15, 1e-12);
  EXPECT_TRUE(lmds[1].isBlocked);
}

TEST(BlockedMinima, WallFlushWithTheSegmentDoesNotBlock) {
  const auto blockedBeside = [](double gap) {
    const TriangleMesh scene =
        test::joined(test::squareMesh(4.0, 4), test::boxMesh({1, 1, 0.2}, {0.5 + gap, 0, 0.25}));
    const std::vector<Lmd> lmds = marked(scene, tip(), at({0, 0, 0.5}), 0.6);
    const auto floor = std::find_if(lmds.begin(), lmds.end(),
                                    [](const Lmd& l) { return std::abs(l.distance - 0.5) < 1e-12; });
    EXPECT_NE(floor, lmds.end());
    return floor != lmds.end() && floor->isBlocked;
  };
  EXPECT_FALSE(blockedBeside(1e-6));
  EXPECT_FALSE(blockedBeside(0.0));
  EXPECT_TRUE(blockedBeside(-1e-6));
}

TEST(BlockedMinima, RandomPosesAgreeWithExactBruteForce) {
  expectAgreement({"nested shells", test::joined(shell(1.0, 0.05), shell(0.6, 0.03)),
                   test::joined(shell(0.4, 0.05), test::boxMesh({0.2, 0.2, 0.2}))},
                  150, 0.4, 1);
  expectAgreement({"comb in comb", comb(4, 0.1, 0.25, 0.4), comb(3, 0.1, 0.25, 0.4)}, 100, 0.3, 2);
  expectAgreement(
      {"overlapping components", test::joined(test::starMesh(3, 0.5, 2, 0.3), test::starMesh(4, 0.4, 2, 0.3)),
       test::joined(test::boxMesh({0.5, 0.5, 0.5}), test::starMesh(5, 0.35, 1, 0.2))},
      60, 0.2, 3);
  expectAgreement({"clamp", clamp(), test::joined(test::boxMesh({0.3, 0.3, 0.3}), clamp())}, 150, 0.4, 4);
  expectAgreement(
      {"thin plates", test::joined(test::boxMesh({1, 1, 1e-4}), test::boxMesh({1, 1, 1e-4}, {0.1, 0, 0.1})),
       test::boxMesh({0.3, 0.4, 0.05})},
      150, 0.3, 5);
}

TEST(BlockedMinima, RandomPosesOfFinelyMeshedRingsAgreeWithExactBruteForce) {
  const RigidTransform upright{glm::angleAxis(0.5 * std::acos(-1.0), glm::dvec3(1, 0, 0)), {0.2, 0, 0}};
  const TriangleMesh ring = test::torusMesh(0.2, 0.05, 24, 8);
  expectAgreement({"rings in tube", test::tubeMesh(0.3, 0.35, 0.4, 24),
                   test::joined(ring, test::transformed(ring, 1.0, upright))},
                  60, 0.3, 6);
}

TEST(BlockedMinima, EveryFaceWithAnAreaIsInTheHierarchy) {
  const TriangleMesh star = test::starMesh(9, 1.0, 3, 0.4);
  EXPECT_EQ(NormalConeTree(star).keptFeatures().faces, star.triangles().size());
  const TriangleMesh tube = test::tubeMesh(0.5, 1.0, 0.4, 32);
  EXPECT_EQ(NormalConeTree(tube).keptFeatures().faces, tube.triangles().size());
}

TEST(BlockedMinima, SenselessPosesMarkNothing) {
  const NormalConeTree box(test::boxMesh({1, 1, 1}));
  LmdScratch scratch;
  std::vector<Lmd> lmds = test::allLmds(box, box, at({1.5, 0, 0}), 1.0);
  ASSERT_EQ(lmds.size(), 1U);
  markBlocked(box, box, at({std::nan(""), 0, 0}), lmds, 0.0, scratch);
  EXPECT_FALSE(lmds[0].isBlocked);
  markBlocked(box, NormalConeTree(TriangleMesh()), at({1.5, 0, 0}), lmds, 0.0, scratch);
  EXPECT_FALSE(lmds[0].isBlocked);
}

}  // namespace
}  // namespace nearfit::blocked_minima_test
