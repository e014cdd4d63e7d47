#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/proximity/query/lmd_query.h"
#include "core/proximity/tracking/candidate_list.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"

/// What says that it is marginal, and what does not. Positions are by hand: a cube of side 1 about the
/// origin, and a spike whose point stands 0.25 over its top.
namespace nearfit::lmd_marginal_test {
namespace {

constexpr double kGap = 0.25;

struct Spike {
  NormalConeTree cube{test::boxMesh({1, 1, 1})}, spike{test::coneMesh(0.125, 0.5, 8)};

  /// Half a turn about x, whose doubles are exact: the point is at the bottom.
  static RigidTransform at(double x, double y) { return {{0, 1, 0, 0}, {x, y, 1.0 + kGap}}; }
  std::vector<Lmd> lmds(double x, double y, double cutoff = 0.3) const {
    return test::allLmds(cube, spike, at(x, y), cutoff);
  }
};

TEST(LmdMarginal, PointOverAFaceIsNone) {
  const std::vector<Lmd> found = Spike().lmds(0.2, 0.1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].sceneFeature, FeatureKind::Face);
  EXPECT_FALSE(found[0].isMarginal);
}

TEST(LmdMarginal, PointOverTheVeryRimIsOneMinimumThatSaysSo) {
  for (const double y : {0.1, 0.5}) {  // Of an edge, and of a corner.
    const std::vector<Lmd> found = Spike().lmds(0.5, y);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].distance, kGap);
    EXPECT_TRUE(found[0].isMarginal);
  }
}

TEST(LmdMarginal, BesideTheRimItIsTheFacesOrTheEdgesForSure) {
  for (const double off : {1e-13, 1e-9, 1e-3}) {
    const std::vector<Lmd> inside = Spike().lmds(0.5 - off, 0.1), outside = Spike().lmds(0.5 + off, 0.1);
    ASSERT_EQ(inside.size(), 1U) << off;
    ASSERT_EQ(outside.size(), 1U) << off;
    // The resolution lets the edge claim what is within it; the face, whose own it is, has the say.
    EXPECT_EQ(inside[0].sceneFeature, FeatureKind::Face) << off;
    EXPECT_FALSE(inside[0].isMarginal) << off;
    EXPECT_EQ(outside[0].sceneFeature, FeatureKind::Edge) << off;
    EXPECT_FALSE(outside[0].isMarginal) << off;
  }
}

TEST(LmdMarginal, CutoffThatEndsAtTheVeryDistanceDecidesNothing) {
  const Spike bodies;
  const auto found = [&](double cutoff) { return bodies.lmds(0.2, 0.1, cutoff); };
  for (const double cutoff : {std::nextafter(kGap, 0.0), kGap, std::nextafter(kGap, 1.0)}) {
    ASSERT_EQ(found(cutoff).size(), 1U) << cutoff;
    EXPECT_TRUE(found(cutoff)[0].isMarginal) << cutoff;
  }
  ASSERT_EQ(found(kGap + 1e-12).size(), 1U);
  EXPECT_FALSE(found(kGap + 1e-12)[0].isMarginal);
  EXPECT_TRUE(found(kGap - 1e-12).empty());
}

/// Turned by 45 degrees the distance is found a rounding longer than it is. Where the cutoff was as long as
/// the distance, the minimum vanished.
TEST(LmdMarginal, CutoffDoesNotTakeAwayWhatRoundingPutBeyondIt) {
  const Spike bodies;
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    const RigidTransform turn = test::randomRotation(random);
    const RigidTransform pose = turn * Spike::at(0.2, 0.1);
    const NormalConeTree cube(test::transformed(test::boxMesh({1, 1, 1}), 1.0, turn));
    const std::vector<Lmd> found = test::allLmds(cube, bodies.spike, pose, kGap);
    ASSERT_EQ(found.size(), 1U) << i;
    EXPECT_TRUE(found[0].isMarginal);
    EXPECT_NEAR(found[0].distance, kGap, 1e-14);
    EXPECT_LE(found[0].distance, kGap);
  }
}

