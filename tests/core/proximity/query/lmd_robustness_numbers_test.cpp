#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/proximity/query/lmd_query.h"
#include "core/proximity/tracking/candidate_list.h"
#include "tests/exact/exact_comparison.h"
#include "tests/exact/target_pose.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/trial_share.h"

/// Coordinates, sizes, distances and arguments at the limits of double precision.
namespace nearfit::lmd_robustness_numbers_test {
namespace {

using test::BodyPair;
using test::ExactComparison;

constexpr std::size_t share(std::size_t poses) {
  return std::max<std::size_t>(poses / test::kTrialShare, 4);
}

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

TEST(LmdRobustness, MeshesAMillionDiagonalsFromTheirOriginsHaveTheExactSet) {
  const TriangleMesh star = test::starMesh(1, 0.5, 1, 0.3), box = test::boxMesh({0.5, 0.4, 0.3});
  const RigidTransform away = at({1e6, -2e6, 1.5e6}), back = at({-3e6, 1e5, 2e6});
  for (const bool isSceneFar : {false, true}) {
    const BodyPair pair{fmt::format("far {}", isSceneFar),
                        isSceneFar ? test::transformed(star, 1.0, away) : star,
                        test::transformed(box, 1.0, back)};
    ExactComparison comparison(pair);
    comparison.checkPoses(share(60), 0.2, 71);
    EXPECT_GT(comparison.tally().minima, 20U / test::kTrialShare);
  }
}

TEST(LmdRobustness, PosesAMillionDiagonalsFromTheOriginHaveTheExactSet) {
  // The scene's own frame is there, as that of an aircraft's part is.
  const RigidTransform away = at({-4e6, 3e6, 1e6});
  const BodyPair pair{"far pose", test::transformed(test::starMesh(2, 0.5, 1, 0.3), 1.0, away),
                      test::starMesh(3, 0.3, 1, 0.3)};
  ExactComparison comparison(pair);
  comparison.checkPoses(share(60), 0.2, 72);
  EXPECT_GT(comparison.tally().minima, 20U / test::kTrialShare);
}

TEST(LmdRobustness, MeshesFromAMicronToAThousandKilometresHaveTheExactSet) {
  for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
    const BodyPair pair{fmt::format("scale {}", scale),
                        test::transformed(test::starMesh(4, 0.5, 1, 0.3), scale),
                        test::transformed(test::boxMesh({0.3, 0.4, 0.5}), scale)};
    ExactComparison comparison(pair);
    comparison.checkPoses(share(30), 0.2, 73);
    EXPECT_GT(comparison.tally().minima, 10U / test::kTrialShare);
  }
}

TEST(LmdRobustness, ScaledByPowersOfTwoTheSetIsScaledAndNothingElse) {
  // Powers of two round nothing in double precision: the very same numbers.
  const TriangleMesh star = test::starMesh(5, 0.5, 1, 0.3), other = test::starMesh(6, 0.4, 1, 0.3);
  std::mt19937_64 random(74);
  const BodyPair pair{"scaled", star, other};
  std::size_t compared = 0;
  for (std::size_t i = 0; i < share(40); ++i) {
    const RigidTransform pose = test::poseNearContact(pair, 0.2, random);
    const std::vector<Lmd> expected = test::allLmds(NormalConeTree(star), NormalConeTree(other), pose, 0.2);
    for (const double scale : {0x1p-20, 0x1p20}) {
      const NormalConeTree a(test::transformed(star, scale)), b(test::transformed(other, scale));
      const std::vector<Lmd> found =
          test::allLmds(a, b, {pose.rotation, scale * pose.translation}, scale * 0.2);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t k = 0; k < found.size(); ++k) {
        EXPECT_EQ(found[k].distance, scale * expected[k].distance);
        EXPECT_EQ(found[k].scenePoint, scale * expected[k].scenePoint);
      }
      compared += found.size();
    }
  }
  EXPECT_GT(compared, 0U);
}

TEST(LmdRobustness, QuaternionsOffUnitByAMillionthHaveTheExactSetOfTheirRotation) {
  const BodyPair pair{"off unit", test::starMesh(7, 0.5, 1, 0.3), test::boxMesh({0.3, 0.4, 0.5})};
  ExactComparison comparison(pair);
  std::mt19937_64 random(75);
  for (std::size_t i = 0; i < share(60); ++i) {
    RigidTransform pose = test::targetPose(pair, 0.2, random);
    pose.rotation = pose.normalized().rotation * (i % 2 == 0 ? 1.000001 : 0.999999);
    comparison.checkPose(pose, 0.2);
  }
  EXPECT_GT(comparison.tally().minima, 20U / test::kTrialShare);
}

TEST(LmdRobustness, BodiesThatNearlyTouchHaveTheExactSet) {
  const BodyPair pair{"nearly touching", test::starMesh(8, 0.5, 1, 0.3), test::starMesh(9, 0.3, 1, 0.3)};
  ExactComparison comparison(pair);
  for (const double gap : {1e-6, 1e-9, 1e-11, 1e-12}) {
    std::mt19937_64 random(76);
    for (std::size_t i = 0; i < share(60); ++i)
      comparison.checkPose(test::targetPose(pair, gap * comparison.size(), random), 0.05);
  }
  EXPECT_GT(comparison.tally().minima, 50U / test::kTrialShare);
}

