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
          const std::uint8_t tested = 0;
          SeparationsFound found;
          separationKernel(level)(&block, &held, &tested, 1, scan, found);
          ASSERT_EQ(found.near[0], held);
          const double bound = found.apart[0][k % SeparatedPairs::kLanes];
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

TEST(PairSeparations, AScanNamesThePairsThatAreNearAndBoundsTheOthers) {
  constexpr std::size_t kBlocks = 6, kLanes = SeparatedPairs::kLanes;
  std::vector<SeparatedPairs> blocks(kBlocks);
  std::vector<std::uint8_t> held(kBlocks, 0xFF), tested(kBlocks, 0);
  for (std::size_t i = 0; i < kBlocks * kLanes; ++i)
    blocks[i / kLanes].set(i % kLanes, atHeight(-1.0 - static_cast<double>(i)));
  // In block 1 among pairs that are not held; in block 3 one that was tested and one that was not, both of two.
  blocks[1].set(2, atHeight(-0.1));
  held[1] = 0xFB;
  for (const std::size_t lane : {4, 5}) {
    blocks[3].set(lane, atHeight(-0.2));
    blocks[3].set(lane + 2, atHeight(-0.4));
  }
  tested[3] = 0b1010'0000;
  held[0] = 0;
  for (const SimdLevel level : availableSimdLevels()) {
    const SeparationKernel kernel = separationKernel(level);
    SeparationsFound found;
    SeparationScan scan{.near = 0.5, .nearOfTested = 0.3};
    kernel(blocks.data(), held.data(), tested.data(), kBlocks, scan, found);
    for (std::size_t block = 0; block < kBlocks; ++block) {
      EXPECT_EQ(found.near[block], block == 3 ? 0b0111'0000 : 0) << block;
      EXPECT_EQ(found.nearOnWay[block], 0) << block;
    }
    EXPECT_EQ(found.apart[3][4], 0.2);
    EXPECT_EQ(found.apart[3][6], 0.4);
    EXPECT_EQ(found.lowest, 0.4) << "of the tested pair that is not near";
    scan.nearOfTested = 0.5;
    kernel(blocks.data(), held.data(), tested.data(), kBlocks, scan, found);
    EXPECT_EQ(found.near[3], 0b1111'0000);
    EXPECT_EQ(found.lowest, 9.0);
    // Blocks 4 and 5 on a way that began 30 m nearer: pairs are 33 to 48 m apart at its end.
    scan.isOfWay = true;
    scan.start.shift = {-30.0, 0.0, 0.0};
    scan.nearOnWay = 5.0;
    kernel(&blocks[4], &held[4], &tested[4], 2, scan, found);
    EXPECT_EQ(found.near[0], 0);
    EXPECT_EQ(found.nearOnWay[0], 0b0000'0111);
    EXPECT_EQ(found.nearOnWay[1], 0);
    EXPECT_EQ(found.apart[0][0], 33.0);
    EXPECT_EQ(found.lowest, 33.0);
    // Nothing is left over from an earlier scan.
    held[4] = 0;
    kernel(&blocks[4], &held[4], &tested[4], 1, scan, found);
    EXPECT_EQ(found.near[0] | found.nearOnWay[0], 0);
    EXPECT_EQ(found.lowest, std::numeric_limits<double>::infinity());
    held[4] = 0xFF;
  }
}

}  // namespace
}  // namespace nearfit::pair_separations_test
