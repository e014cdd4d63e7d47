#include "core/proximity/query/pair_separations.h"

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/math/rotation_vector.h"
#include "core/proximity/query/contact_query.h"
#include "core/proximity/query/query_workspace.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::pair_separations_test {
namespace {

/// Min distance of points spread over two features, in the frame of the scene's mesh: never less than theirs.
double sampledDistance(const NormalConeTree& scene, const NormalConeTree& part, const LeafPair& pair,
                       const RigidTransform& pose, std::mt19937_64& random) {
  const auto cornersOf = [](const NormalConeTree& tree, std::uint32_t leaf) {
    const std::uint32_t i = NormalConeTree::leafIndex(leaf);
    std::vector<std::uint32_t> at;
    if (NormalConeTree::leafKind(leaf) == FeatureKind::Vertex)
      at = {tree.vertices()[i].vertex};
    else if (NormalConeTree::leafKind(leaf) == FeatureKind::Edge)
      at = {tree.edges()[i].v0, tree.edges()[i].v1};
    else
      at.assign(tree.faces()[i].corners.begin(), tree.faces()[i].corners.end());
    std::vector<glm::dvec3> corners;
    for (const std::uint32_t v : at)
      corners.push_back(tree.mesh().vertices()[v]);
    return corners;
  };
  std::exponential_distribution<double> weight(1.0);
  const auto pointOf = [&](const std::vector<glm::dvec3>& corners) {
    glm::dvec3 sum(0.0);
    double total = 0.0;
    for (const glm::dvec3& corner : corners) {
      const double w = weight(random);
      sum += w * corner;
      total += w;
    }
    return sum / total;
  };
  const std::vector<glm::dvec3> a = cornersOf(scene, pair.scene), b = cornersOf(part, pair.part);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 40; ++i)
    least = std::min(least, glm::distance(pointOf(a), pose.applyToPoint(pointOf(b))));
  for (const glm::dvec3& p : a) {
    for (const glm::dvec3& q : b)
      least = std::min(least, glm::distance(p, pose.applyToPoint(q)));
  }
  return least;
}

/// Wherever the part goes, and by every instruction set.
TEST(PairSeparations, AreLowerBoundsAtEveryPose) {
  const test::BodyPair pair{"stars", test::starMesh(41, 1.0, 2, 0.25), test::starMesh(42, 0.7, 2, 0.25)};
  const NormalConeTree scene(pair.scene), part(pair.part);
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  LmdScratch scratch;
  std::vector<LeafPair> pairs(1U << 16);
  std::size_t compared = 0, tight = 0, ofPart = 0;
  for (int i = 0; i < 12; ++i) {
    const RigidTransform pose = test::poseNearContact(pair, 0.2, random);
    const NearbyPairs nearby =
        findNearbyPairs({scene, part, pose, 0.3}, {0.3, 0.3}, {}, scratch, pairs, 1U << 20);
    ASSERT_TRUE(nearby.isComplete);
    const RigidTransform centred = centredPose(scene, part, pose);
    for (std::size_t k = 0; k < nearby.count; k += 11) {
      const PairDirections directions = directionsOf(scene, part, pairs[k], centred);
      if (directions.apart == glm::dvec3(0.0)) continue;
      const Separation separation = separationAlong(scene, part, pairs[k], centred, directions.apart);
      EXPECT_EQ(separation.isOfPart, isSeparatedByPart(pairs[k]));
      ofPart += separation.isOfPart ? 1 : 0;
      SeparatedPairs block{};
      block.set(k % SeparatedPairs::kLanes, separation);
      RigidTransform there = pose;
      for (int move = 0; move < 4; ++move) {
        const double distance = sampledDistance(scene, part, pairs[k], there, random);
        for (const SimdLevel level : availableSimdLevels()) {
          // Every pair is looked for.
          const SeparationScan scan{
              .pose = separationPose(centredPose(scene, part, there), separation.isOfPart),
              .near = std::numeric_limits<double>::infinity()};
          const auto held = static_cast<std::uint8_t>(1U << k % SeparatedPairs::kLanes);
          SeparationsFound found;
          double lowest = std::numeric_limits<double>::infinity();
          ASSERT_EQ(separationKernel(level)(&block, &held, 0, 1, scan, found, lowest), 0U);
          const double bound = found.apart[k % SeparatedPairs::kLanes];
          ASSERT_LE(bound, distance + 1e-12) << i << ", pair " << k << ", move " << move;
          if (move == 0 && bound > 0.7 * distance) ++tight;
          ++compared;
        }
        const glm::dvec3 spin = 0.2 * glm::dvec3(share(random), share(random), share(random));
        there.rotation = glm::normalize(rotationOf(spin) * there.rotation);
        there.translation += 0.1 * glm::dvec3(share(random), share(random), share(random));
      }
    }
  }
  EXPECT_GT(compared, 1000U);
  EXPECT_GT(tight, compared / 16);
  EXPECT_GT(ofPart, 50U);
}

/// A pair at x = `height` and a point of the other body at the origin: apart by the point's place less the height.
Separation atHeight(double height) {
  return {.direction = {1.0, 0.0, 0.0}, .height = height, .ends = {glm::dvec3(0.0), glm::dvec3(0.0)}};
}

TEST(PairSeparations, AScanStopsAtTheFirstBlockWithAPairThatItLooksFor) {
  constexpr std::size_t kBlocks = 6;
  std::vector<SeparatedPairs> blocks(kBlocks);
  std::vector<std::uint8_t> held(kBlocks, 0xFF);
  for (std::size_t i = 0; i < kBlocks * SeparatedPairs::kLanes; ++i)
    blocks[i / SeparatedPairs::kLanes].set(i % SeparatedPairs::kLanes,
                                           atHeight(-1.0 - static_cast<double>(i)));
  // In block 1 only among pairs that are not held, in block 3 among those that are.
  blocks[1].set(2, atHeight(-0.1));
  held[1] = 0xFB;
  blocks[3].set(7, atHeight(-0.2));
  held[0] = 0;
  for (const SimdLevel level : availableSimdLevels()) {
    SeparationsFound found;
    double lowest = std::numeric_limits<double>::infinity();
    SeparationScan scan{.near = 0.5};
    EXPECT_EQ(separationKernel(level)(blocks.data(), held.data(), 0, kBlocks, scan, found, lowest), 3U);
    EXPECT_EQ(found.apart[7], 0.2);
    EXPECT_EQ(found.apart[0], 25.0);
    EXPECT_EQ(lowest, 9.0);
    lowest = 2.0;
    EXPECT_EQ(separationKernel(level)(blocks.data(), held.data(), 4, kBlocks, scan, found, lowest), kBlocks);
    EXPECT_EQ(lowest, 2.0);
    // On a way that began 30 m nearer.
    scan.isOfWay = true;
    scan.start.shift = {-30.0, 0.0, 0.0};
    scan.nearOnWay = 5.0;
    lowest = std::numeric_limits<double>::infinity();
    EXPECT_EQ(separationKernel(level)(blocks.data(), held.data(), 4, kBlocks, scan, found, lowest), 4U);
    EXPECT_EQ(found.atStart[0], 3.0);
    EXPECT_EQ(lowest, std::numeric_limits<double>::infinity());
  }
}

}  // namespace
}  // namespace nearfit::pair_separations_test
