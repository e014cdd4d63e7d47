#include "core/proximity/query/merge_minima.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/query/lmd_query.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/merge_oracle.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/random_values.h"
#include "tests/support/trial_share.h"

namespace nearfit::merge_minima_test {
namespace {

/// Half the diagonal of a square peg, in a hole of 1; a gap of 7 mm at each of four walls.
constexpr double kPeg = 0.99;

TriangleMesh squareHole(std::uint32_t fineness) {
  return test::subdivided(test::tubeMesh(1.0, 2.0, 1.0, 4), fineness);
}
TriangleMesh squarePeg(std::uint32_t fineness) {
  return test::subdivided(test::cylinderMesh(kPeg, 3.0, 4), fineness);
}

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

/// What merging makes of entries, told by the oracle's words.
struct Merged {
  std::vector<std::uint32_t> first;
  std::vector<bool> isOverlapping;
  MergeResult result;
  std::vector<Lmd> lmds;
};

Merged merged(std::vector<Minimum> minima, double size, double smallerSize) {
  MergeWork work(minima.size());
  std::vector<std::uint32_t> order(minima.size());
  Merged out;
  out.result = mergeMinima(minima, order, work, size, smallerSize);
  out.first.assign(work.parent.begin(), work.parent.end());
  for (const Minimum& m : minima)
    out.isOverlapping.push_back(m.isOverlapping);
  for (std::size_t i = 0; i < out.result.count; ++i)
    out.lmds.push_back(minima[order[i]].lmd);
  return out;
}

/// @returns how many entries there were.
std::size_t compareWithAllPairs(const NormalConeTree& scene, const NormalConeTree& part,
                                const RigidTransform& pose, double cutoff) {
  const std::vector<Minimum> minima = test::unmergedMinima(scene, part, pose, cutoff);
  const double size = scene.size() + part.size(), smaller = std::min(scene.size(), part.size());
  const Merged ours = merged(minima, size, smaller);
  std::vector<Minimum> marked = minima;
  EXPECT_EQ(ours.first, test::setsByAllPairs(marked, TouchTolerances(size, smaller)));
  for (std::size_t i = 0; i < marked.size(); ++i)
    EXPECT_EQ(ours.isOverlapping[i], marked[i].isOverlapping) << i;
  EXPECT_EQ(ours.result.count, std::set(ours.first.begin(), ours.first.end()).size());
  return minima.size();
}

TEST(MergeMinima, ConformingContactHasTheSetsOfAllPairs) {
  test::RandomValues random(5);
  const NormalConeTree hole(squareHole(2)), peg(squarePeg(2));
  std::size_t entries = 0;
  for (std::size_t i = 0; i < 24 / test::kTrialShare; ++i) {
    RigidTransform pose = at({random.in(-0.005, 0.005), random.in(-0.005, 0.005), random.in(-1.0, 1.0)});
    // Straight, tilted within what counts as flat, turned so that it does not.
    const double tilt = random.flip(0.4) ? 0.0 : std::pow(10.0, random.in(-10.0, -3.0));
    pose.rotation = glm::angleAxis(tilt, glm::normalize(random.vector(1.0)));
    entries += compareWithAllPairs(hole, peg, pose, 0.05);
  }
  EXPECT_GT(entries, 1000U / test::kTrialShare);
}

TEST(MergeMinima, PosesOfParallelFacesHaveTheSetsOfAllPairs) {
  const auto slab = [](const glm::dvec3& size, const glm::dvec3& centre = glm::dvec3(0.0)) {
    return test::subdivided(test::boxMesh(size, centre), 1);
  };
  const std::vector<test::BodyPair> pairs{
      {"boxes", slab({1, 0.7, 0.5}), slab({0.4, 0.6, 0.3})},
      {"tube on box", slab({1, 0.7, 0.5}), test::tubeMesh(0.2, 0.3, 0.4, 17)},
      {"overlapping boxes", test::joined(slab({1, 0.3, 0.5}), slab({0.3, 1, 0.5}, {0.1, 0.2, 0.0})),
       test::joined(slab({0.5, 0.2, 0.1}), slab({0.2, 0.5, 0.1}, {0.1, 0.0, 0.0}))},
      {"discs", test::cylinderMesh(1.0, 0.3, 40), test::cylinderMesh(0.8, 0.3, 33)}};
  std::mt19937_64 random(6);
  std::size_t entries = 0;
  for (const test::BodyPair& pair : pairs) {
    const NormalConeTree scene(pair.scene), part(pair.part);
    for (std::size_t i = 0; i < 40 / test::kTrialShare; ++i) {
      const double tilt = i % 2 == 0 ? 0.0 : std::pow(10.0, -static_cast<double>(i % 7) - 6.0);
      const RigidTransform pose = test::poseWithParallelFaces(pair, 0.1, tilt, random);
      entries += compareWithAllPairs(scene, part, pose, 0.15);
    }
  }
  EXPECT_GT(entries, 1000U / test::kTrialShare);
}

TEST(MergeMinima, JaggedBodiesHaveTheSetsOfAllPairs) {
  const NormalConeTree scene(test::starMesh(1, 1.0, 2, 0.3)), part(test::starMesh(2, 1.0, 2, 0.3));
  std::mt19937_64 random(7);
  std::size_t entries = 0;
  for (int i = 0; i < 16; ++i) {
    RigidTransform pose = test::randomRotation(random);
    pose.translation = {2.0, 0.8, 0.3};
    entries += compareWithAllPairs(scene, part, pose, 1.0);
  }
  EXPECT_GT(entries, 100U);
}

/// A plate about the origin, top and bottom cut into many triangles that get narrower towards the middle, by
/// a power of where they are.
TriangleMesh finelyCutPlate(double power) {
  const TriangleMesh plate = test::subdivided(test::boxMesh({2.0, 2.0, 1.0}), 2);
  std::vector<glm::dvec3> vertices(plate.vertices().begin(), plate.vertices().end());
  for (glm::dvec3& v : vertices)
    v.x = std::copysign(std::pow(std::abs(v.x), power), v.x);
  return {std::move(vertices), {plate.triangles().begin(), plate.triangles().end()}};
}

TEST(MergeMinima, BoxesOnFinelyCutPlatesHaveTheSetsOfAllPairs) {
  test::RandomValues random(11);
  const TriangleMesh coarse = finelyCutPlate(1.0), narrow = finelyCutPlate(12.0);
  // Twice the same, and two that cover each other askew: pieces that overlap.
  const std::vector<TriangleMesh> plates{
      coarse, narrow, test::joined(coarse, coarse),
      test::joined(coarse, test::transformed(narrow, 1.0, {glm::angleAxis(0.7, glm::dvec3(0, 0, 1)), {}}))};
  const NormalConeTree box(test::subdivided(test::boxMesh({0.9, 0.7, 1.0}), 1));
  std::size_t entries = 0;
  for (const TriangleMesh& plate : plates) {
    const NormalConeTree scene(plate);
    for (std::size_t i = 0; i < 8 / test::kTrialShare; ++i) {
      // Askew, square to the triangles' sides, tilted a little.
      const double turn = i % 4 == 0 ? 0.0 : random.in(0.0, std::numbers::pi);
      const double tilt = i % 2 == 0 ? 0.0 : std::pow(10.0, random.in(-10.0, -5.0));
      const RigidTransform pose{
          glm::angleAxis(tilt, glm::dvec3(1, 0, 0)) * glm::angleAxis(turn, glm::dvec3(0, 0, 1)),
          {i % 4 == 0 ? 0.05 : random.in(-0.3, 0.3), random.in(-0.3, 0.3), 1.01}};
      entries += compareWithAllPairs(scene, box, pose, 0.05);
    }
  }
  EXPECT_GT(entries, 2000U / test::kTrialShare);
}

TEST(MergeMinima, OrderOfEntriesChangesNothing) {
  const NormalConeTree hole(squareHole(2)), peg(squarePeg(2));
  std::vector<Minimum> minima = test::unmergedMinima(hole, peg, at({0.001, 0.002, 0.3}), 0.05);
  const double size = hole.size() + peg.size();
  const Merged before = merged(minima, size, hole.size());
  ASSERT_EQ(before.lmds.size(), 4U);
  std::mt19937_64 random(8);
  for (int i = 0; i < 5; ++i) {
    std::shuffle(minima.begin(), minima.end(), random);
    const Merged after = merged(minima, size, hole.size());
    ASSERT_EQ(after.lmds.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(after.lmds[k].distance, before.lmds[k].distance);
      EXPECT_EQ(after.lmds[k].scenePoint, before.lmds[k].scenePoint);
      EXPECT_EQ(after.lmds[k].extent.measure, before.lmds[k].extent.measure);
      EXPECT_EQ(after.lmds[k].sceneIndex, before.lmds[k].sceneIndex);
    }
  }
}

TEST(MergeMinima, WorkGrowsAsThePiecesOfConformingContactDo) {
  // Where triangles of two walls lie over each other, a piece has a few neighbours however many there are.
  constexpr double kMaxNeighbours = 16.0, kMaxTestsOfAPiece = 4.0;
  const RigidTransform pose = at({0.001, 0.002, 0.0123});
  for (const std::uint32_t fineness : {2U, 3U, 4U, 5U}) {
    const NormalConeTree hole(squareHole(fineness)), peg(squarePeg(fineness));
    LmdScratch scratch(65536);
    std::vector<Lmd> out(64);
    const LmdResult found = findLmds(hole, peg, pose, 0.05, scratch, out);
    ASSERT_EQ(found.status, QueryStatus::Complete);
    EXPECT_EQ(found.count, 4U);
    // Each of the walls' triangles lies over at least one of the peg's.
    const auto least = static_cast<std::size_t>(8.0 * std::pow(4.0, fineness));
    EXPECT_GE(found.pieces, least);
    const auto pieces = static_cast<double>(found.pieces);
    EXPECT_LE(static_cast<double>(found.piecePairs), kMaxNeighbours * pieces) << fineness;
  }
  const NormalConeTree hole(squareHole(3)), peg(squarePeg(3));
  const std::vector<Minimum> minima = test::unmergedMinima(hole, peg, pose, 0.05);
  const Merged ours = merged(minima, hole.size() + peg.size(), hole.size());
  const auto pieces = static_cast<double>(minima.size());
  EXPECT_LE(static_cast<double>(ours.result.touchings), kMaxTestsOfAPiece * pieces);
  // A set of m entries takes m - 1 that touch.
  EXPECT_GE(ours.result.touchings, minima.size() - 4);
}

TEST(MergeMinima, ConformingContactMeasuresWhatTheWallsHaveInCommon) {
  // Four walls as wide as the peg, as high as the hole is deep.
  const NormalConeTree hole(squareHole(4)), peg(squarePeg(4));
  const auto found = test::allLmds(hole, peg, at({0, 0, 0.0123}), 0.05);
  ASSERT_EQ(found.size(), 4U);
  for (const Lmd& wall : found) {
    EXPECT_NEAR(wall.distance, (1.0 - kPeg) / std::numbers::sqrt2, 1e-12);
    EXPECT_NEAR(wall.extent.measure, kPeg * std::numbers::sqrt2 * 1.0, 1e-10);
    EXPECT_NEAR(wall.scenePoint.z, 0.0, 1e-10);
  }
}

}  // namespace
}  // namespace nearfit::merge_minima_test
