#include "core/proximity/query/edge_pairs.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/contact_query.h"
#include "core/proximity/query/leaf_tests.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::edge_pairs_test {
namespace {

using test::BodyPair;

constexpr double kTurn = 0.026;

std::vector<BodyPair> bodyPairs(double scale) {
  std::vector<BodyPair> pairs{
      {"stars", test::starMesh(31, 1.0, 3, 0.25), test::starMesh(32, 0.7, 3, 0.25)},
      {"tori", test::torusMesh(1.0, 0.3, 24, 12), test::torusMesh(0.8, 0.25, 20, 10)},
      {"boxes", test::subdivided(test::boxMesh({1.0, 1.0, 1.0}), 2),
       test::subdivided(test::boxMesh({0.6, 0.4, 0.5}), 2)},
      {"peg in bore", test::tubeMesh(0.5, 0.8, 1.0, 32), test::cylinderMesh(0.45, 2.0, 32)},
  };
  for (BodyPair& pair : pairs) {
    pair.scene = test::transformed(pair.scene, scale);
    pair.part = test::transformed(pair.part, scale);
  }
  return pairs;
}

class Candidates {
 public:
  explicit Candidates(const BodyPair& pair) : scene(pair.scene), part(pair.part) {}

  void gather(const RigidTransform& sceneFromPart, double within) {
    pose = sceneFromPart;
    reach = {within, kTurn};
    pairs.resize(1U << 17);
    const NearbyPairs nearby = findNearbyPairs({scene, part, pose, within}, reach, {0.5 * within, 0.02},
                                               scratch, pairs, std::numeric_limits<std::uint64_t>::max());
    ASSERT_TRUE(nearby.isComplete);
    pairs.resize(nearby.count);
  }

  /// Packs the first pairs.
  void pack(std::span<EdgePairs> blocks, SimdLevel level) const {
    for (std::size_t i = 0; i < blocks.size(); ++i)
      packEdgePairs(scene, part, std::span(pairs).subspan(i * EdgePairs::kLanes).first<EdgePairs::kLanes>(),
                    edgePairKernels(level), blocks[i]);
  }

  std::vector<ContactPair> contacts(const PackedEdgePairs& packed) {
    std::vector<ContactPair> out(pairs.size() + 1);
    const ContactResult result = testContacts({scene, part, pose, reach.distance}, reach, pairs, out, packed);
    out.resize(result.count);
    const auto isBefore = [](const ContactPair& a, const ContactPair& b) {
      return std::tie(a.distance, a.point.x, a.point.y, a.point.z, a.direction.x) <
             std::tie(b.distance, b.point.x, b.point.y, b.point.z, b.direction.x);
    };
    std::sort(out.begin(), out.end(), isBefore);
    return out;
  }

