#include "tests/exact/exact_judge.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/proximity/query/lmd_query.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"

/// That the judge sees what it is there for: sets that are right are spoilt, one thing at a time.
namespace nearfit::test::exact_judge_test {
namespace {

using ::testing::HasSubstr;

/// A spike whose point is 0.25 over the top of a cube of side 1: over its rim where x = 0.5.
class ExactJudgeOfASpike : public ::testing::Test {
 protected:
  static RigidTransform at(double x) { return {{0, 1, 0, 0}, {x, 0.1, 1.25}}; }
  std::vector<Lmd> foundAt(double x, double cutoff = kCutoff) const {
    return allLmds(NormalConeTree(pair_.scene), NormalConeTree(pair_.part), at(x), cutoff);
  }
  std::vector<std::string> faults(const std::vector<Lmd>& found, double x, double cutoff = kCutoff) const {
    const ExactJudge judge(pair_);
    ExactTally tally;
    return judge.faults(found, judge.minimaAt(at(x), cutoff), cutoff, tally);
  }

  static constexpr double kCutoff = 0.3;
  BodyPair pair_{"spike", boxMesh({1, 1, 1}), coneMesh(0.125, 0.5, 8)};
};

TEST_F(ExactJudgeOfASpike, AcceptsWhatTheEngineFinds) {
  for (const double x : {0.2, 0.5, 0.5 - 1e-13, 0.5 + 1e-13, 0.55})
    EXPECT_TRUE(faults(foundAt(x), x).empty()) << x;
}

TEST_F(ExactJudgeOfASpike, SeesWhatIsMissing) {
  for (const double x : {0.2, 0.5, 0.55}) {
    const std::vector<std::string> told = faults({}, x);
    ASSERT_FALSE(told.empty()) << x;
    EXPECT_THAT(told[0], HasSubstr("missing"));
  }
}

TEST_F(ExactJudgeOfASpike, SeesWhatIsMadeUpOrMoved) {
  std::vector<Lmd> found = foundAt(0.2);
  found[0].scenePoint.x += 1e-9;
  found[0].partPoint.x += 1e-9;
  const std::vector<std::string> told = faults(found, 0.2);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_THAT(told[0], HasSubstr("missing"));
  EXPECT_THAT(told[1], HasSubstr("spurious"));
}

TEST_F(ExactJudgeOfASpike, SeesMarginalOnesThatDoNotSaySo) {
  // All numbers are exact here: the minimum is at 0.25, just beyond the cutoff.
  const double cutoff = std::nextafter(0.25, 0.0);
  std::vector<Lmd> found = foundAt(0.2, cutoff);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(faults(found, 0.2, cutoff).empty());
  found[0].isMarginal = false;
  const std::vector<std::string> told = faults(found, 0.2, cutoff);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_THAT(told[0], HasSubstr("not said to be marginal"));
}

TEST_F(ExactJudgeOfASpike, SeesSureOnesThatSayTheyAreMarginal) {
  std::vector<Lmd> found = foundAt(0.2);
  found[0].isMarginal = true;
  const std::vector<std::string> told = faults(found, 0.2);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_THAT(told[0], HasSubstr("without need"));
}

TEST_F(ExactJudgeOfASpike, SeesOneThatIsThereTwice) {
  std::vector<Lmd> found = foundAt(0.2);
  found.push_back(found[0]);
  EXPECT_FALSE(faults(found, 0.2).empty());
}

TEST(ExactJudge, LeavesOpenWhichSideOfAnApexWhoseFacesCrossIsOut) {
  // One lobe says that the way to the cube 0.25 above leads out, the other that it leads in.
  const RigidTransform pose{{1, 0, 0, 0}, {0.1, 0.2, -0.75}};
  constexpr double kCutoff = 0.3;
  for (const TriangleMesh& crossed : {crossedApexMesh(), turned(crossedApexMesh())}) {
    const BodyPair pair{"crossed apex", boxMesh({1, 1, 1}), crossed};
    const ExactJudge judge(pair);
    const std::vector<ExactMinimum> exact = judge.minimaAt(pose, kCutoff);
    ASSERT_EQ(exact.size(), 1U);
    EXPECT_EQ(exact[0].distance, 0.25);
    EXPECT_FALSE(exact[0].isPromised);
    ExactTally tally;
    const auto found = allLmds(NormalConeTree(pair.scene), NormalConeTree(crossed), pose, kCutoff);
    EXPECT_TRUE(judge.faults(found, exact, kCutoff, tally).empty());
  }
}

}  // namespace
}  // namespace nearfit::test::exact_judge_test
