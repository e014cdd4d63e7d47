#include "core/proximity/query/face_pairs.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/math/rotation_vector.h"
#include "core/proximity/query/contact_query.h"
#include "core/proximity/query/leaf_tests.h"
#include "core/proximity/query/pair_separations.h"
#include "core/proximity/query/query_workspace.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/ringed_pair.h"

namespace nearfit::face_pairs_test {
namespace {

using test::BodyPair;
using Block = std::span<const LeafPair, FacePairs::kLanes>;

constexpr double kReach = 0.1, kTurn = 0.02;

/// Calls visit(scene, part, pose, block, facesArePart, scale) for blocks of pairs at poses near contact; poses are between
/// the centred frames.
template <class Visit>
void visitBlocks(Visit&& visit) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    std::vector<BodyPair> pairs{
        {"stars", test::starMesh(61, 1.0, 2, 0.25), test::starMesh(62, 0.7, 2, 0.25)},
        {"tori", test::torusMesh(1.0, 0.3, 20, 10), test::torusMesh(0.8, 0.25, 16, 8)},
        {"ringed", test::RingedPair{}.tube(), test::RingedPair{}.rod()},
    };
    for (BodyPair& bodies : pairs) {
      bodies.scene = test::transformed(bodies.scene, scale);
      bodies.part = test::transformed(bodies.part, scale);
      SCOPED_TRACE(bodies.name + " at " + std::to_string(scale));
      const NormalConeTree scene(bodies.scene), part(bodies.part);
      std::mt19937_64 random(63);
      LmdScratch scratch;
      for (int i = 0; i < 6; ++i) {
        // A rod that leans on the wall of its tube has many contacts.
        const double turn = 0.1 * i;
        const RigidTransform pose =
            bodies.name == "ringed"
                ? RigidTransform{rotationOf({0.0, 0.0, turn}),
                                 scale * glm::dvec3(0.012 * std::cos(turn), 0.012 * std::sin(turn), 0.01 * i)}
                : test::poseNearContact(bodies, kReach * scale, random);
        std::vector<LeafPair> near(1U << 18);
        const double reach = kReach * scale;
        const NearbyPairs nearby =
            findNearbyPairs({scene, part, pose, reach}, {reach, 0.1}, {}, scratch, near, 1U << 22);
        ASSERT_TRUE(nearby.isComplete);
        near.resize(nearby.count);
        for (const bool facesArePart : {false, true}) {
          std::vector<LeafPair> ofKind = near;
          std::erase_if(ofKind, [&](const LeafPair& pair) {
            return NormalConeTree::leafKind(facesArePart ? pair.part : pair.scene) != FeatureKind::Face;
          });
          for (std::size_t k = 0; k + FacePairs::kLanes <= ofKind.size(); k += 3 * FacePairs::kLanes)
            visit(scene, part, centredPose(scene, part, pose),
                  Block(std::span<const LeafPair>(ofKind).subspan(k).first<FacePairs::kLanes>()),
                  facesArePart, scale);
        }
      }
    }
  }
}

TEST(FacePairs, EachInstructionSetSaysWhatSingleTestsSayToTheLastBit) {
  std::size_t found = 0, none = 0, overAlone = 0;
  visitBlocks([&](const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& pose,
                  Block pairs, bool facesArePart, double scale) {
    const LeafTests tests(scene, part, pose, kReach * scale, kTurn);
    FacePairs block;
    packFacePairs(scene, part, pairs, facesArePart, block);
    for (const SimdLevel level : availableSimdLevels()) {
      FacePairHits hits;
      facePairKernels(level).test(block, facesArePart ? tests.partFromScene() : tests.sceneFromPart(),
                                  tests.edgePairLimits(), hits);
      for (std::size_t lane = 0; lane < FacePairs::kLanes; ++lane) {
        Minimum expected, minimum;
        const bool isFound = tests.test(pairs[lane].scene, pairs[lane].part, expected);
        const bool isOver = (hits.over >> lane & 1U) != 0;
        const LeafTests::OverFace over{vectorIn(hits.vertex, lane), vectorIn(hits.normal, lane),
                                       hits.distance[lane], hits.tilt[lane]};
        ASSERT_EQ(isOver && tests.testOverFace(pairs[lane].scene, pairs[lane].part, over, minimum), isFound);
        ++(isFound ? found : isOver ? overAlone : none);
        if (!isFound) continue;
        EXPECT_EQ(minimum.least, expected.least);
        EXPECT_EQ(minimum.lmd.partPoint, expected.lmd.partPoint);
        EXPECT_EQ(minimum.lmd.scenePoint, expected.lmd.scenePoint);
        EXPECT_EQ(minimum.lmd.direction, expected.lmd.direction);
      }
    }
  });
  EXPECT_GT(found, 200U);
  EXPECT_GT(none, 200U);
  EXPECT_GT(overAlone, 200U);
}

/// In the faces' frame, other than single pairs: to rounding.
TEST(FacePairs, AreApartAsSinglePairsAre) {
  std::size_t compared = 0, along = 0;
  visitBlocks([&](const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& pose,
                  Block pairs, bool facesArePart, double scale) {
    FacePairs block;
    packFacePairs(scene, part, pairs, facesArePart, block);
    const RigidTransform faceFromVertex = facesArePart ? pose.inverse() : pose;
    for (const SimdLevel level : availableSimdLevels()) {
      FaceSeparations found, first;
      facePairKernels(SimdLevel::Portable).separate(block, faceFromVertex, first);
      facePairKernels(level).separate(block, faceFromVertex, found);
      for (std::size_t lane = 0; lane < FacePairs::kLanes; ++lane) {
        const PairDirections expected = directionsOf(scene, part, pairs[lane], pose);
        const Separation separation = separationAlong(scene, part, pairs[lane], pose, expected.apart);
        const glm::dvec3 apart = vectorIn(found.apart, lane);
        EXPECT_EQ(apart, vectorIn(first.apart, lane));
        EXPECT_EQ(found.height[lane], first.height[lane]);
        EXPECT_NEAR(found.distance[lane], expected.distance, 1e-12 * scale);
        // Where the vertex is as far from the face's plane as from the face, either direction serves.
        const glm::dvec3 inScene = facesArePart ? pose.applyToVector(-apart) : apart;
        const double tolerance = 1e-12 * scale / std::max(expected.distance, 1e-9 * scale) + 1e-12;
        EXPECT_NEAR(glm::distance(inScene, expected.apart), 0.0, tolerance);
        EXPECT_NEAR(found.height[lane], separation.height, (tolerance + 1e-12) * 2.0 * scale);
        const glm::dvec3 normal = vectorIn(found.normal, lane);
        EXPECT_NEAR(glm::distance(facesArePart ? pose.applyToVector(-normal) : normal, expected.ofContact),
                    0.0, 1e-12);
        const glm::dvec3 onPart = vectorIn(facesArePart ? block.vertex : found.vertex, lane);
        EXPECT_NEAR(glm::distance(onPart, expected.onPart), 0.0, 1e-12 * scale);
        ++compared;
        along += glm::dot(apart, normal) > 0.999999 ? 1 : 0;
      }
    }
  });
  EXPECT_GT(compared, 2000U);
  EXPECT_GT(along, 100U);
  EXPECT_LT(along, compared / 2);
}

}  // namespace
}  // namespace nearfit::face_pairs_test
