#include <cmath>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/session/session.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::session_joints_test {
namespace {

const RigidTransform kThere{{1, 0, 0, 0}, {1.0, 2.0, 3.0}};

class SessionJoints : public testing::Test {
 protected:
  Joint joint(JointKind kind = JointKind::OnAxis) const {
    Joint joint;
    joint.kind = kind;
    joint.part = peg_;
    joint.base = hole_;
    joint.onPart.point = {0.1, 0.0, 0.0};
    return joint;
  }
  const glm::dvec3& place() const { return session_.scene().get(peg_).worldFromPart.translation; }

  Session session_;
  const PartId peg_ = session_.addPart({}, "Peg"), hole_ = session_.addPart({}, "Hole");
};

TEST_F(SessionJoints, AddingOneMovesThePartInTheSameStep) {
  session_.addJoint(joint(), kThere);
  EXPECT_EQ(session_.undoText(), "Keep Peg on axis");
  EXPECT_EQ(place(), kThere.translation);
  EXPECT_NEAR(session_.history().back().shift, std::sqrt(14.0), 1e-15);
  session_.undo();
  EXPECT_TRUE(session_.scene().joints().empty());
  EXPECT_EQ(place(), glm::dvec3(0.0));
  session_.redo();
  EXPECT_EQ(session_.scene().joints().size(), 1U);
  EXPECT_EQ(place(), kThere.translation);
  session_.addJoint(joint(JointKind::InPlane), kThere);
  EXPECT_EQ(session_.undoText(), "Keep Peg in plane");
  session_.addJoint(joint(JointKind::ToPoint), kThere);
  EXPECT_EQ(session_.undoText(), "Keep Peg to point");
}

TEST_F(SessionJoints, WhatIsRefusedIsNoStep) {
  const std::string before = session_.undoText();
  RigidTransform bad = kThere;
  bad.translation.x = 1e10;
  EXPECT_THROW(session_.addJoint(joint(), bad), UsageError);
  session_.setLocked(peg_, true);
  EXPECT_THROW(session_.addJoint(joint(), kThere), UsageError);
  session_.undo();
  EXPECT_EQ(session_.undoText(), before);
  EXPECT_TRUE(session_.scene().joints().empty());
  EXPECT_EQ(place(), glm::dvec3(0.0));
}

TEST_F(SessionJoints, RemovingSomeIsOneStepThatSaysWhatWasRemoved) {
  const JointId first = session_.addJoint(joint(), kThere), second = session_.addJoint(joint(), kThere);
  session_.removeJoints({second});
  EXPECT_EQ(session_.undoText(), "Remove joint of Peg");
  session_.undo();
  session_.removeJoints({first, second, first});
  EXPECT_EQ(session_.undoText(), "Remove 2 joints of Peg");
  EXPECT_TRUE(session_.scene().joints().empty());
  EXPECT_EQ(place(), kThere.translation) << "the part stays";
  session_.undo();
  EXPECT_EQ(session_.scene().joints().size(), 2U);
  EXPECT_THROW(session_.removeJoints({first, JointId{99}}), UsageError);
  EXPECT_EQ(session_.scene().joints().size(), 2U);
}

TEST_F(SessionJoints, TurningOneOffAndOnAreStepsAndNoChangeIsNone) {
  const JointId id = session_.addJoint(joint(), kThere);
  session_.setJointsOn({id}, true);
  EXPECT_EQ(session_.undoText(), "Keep Peg on axis");
  session_.setJointsOn({id}, false);
  EXPECT_EQ(session_.undoText(), "Turn off joint of Peg");
  EXPECT_FALSE(session_.scene().getJoint(id).isOn);
  session_.setJointsOn({id}, true);
  EXPECT_EQ(session_.undoText(), "Turn on joint of Peg");
  session_.setLocked(peg_, true);
  EXPECT_THROW(session_.setJointsOn({id}, true), UsageError);
}

TEST_F(SessionJoints, IdsStayUniqueAcrossUndo) {
  const JointId first = session_.addJoint(joint(), kThere);
  session_.undo();
  EXPECT_GT(session_.addJoint(joint(), kThere), first);
}

TEST_F(SessionJoints, ACopyHasNoneAndWhatIsDeletedTakesItsOwnAlong) {
  session_.addJoint(joint(), kThere);
  const PartId copy = session_.duplicatePart(peg_);
  for (const Joint& each : session_.scene().joints())
    EXPECT_NE(each.part, copy);
  session_.deletePart(hole_);
  EXPECT_TRUE(session_.scene().joints().empty());
  session_.undo();
  EXPECT_EQ(session_.scene().joints().size(), 1U);
  const GroupId group = session_.group({{peg_, copy}, {}});
  session_.deleteNodes({{}, {group}});
  EXPECT_TRUE(session_.scene().joints().empty());
}

TEST_F(SessionJoints, HidingIsolatingAndMovingTheBaseLeaveThemAsTheyAre) {
  session_.addJoint(joint(), kThere);
  const std::vector<Joint> before = session_.scene().joints();
  session_.isolate({hole_});
  session_.setVisible(hole_, false);
  session_.movePart(hole_, {{1, 0, 0, 0}, {9.0, 0.0, 0.0}});
  EXPECT_EQ(session_.scene().joints(), before);
  EXPECT_EQ(place(), kThere.translation) << "the part does not follow its base";
}

TEST_F(SessionJoints, AnotherUnitScalesTheirPoints) {
  const auto inUnit = [](double metresPerUnit) {
    PartGeometry geometry = *test::freshGeometryOf(test::boxMesh(glm::dvec3(metresPerUnit)));
    geometry.metresPerUnit = metresPerUnit;
    return std::make_shared<const PartGeometry>(geometry);
  };
  const PartId box = session_.addPart(inUnit(1e-3), "Box");
  Joint kept = joint();
  kept.part = box;
  const JointId id = session_.addJoint(kept, kThere);
  kept = joint();
  kept.base = box;
  kept.onBase.point = {0.5, 0.0, 0.0};
  const JointId onBox = session_.addJoint(kept, kThere);
  session_.rescaleParts({{box, inUnit(1e-2)}});
  EXPECT_NEAR(session_.scene().getJoint(id).onPart.point.x, 1.0, 1e-12);
  EXPECT_NEAR(session_.scene().getJoint(onBox).onBase.point.x, 5.0, 1e-12);
  EXPECT_EQ(session_.scene().getJoint(onBox).onPart.point.x, 0.1);
  session_.undo();
  EXPECT_EQ(session_.scene().getJoint(id).onPart.point.x, 0.1);
}

}  // namespace
}  // namespace nearfit::session_joints_test
