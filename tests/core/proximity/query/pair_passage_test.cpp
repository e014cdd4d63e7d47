#include "core/proximity/query/pair_passage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/math/rotation_vector.h"
#include "core/proximity/query/contact_query.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::pair_passage_test {
namespace {

using Corners = std::vector<glm::dvec3>;

/// Corners of a leaf in the frame of its mesh.
Corners cornersOf(const NormalConeTree& tree, std::uint32_t leaf) {
  const std::uint32_t i = NormalConeTree::leafIndex(leaf);
  Corners corners;
  const auto add = [&](std::uint32_t vertex) { corners.push_back(tree.mesh().vertices()[vertex]); };
  if (NormalConeTree::leafKind(leaf) == FeatureKind::Vertex) {
    add(tree.vertices()[i].vertex);
  } else if (NormalConeTree::leafKind(leaf) == FeatureKind::Edge) {
    add(tree.edges()[i].v0);
    add(tree.edges()[i].v1);
  } else {
    for (const std::uint32_t v : tree.faces()[i].corners)
      add(v);
  }
  return corners;
}

/// Distance of two convex hulls of few points by Frank and Wolfe's method with exact line search: it shares
/// nothing with the code under test, and its distance is never too short.
double hullDistance(const Corners& a, const Corners& b) {
  glm::dvec3 at = a[0] - b[0];
  for (int step = 0; step < 4000; ++step) {
    glm::dvec3 best = at;
    double least = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& p : a) {
      for (const glm::dvec3& q : b) {
        const double along = glm::dot(at, p - q);
        if (along < least) {
          least = along;
          best = p - q;
        }
      }
    }
    const glm::dvec3 way = best - at;
    const double gain = -glm::dot(at, way), squared = glm::dot(way, way);
    if (!(gain > 1e-15) || !(squared > 0.0)) break;
    at += std::min(1.0, gain / squared) * way;
  }
  return glm::length(at);
}

struct Bodies {
  NormalConeTree scene, part;
  glm::dvec3 centre;  ///< That of the part that moves straight.
  double radius;
};

Bodies bodiesOf(const TriangleMesh& scene, const TriangleMesh& part) {
  double radius = 0.0;
  const glm::dvec3 centre = part.bounds().centre();
  for (const glm::dvec3& v : part.vertices())
    radius = std::max(radius, glm::distance(v, centre));
  return {NormalConeTree(scene), NormalConeTree(part), centre, radius};
}

/// Pose at a time of the way from one pose by a shift and a spin of the part about its centre.
RigidTransform poseAt(const Bodies& bodies, const RigidTransform& from, const glm::dvec3& shift,
                      const glm::dvec3& spin, double time) {
  const glm::dquat rotation = glm::normalize(rotationOf(time * spin) * from.rotation);
  const glm::dvec3 centre = from.applyToPoint(bodies.centre) + time * shift;
  return {rotation, centre - rotation * bodies.centre};
}

TEST(PairPassage, NoBoundExceedsTheDistanceAnywhereOnTheWay) {
  const test::BodyPair pair{"stars", test::starMesh(31, 1.0, 2, 0.25), test::starMesh(32, 0.7, 2, 0.25)};
  const Bodies bodies = bodiesOf(pair.scene, pair.part);
  std::mt19937_64 random(19);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  LmdScratch scratch;
  std::vector<LeafPair> pairs(1U << 16);
  std::size_t compared = 0, known = 0;
  for (int i = 0; i < 30; ++i) {
    const RigidTransform from = test::poseNearContact(pair, 0.2, random);
    const double size = 0.3 * std::abs(share(random));
    const glm::dvec3 shift = size * glm::dvec3(share(random), share(random), share(random));
    const glm::dvec3 spin = size * glm::dvec3(share(random), share(random), share(random));
    const double turn = glm::length(spin), travel = glm::length(shift) + turn * bodies.radius;
    const PairPassage passage(
        bodies.scene, bodies.part,
        {from, poseAt(bodies, from, shift, spin, 1.0), travel, bendOf(turn, bodies.radius)}, 1e9);
    const NearbyPairs nearby = findNearbyPairs({bodies.scene, bodies.part, from, 0.4}, {0.4, 0.3}, {0.1, 0.1},
                                               scratch, pairs, 1U << 20);
    for (std::size_t k = 0; k < nearby.count; k += 17) {
      const Corners scene = cornersOf(bodies.scene, pairs[k].scene),
                    part = cornersOf(bodies.part, pairs[k].part);
      const double bound = passage.leastOf(pairs[k]);
      ++compared;
      known += bound > 0.0 ? 1 : 0;
      if (!(bound > 0.0)) continue;
      for (int t = 0; t <= 16; ++t) {
        const RigidTransform pose = poseAt(bodies, from, shift, spin, t / 16.0);
        Corners placed;
        for (const glm::dvec3& p : part)
          placed.push_back(pose.applyToPoint(p));
        ASSERT_LE(bound, hullDistance(scene, placed) + 1e-12) << i << ", pair " << k << " at " << t / 16.0;
      }
    }
  }
  EXPECT_GT(compared, 1000U);
  EXPECT_GT(known, compared / 4);
}

