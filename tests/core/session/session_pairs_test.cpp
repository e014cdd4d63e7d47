#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/session/session.h"

namespace nearfit::session_pairs_test {
namespace {

class SessionPairs : public testing::Test {
 protected:
  SessionPairs() {
    session_.setPairRecords({{{peg_, hole_}, PairVerdict::Clash, 0.0, 1e-4, FindingState::New, ""},
                             {{hole_, plate_}, PairVerdict::Near, 1e-3, {}, FindingState::New, ""}});
  }
  const PairRecord& clash() const { return *session_.scene().findPairRecord({peg_, hole_}); }

  Session session_;
  const PartId peg_ = session_.addPart({}, "Peg"), hole_ = session_.addPart({}, "Hole"),
               plate_ = session_.addPart({}, "Plate");
};

TEST_F(SessionPairs, AFindingIsAcceptedWithAReasonAsOneStep) {
  session_.setFindingState({{peg_, hole_}}, FindingState::Accepted, "pressed in");
  EXPECT_EQ(session_.undoText(), "Accept a finding");
  EXPECT_EQ(clash().state, FindingState::Accepted);
  EXPECT_EQ(clash().reason, "pressed in");
  session_.setFindingState({{peg_, hole_}}, FindingState::Accepted, "pressed in");
  session_.undo();
  EXPECT_EQ(clash().state, FindingState::New);
  EXPECT_EQ(session_.undoText(), "Add Plate");
}

TEST_F(SessionPairs, WhatIsRefusedIsNoStep) {
  EXPECT_THROW(session_.setFindingState({{peg_, hole_}}, FindingState::Accepted), UsageError);
  EXPECT_THROW(session_.setFindingState({{peg_, plate_}}, FindingState::Fixed), UsageError);
  EXPECT_THROW(session_.setPairRules({{PairRuleKind::LeaveOut, "", "*"}}), UsageError);
  EXPECT_EQ(session_.undoText(), "Add Plate");
}

/// Undo after a check took back the check, and the part stayed where it was moved.
TEST_F(SessionPairs, ACheckIsNoStepSoThatUndoTakesBackTheMoveBeforeIt) {
  const std::vector<PairRecord> first = session_.scene().pairRecords();
  session_.movePart(peg_, {{1, 0, 0, 0}, {0.0, 0.0, 0.005}});
  const std::size_t steps = session_.history().size();
  session_.setPairRecords({{{peg_, plate_}, PairVerdict::Clash, 0.0, 2e-4, FindingState::New, ""}});
  EXPECT_EQ(session_.history().size(), steps);
  EXPECT_EQ(session_.undoText(), "Move Peg");
  session_.undo();
  EXPECT_EQ(session_.scene().find(peg_)->worldFromPart, RigidTransform{});
  EXPECT_EQ(session_.scene().pairRecords(), first) << "they were found of this place";
  EXPECT_EQ(session_.redoText(), "Move Peg");
  session_.redo();
  ASSERT_EQ(session_.scene().pairRecords().size(), 1U);
  EXPECT_EQ(session_.scene().pairRecords()[0].depth, 2e-4);
}

TEST_F(SessionPairs, ACheckLeavesWhatCanBeRedone) {
  session_.movePart(peg_, {{1, 0, 0, 0}, {0.0, 0.0, 0.005}});
  session_.undo();
  session_.setPairRecords({});
  EXPECT_TRUE(session_.scene().pairRecords().empty());
  EXPECT_EQ(session_.redoText(), "Move Peg");
  session_.redo();
  EXPECT_EQ(session_.scene().find(peg_)->worldFromPart.translation, glm::dvec3(0.0, 0.0, 0.005));
}

TEST_F(SessionPairs, ACheckIsToBeSavedUnlessItFindsTheSame) {
  session_.reset(session_.scene());
  int changes = 0;
  const Subscription told = session_.onChange(SceneEvents::Stage::Panels, [&changes] { ++changes; });
  session_.setPairRecords(session_.scene().pairRecords());
  EXPECT_FALSE(session_.isModified());
  EXPECT_EQ(changes, 0);
  session_.setPairRecords({});
  EXPECT_TRUE(session_.isModified());
  EXPECT_FALSE(session_.canUndo());
  EXPECT_EQ(changes, 1);
}

TEST_F(SessionPairs, UndoingADeletionBringsTheRecordsBack) {
  session_.deletePart(peg_);
  EXPECT_EQ(session_.scene().pairRecords().size(), 1U);
  session_.undo();
  EXPECT_EQ(clash().depth, 1e-4);
}

TEST_F(SessionPairs, RulesAreOneStepAndARenamedPartKeepsItsOwn) {
  session_.setPairRules({{PairRuleKind::Touching, "Peg", "Hole"}});
  session_.setPairRules({{PairRuleKind::Touching, "Peg", "Hole"}});
  session_.renamePart(peg_, "Pin");
  EXPECT_EQ(session_.scene().pairRules()[0].part, "Pin");
  session_.undo();
  EXPECT_EQ(session_.scene().pairRules()[0].part, "Peg");
  session_.undo();
  EXPECT_TRUE(session_.scene().pairRules().empty());
}

}  // namespace
}  // namespace nearfit::session_pairs_test