TEST(LmdRobustness, ATinyPartAgainstAHugeOneHasTheExactSet) {
  const TriangleMesh tiny = test::transformed(test::starMesh(10, 0.5, 1, 0.3), 1e-6);
  const TriangleMesh huge = test::starMesh(11, 0.5, 1, 0.3);
  for (const bool isSceneTiny : {false, true}) {
    const BodyPair pair{"tiny and huge", isSceneTiny ? tiny : huge, isSceneTiny ? huge : tiny};
    ExactComparison comparison(pair);
    comparison.checkPoses(share(40), 1e-6, 77);
    comparison.checkPoses(share(12), 0.1, 78);
    EXPECT_GT(comparison.tally().minima, 10U / test::kTrialShare);
  }
}

TEST(LmdRobustness, ACutoffBeyondEverythingIsTheSameAsOneThatReachesEverything) {
  const BodyPair pair{"huge cutoff", test::starMesh(12, 0.5, 1, 0.3), test::boxMesh({0.3, 0.4, 0.5})};
  const NormalConeTree scene(pair.scene), part(pair.part);
  std::mt19937_64 random(79);
  for (std::size_t i = 0; i < share(10); ++i) {
    const RigidTransform pose = test::targetPose(pair, 0.2, random);
    LmdScratch scratch;
    std::vector<Lmd> out(4096);
    const LmdResult expected = findLmds(scene, part, pose, 10.0, scratch, out);
    EXPECT_GT(expected.count, 0U);
    for (const double cutoff : {1e12, 1e20, 1e38, 1e300, std::numeric_limits<double>::max()}) {
      const LmdResult result = findLmds(scene, part, pose, cutoff, scratch, out);
      ASSERT_EQ(result.count, expected.count) << cutoff;
      EXPECT_EQ(result.leafPairs, expected.leafPairs);  // Lanes without a child are out of any reach.
      CandidateList list;
      list.build({scene, part, pose, cutoff}, {{}, {0.01, 0.01}}, scratch, {1U << 17, 1U << 24});
      const std::optional<LmdResult> listed = list.query(pose, cutoff, scratch, out);
      ASSERT_TRUE(listed);
      EXPECT_EQ(listed->count, expected.count) << cutoff;
    }
  }
}

// A fuzzer's: regions that touch are said to be 2.2e-308 m apart, which was beyond cutoffs below that.
TEST(LmdRobustness, NothingIsBeyondTheSmallestOfCutoffs) {
  constexpr double kNormal = std::numeric_limits<double>::min();
  constexpr double kMin = std::numeric_limits<double>::denorm_min();
  const TriangleMesh square = test::transformed(test::squareMesh(1.0, 1), std::ldexp(1.0, -20));
  const NormalConeTree tree(square);
  LmdScratch scratch(256);
  std::vector<Lmd> out(64);
  std::size_t found = 0;
  for (const double cutoff : {kMin, 0.5 * kNormal, kNormal, 1e-300, 1e-150}) {
    for (const double height : {0.0, kMin, kNormal}) {
      const LmdResult result = findLmds(tree, tree, at({0.0, 0.0, height}), cutoff, scratch, out);
      for (std::size_t i = 0; i < result.count; ++i)
        EXPECT_TRUE(out[i].distance > 0.0 && out[i].distance <= cutoff) << out[i].distance << ", " << cutoff;
      found += result.count;
    }
  }
  EXPECT_GT(found, 0U);
}

TEST(LmdRobustness, ArgumentsThatAreNoNumbersGiveNothing) {
  const NormalConeTree box(test::boxMesh({1, 1, 1}));
  LmdScratch scratch;
  std::vector<Lmd> out(16);
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const double tiny = std::numeric_limits<double>::denorm_min(), large = std::numeric_limits<double>::max();
  for (const double bad : {nan, inf, -inf}) {
    for (int k = 0; k < 3; ++k) {
      glm::dvec3 t(1.5, 0, 0);
      t[k] = bad;
      EXPECT_EQ(findLmds(box, box, at(t), 1.0, scratch, out).count, 0U);
    }
    EXPECT_EQ(findLmds(box, box, {{bad, 0, 0, 0}, {1.5, 0, 0}}, 1.0, scratch, out).count, 0U);
    EXPECT_EQ(findLmds(box, box, {{1, 0, bad, 0}, {1.5, 0, 0}}, 1.0, scratch, out).count, 0U);
    EXPECT_EQ(findLmds(box, box, at({1.5, 0, 0}), bad, scratch, out).count, 0U);
  }
  // Numbers, but of no use: nothing is within reach.
  for (const double t : {1e30, 1e200, large}) {
    EXPECT_EQ(findLmds(box, box, at({t, 0, 0}), 1.0, scratch, out).count, 0U) << t;
    EXPECT_EQ(findLmds(box, box, at({t, -t, t}), 1.0, scratch, out).count, 0U) << t;
  }
  EXPECT_EQ(findLmds(box, box, at({1.5, 0, 0}), tiny, scratch, out).count, 0U);
  // No rotation at all counts as none.
  EXPECT_EQ(findLmds(box, box, {{0, 0, 0, 0}, {1.5, 0, 0}}, 1.0, scratch, out).count, 1U);
  std::vector<Lmd> none;
  EXPECT_EQ(findLmds(box, box, at({1.5, 0, 0}), 1.0, scratch, none).status, QueryStatus::Truncated);
}

}  // namespace
}  // namespace nearfit::lmd_robustness_numbers_test