/// A cube that slides along a floor goes two hundred times as far as it is away, and is known to stay away.
TEST(PairPassage, APartThatSlidesAlongAWallKeepsItsDistanceHoweverFarItGoes) {
  constexpr double kGap = 1e-3;
  const Bodies bodies =
      bodiesOf(test::boxMesh({4.0, 4.0, 1.0}, {0.0, 0.0, -0.5}), test::boxMesh({0.2, 0.2, 0.2}));
  const RigidTransform from{{1, 0, 0, 0}, {0.0, 0.0, 0.1 + kGap}};
  LmdScratch scratch;
  std::vector<LeafPair> pairs(1U << 12);
  const MotionBudget slack{0.2, 0.0};
  const NearbyPairs nearby = findNearbyPairs({bodies.scene, bodies.part, from, 2.0 * kGap},
                                             {2.0 * kGap, 0.01}, slack, scratch, pairs, 1U << 20);
  ASSERT_TRUE(nearby.isComplete);
  ASSERT_GT(nearby.count, 0U);
  const auto leastOf = [&](const glm::dvec3& shift) {
    const RigidTransform to = poseAt(bodies, from, shift, {}, 1.0);
    return PairPassage(bodies.scene, bodies.part, {from, to, glm::length(shift), 0.0}, 1.0)
        .leastOf(std::span(pairs).first(nearby.count));
  };
  EXPECT_NEAR(leastOf({0.2, 0.0, 0.0}), kGap, 1e-12);
  EXPECT_NEAR(leastOf({0.1, -0.1, -0.6 * kGap}), 0.4 * kGap, 1e-12);
  EXPECT_LT(leastOf({0.1, 0.0, -1.1 * kGap}), 0.0);
}

/// A turn by a right angle would sweep corners through what is beside both ends: nothing is known of it.
TEST(PairPassage, TheBendOfATurnIsTakenOff) {
  const Bodies bodies =
      bodiesOf(test::boxMesh({4.0, 4.0, 1.0}, {0.0, 0.0, -0.5}), test::boxMesh({0.2, 0.2, 0.2}));
  constexpr double kTurn = 1.5;
  const RigidTransform from{{1, 0, 0, 0}, {0.0, 0.0, 0.12}};
  const RigidTransform to = poseAt(bodies, from, {}, {kTurn, 0.0, 0.0}, 1.0);
  LmdScratch scratch;
  std::vector<LeafPair> pairs(1U << 12);
  const NearbyPairs nearby = findNearbyPairs({bodies.scene, bodies.part, from, 0.5}, {0.5, 3.0}, {0.5, 3.0},
                                             scratch, pairs, 1U << 20);
  ASSERT_TRUE(nearby.isComplete);
  const double bend = bendOf(kTurn, bodies.radius);
  const PairPassage passage(bodies.scene, bodies.part, {from, to, kTurn * bodies.radius, bend}, 1.0);
  EXPECT_LT(passage.leastOf(std::span(pairs).first(nearby.count)), 0.0);
}

}  // namespace
}  // namespace nearfit::pair_passage_test