  const NormalConeTree scene, part;
  LmdScratch scratch;
  RigidTransform pose;
  ContactReach reach;
  std::vector<LeafPair> pairs;
};

bool isSame(const ContactPair& a, const ContactPair& b) {
  return a.distance == b.distance && a.point == b.point && a.direction == b.direction;
}

/// For poses near contact, some of them with edges along edges, or nearly so.
template <class Visit>
void visitPoses(const BodyPair& pair, double reach, Visit&& visit) {
  std::mt19937_64 random(33);
  for (int i = 0; i < 20; ++i)
    visit(test::poseNearContact(pair, reach, random));
  const double size = reach / 0.1;
  for (const double turn : {0.0, 1e-9, 1e-5, 1e-3}) {
    const glm::dquat rotation = glm::angleAxis(turn, glm::normalize(glm::dvec3(1.0, 0.3, 0.2)));
    // A box whose edge is over another's, and a peg aside in its bore.
    for (const glm::dvec3& place : {glm::dvec3(0.83, 0.0, 0.78), glm::dvec3(0.03, 0.01, 0.02)})
      visit(RigidTransform{rotation, size * place});
  }
}

TEST(EdgePairs, EachInstructionSetSaysWhatSingleTestsSayToTheLastBit) {
  std::size_t compared = 0, undecided = 0;
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (const BodyPair& pair : bodyPairs(scale)) {
      SCOPED_TRACE(pair.name + " at " + std::to_string(scale));
      Candidates candidates(pair);
      visitPoses(pair, 0.1 * scale, [&](const RigidTransform& pose) {
        ASSERT_NO_FATAL_FAILURE(candidates.gather(pose, 0.1 * scale));
        const std::vector<ContactPair> expected = candidates.contacts({});
        std::vector<EdgePairs> blocks(edgePairsToFront(candidates.pairs) / EdgePairs::kLanes);
        for (const SimdLevel level : availableSimdLevels()) {
          candidates.pack(blocks, level);
          const std::vector<ContactPair> found = candidates.contacts({blocks, edgePairKernels(level)});
          ASSERT_EQ(found.size(), expected.size());
          for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_TRUE(isSame(found[i], expected[i])) << i << " of level " << static_cast<int>(level);
        }
        for (const EdgePairs& block : blocks) {
          EdgePairHits hits;
          edgePairKernels(SimdLevel::Portable).test(block, pose, pose.inverse(), {}, hits);
          undecided += hits.undecided != 0 ? 1 : 0;
          EXPECT_EQ(hits.found & hits.undecided, 0U);
        }
        compared += blocks.empty() ? 0 : expected.size();
      });
    }
  }
  EXPECT_GT(compared, 1000U);
  EXPECT_GT(undecided, 5U);
}

TEST(EdgePairs, EdgesComeFirstAndNothingIsLost) {
  const BodyPair pair = bodyPairs(1.0).front();
  Candidates candidates(pair);
  std::mt19937_64 random(34);
  ASSERT_NO_FATAL_FAILURE(candidates.gather(test::poseNearContact(pair, 0.2, random), 0.2));
  const auto isOfEdges = [](const LeafPair& p) {
    return NormalConeTree::leafKind(p.scene) == FeatureKind::Edge &&
           NormalConeTree::leafKind(p.part) == FeatureKind::Edge;
  };
  const auto number = [](const LeafPair& p) { return static_cast<std::uint64_t>(p.scene) << 32 | p.part; };
  const auto numbers = [&] {
    std::vector<std::uint64_t> all(candidates.pairs.size());
    std::transform(candidates.pairs.begin(), candidates.pairs.end(), all.begin(), number);
    std::sort(all.begin(), all.end());
    return all;
  };
  const std::vector<std::uint64_t> before = numbers();
  const auto edges =
      static_cast<std::size_t>(std::count_if(candidates.pairs.begin(), candidates.pairs.end(), isOfEdges));
  ASSERT_GT(edges, 4 * EdgePairs::kLanes);
  ASSERT_LT(edges, candidates.pairs.size());
  EXPECT_EQ(edgePairsToFront(candidates.pairs), edges);
  EXPECT_EQ(numbers(), before);
  EXPECT_TRUE(std::all_of(candidates.pairs.begin(),
                          candidates.pairs.begin() + static_cast<std::ptrdiff_t>(edges), isOfEdges));
  std::vector<EdgePairs> blocks(edges / EdgePairs::kLanes);
  candidates.pack(blocks, SimdLevel::Portable);
  for (std::size_t i = 0; i < blocks.size() * EdgePairs::kLanes; ++i) {
    const std::uint32_t edge = NormalConeTree::leafIndex(candidates.pairs[i].part);
    const LeafTests::Edge expected = LeafTests::edgeOf(candidates.part, edge);
    EXPECT_EQ(blocks[i / EdgePairs::kLanes].part.length[i % EdgePairs::kLanes], expected.length);
  }
}

}  // namespace
}  // namespace nearfit::edge_pairs_test
