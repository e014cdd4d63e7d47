#include "core/proximity/query/segment_pairs.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/proximity/query/contact_query.h"
#include "core/proximity/query/edge_pairs.h"
#include "core/proximity/query/query_workspace.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::segment_pairs_test {
namespace {

using test::BodyPair;

std::vector<BodyPair> bodyPairs(double scale) {
  std::vector<BodyPair> pairs{
      {"stars", test::starMesh(51, 1.0, 2, 0.25), test::starMesh(52, 0.7, 2, 0.25)},
      {"boxes", test::boxMesh({1.0, 1.0, 1.0}), test::subdivided(test::boxMesh({0.6, 0.4, 0.5}), 1)},
      {"peg in bore", test::tubeMesh(0.5, 0.8, 1.0, 24), test::cylinderMesh(0.45, 2.0, 24)},
  };
  for (BodyPair& pair : pairs) {
    pair.scene = test::transformed(pair.scene, scale);
    pair.part = test::transformed(pair.part, scale);
  }
  return pairs;
}

struct Counts {
  std::size_t edges = 0, withVertex = 0, undecided = 0;
};

/// Compares each lane of a block with what single pairs give, for each instruction set.
void compare(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& pose,
             std::span<const LeafPair, SegmentPairs::kLanes> pairs, Counts& counts) {
  SegmentPairs block;
  packSegmentPairs(scene, part, pairs, block);
  for (const SimdLevel level : availableSimdLevels()) {
    SegmentSeparations found;
    segmentSeparationKernel(level)(block, separationPose(pose, false), found);
    for (std::size_t lane = 0; lane < SegmentPairs::kLanes; ++lane) {
      if ((found.undecided >> lane & 1U) != 0) {
        ++counts.undecided;
        continue;
      }
      const PairDirections expected = directionsOf(scene, part, pairs[lane], pose),
                           directions = found.directions(lane);
      const Separation separation = separationAlong(scene, part, pairs[lane], pose, expected.apart);
      EXPECT_EQ(directions.apart, expected.apart);
      EXPECT_EQ(directions.ofContact, expected.ofContact);
      EXPECT_EQ(directions.onPart, expected.onPart);
      EXPECT_EQ(directions.distance, expected.distance);
      EXPECT_EQ(found.height[lane], separation.height);
      ++(isOfEdges(pairs[lane]) ? counts.edges : counts.withVertex);
    }
  }
}

TEST(SegmentPairs, EachInstructionSetSaysWhatSinglePairsSayToTheLastBit) {
  Counts counts;
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (const BodyPair& bodies : bodyPairs(scale)) {
      SCOPED_TRACE(bodies.name + " at " + std::to_string(scale));
      const NormalConeTree scene(bodies.scene), part(bodies.part);
      std::mt19937_64 random(53);
      LmdScratch scratch;
      std::vector<LeafPair> pairs(1U << 16);
      for (int i = 0; i < 8; ++i) {
        // Half of the poses have edges along edges.
        RigidTransform pose = test::poseNearContact(bodies, 0.1 * scale, random);
        if (i % 2 == 1) pose.rotation = glm::dquat(1.0, 0.0, 0.0, 0.0);
        const NearbyPairs nearby = findNearbyPairs({scene, part, pose, 0.2 * scale}, {0.2 * scale, 0.3}, {},
                                                   scratch, pairs, 1U << 20);
        ASSERT_TRUE(nearby.isComplete);
        pairs.resize(nearby.count);
        std::erase_if(pairs, [](const LeafPair& pair) { return !isOfSegments(pair); });
        for (std::size_t k = 0; k + SegmentPairs::kLanes <= pairs.size(); k += 5 * SegmentPairs::kLanes) {
          ASSERT_NO_FATAL_FAILURE(compare(scene, part, centredPose(scene, part, pose),
                                          std::span(pairs).subspan(k).first<SegmentPairs::kLanes>(), counts));
        }
        pairs.resize(1U << 16);
      }
    }
  }
  EXPECT_GT(counts.edges, 1000U);
  EXPECT_GT(counts.withVertex, 1000U);
  EXPECT_GT(counts.undecided, 20U);
}

}  // namespace
}  // namespace nearfit::segment_pairs_test
