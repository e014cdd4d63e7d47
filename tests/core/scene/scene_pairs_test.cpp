#include <limits>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/scene.h"

namespace nearfit::scene_pairs_test {
namespace {

Part named(const char* name) {
  Part part;
  part.name = name;
  return part;
}

class ScenePairs : public testing::Test {
 protected:
  void rename(PartId id, const char* name) {
    Part part = scene_.get(id);
    part.name = name;
    scene_.replace(part);
  }
  static PairRecord record(PartId part, PartId other, PairVerdict verdict = PairVerdict::Near) {
    return {{part, other}, verdict, 1e-3, {}, FindingState::New, ""};
  }

  Scene scene_;
  const PartId peg_ = scene_.add(named("Peg")), hole_ = scene_.add(named("Hole")),
               plate_ = scene_.add(named("Plate"));
};

TEST_F(ScenePairs, RecordsAreSortedAndFoundByTheirPair) {
  scene_.setPairRecords({record(hole_, plate_), record(peg_, hole_, PairVerdict::Clash)});
  ASSERT_EQ(scene_.pairRecords().size(), 2U);
  EXPECT_EQ(scene_.pairRecords()[0].pair, (PartPair{peg_, hole_}));
  EXPECT_EQ(scene_.findPairRecord({peg_, hole_})->verdict, PairVerdict::Clash);
  EXPECT_EQ(scene_.findPairRecord({peg_, plate_}), nullptr);
}

TEST_F(ScenePairs, ARemovedPartTakesItsRecordsWithItAndACopyOfTheSceneKeepsThem) {
  scene_.setPairRecords({record(peg_, hole_), record(peg_, plate_), record(hole_, plate_)});
  const Scene before = scene_;
  scene_.remove(peg_);
  ASSERT_EQ(scene_.pairRecords().size(), 1U);
  EXPECT_EQ(scene_.pairRecords()[0].pair, (PartPair{hole_, plate_}));
  EXPECT_EQ(before.pairRecords().size(), 3U);
}

TEST_F(ScenePairs, RulesThatNameAPartAloneFollowItsNewName) {
  scene_.setPairRules({{PairRuleKind::LeaveOut, "Peg", "Hole"}, {PairRuleKind::Touching, "P*", "Peg"}});
  rename(peg_, "Pin *");
  EXPECT_EQ(scene_.pairRules()[0].part, "Pin \\*");
  EXPECT_EQ(scene_.pairRules()[0].other, "Hole");
  EXPECT_EQ(scene_.pairRules()[1].part, "P*");
  EXPECT_EQ(scene_.pairRules()[1].other, "Pin \\*");
  rename(peg_, "Bolt");
  EXPECT_EQ(scene_.pairRules()[0].part, "Bolt");
}

TEST_F(ScenePairs, InvalidRecordsAreRefusedAndChangeNothing) {
  scene_.setPairRecords({record(peg_, hole_)});
  PairRecord bad = record(peg_, plate_);
  bad.state = FindingState::Accepted;
  EXPECT_THROW(scene_.setPairRecords({bad}), UsageError) << "no reason";
  bad = record(peg_, plate_);
  bad.distance = std::numeric_limits<double>::infinity();
  EXPECT_THROW(scene_.setPairRecords({bad}), UsageError);
  bad.distance = 0.0;
  bad.depth = -1.0;
  EXPECT_THROW(scene_.setPairRecords({bad}), UsageError);
  bad.depth = 1.0;
  bad.reason = std::string(kMaxReasonBytes + 1, 'x');
  EXPECT_THROW(scene_.setPairRecords({bad}), UsageError);
  EXPECT_THROW(scene_.setPairRecords({record(hole_, peg_)}), UsageError) << "not in order";
  EXPECT_THROW(scene_.setPairRecords({record(peg_, peg_)}), UsageError);
  EXPECT_THROW(scene_.setPairRecords({record(peg_, PartId{99})}), UsageError);
  EXPECT_THROW(scene_.setPairRecords({record(peg_, hole_), record(peg_, hole_)}), UsageError);
  EXPECT_EQ(scene_.pairRecords().size(), 1U);
}

TEST_F(ScenePairs, InvalidRulesAreRefusedAndChangeNothing) {
  scene_.setPairRules({{PairRuleKind::SameGroup}});
  for (const PairRule& bad :
       {PairRule{PairRuleKind::LeaveOut, "", "*"}, PairRule{PairRuleKind::SameGroup, "Peg", "*"},
        PairRule{PairRuleKind::LeaveOut, "*", "*", 0.1}, PairRule{PairRuleKind::PressFit, "*", "*", 0.0},
        PairRule{PairRuleKind::PressFit, "*", "*", -1e-5}, PairRule{PairRuleKind::PressFit, "*", "*", 1.5},
        PairRule{PairRuleKind::PressFit, "*", "*", std::numeric_limits<double>::quiet_NaN()}})
    EXPECT_THROW(scene_.setPairRules({bad}), UsageError) << textOf(bad);
  EXPECT_THROW(scene_.setPairRules(std::vector<PairRule>(kMaxPairRules + 1)), UsageError);
  EXPECT_EQ(scene_.pairRules(), std::vector<PairRule>{{PairRuleKind::SameGroup}});
}

}  // namespace
}  // namespace nearfit::scene_pairs_test