TEST(LmdMarginal, FlatRegionIsNoneThoughItsFacesAreExactlyParallel) {
  const NormalConeTree cube(test::boxMesh({1, 1, 1})), block(test::boxMesh({0.5, 0.5, 0.5}));
  // In the middle; across the rim; with two sides in one plane.
  for (const double x : {0.0, 0.5, 0.25}) {
    const std::vector<Lmd> found = test::allLmds(cube, block, {{1, 0, 0, 0}, {x, 0.1, 1.0}}, 0.3);
    ASSERT_EQ(found.size(), 1U) << x;
    EXPECT_TRUE(found[0].isRegion);
    EXPECT_FALSE(found[0].isMarginal) << x;
  }
}

TEST(LmdMarginal, RegionOfFacesThatOverlapInALineOnlyIsOne) {
  const NormalConeTree cube(test::boxMesh({1, 1, 1})), block(test::boxMesh({0.5, 0.5, 0.5}));
  const std::vector<Lmd> found = test::allLmds(cube, block, {{1, 0, 0, 0}, {0.75, 0.1, 1.0}}, 0.3);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].isRegion);
  EXPECT_TRUE(found[0].isMarginal);
  // A little apart it is a region of two edges; a little over each other one of faces.
  for (const double off : {-1e-9, 1e-9}) {
    const std::vector<Lmd> sure = test::allLmds(cube, block, {{1, 0, 0, 0}, {0.75 + off, 0.1, 1.0}}, 0.3);
    ASSERT_EQ(sure.size(), 1U);
    EXPECT_EQ(sure[0].extent.dimension, off < 0.0 ? 2 : 1);
    EXPECT_FALSE(sure[0].isMarginal);
  }
}

TEST(LmdMarginal, CrossingEdgesAreOneAtTheirEndsOnly) {
  // Two knives: below an edge along y, to y = 1; above one along x; 0.25 apart at (0, y).
  const NormalConeTree below(test::wedgeMesh(0.5)), above(test::wedgeMesh(0.5));
  const auto found = [&](double y) {
    // Half a turn about the diagonal of x and y: the edge, along y, comes to lie along x, upside down.
    return test::allLmds(below, above, {{0, 1, 1, 0}, {0.25, y, kGap}}, 0.3);
  };
  ASSERT_EQ(found(0.5).size(), 1U);
  EXPECT_FALSE(found(0.5)[0].isMarginal);
  ASSERT_EQ(found(1.0).size(), 1U);
  EXPECT_TRUE(found(1.0)[0].isMarginal);
}

TEST(LmdMarginal, RandomPosesHaveNone) {
  const test::BodyPair pair{"", test::starMesh(1, 0.5, 1, 0.3), test::torusMesh(0.4, 0.1, 9, 6)};
  const NormalConeTree scene(pair.scene), part(pair.part);
  std::mt19937_64 random(7);
  std::size_t count = 0;
  for (int i = 0; i < 200; ++i) {
    for (const Lmd& lmd : test::allLmds(scene, part, test::poseNearContact(pair, 0.2, random), 0.2)) {
      EXPECT_FALSE(lmd.isMarginal);
      ++count;
    }
  }
  EXPECT_GT(count, 100U);
}

TEST(LmdMarginal, ListsSayTheSameAsASearch) {
  const Spike bodies;
  LmdScratch scratch;
  CandidateList list;
  list.build({bodies.cube, bodies.spike, Spike::at(0.48, 0.12), 0.3}, {{}, {0.1, 1e-3}}, scratch);
  for (const double x : {0.4, 0.5, 0.52}) {
    std::vector<Lmd> out(4);
    const auto result = list.query(Spike::at(x, 0.1), 0.3, scratch, out);
    ASSERT_TRUE(result && result->count == 1);
    EXPECT_EQ(out[0].isMarginal, x == 0.5) << x;
    EXPECT_EQ(out[0].isMarginal, bodies.lmds(x, 0.1)[0].isMarginal);
  }
}

}  // namespace
}  // namespace nearfit::lmd_marginal_test
