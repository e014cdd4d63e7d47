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

/// A part of a glTF moved with its document, but the axis in the world that it is kept on stayed.
TEST_F(SessionJoints, APartOfAGltfIsStillOnItsJointsInAnotherUnit) {
  const auto inUnit = [](const char* file, double metresPerUnit) {
    PartGeometry geometry = *test::freshGeometryOf(test::boxMesh(glm::dvec3(metresPerUnit)));
    geometry.file = file;
    geometry.metresPerUnit = metresPerUnit;
    return std::make_shared<const PartGeometry>(geometry);
  };
  const RigidTransform turned{glm::angleAxis(0.5, glm::dvec3(0, 0, 1)), {200.0, -30.0, 4.0}};
  const glm::dvec3 inPart(0.5, 0.25, 0.0), inPlate(0.1, 0.0, 0.3);
  // Both parts where the joints to each other and to the world keep them.
  const PartId bolt = session_.addPart(inUnit("/cad/a.glb", 1.0), "Bolt", turned);
  const PartId plate = session_.addPart(inUnit("/cad/a.glb", 1.0), "Plate",
                                        {{1, 0, 0, 0}, turned.applyToPoint(inPart) - inPlate});
  const PartId mesh = session_.addPart(inUnit("/cad/a.stl", 1.0), "Mesh", turned);
  Joint kept = joint(JointKind::ToPoint);
  kept.part = bolt;
  kept.onPart.point = inPart;
  kept.base = std::nullopt;
  kept.onBase.point = turned.applyToPoint(inPart);
  const JointId toWorld = session_.addJoint(kept, turned);
  kept.base = plate;
  kept.onBase.point = inPlate;
  const JointId toPlate = session_.addJoint(kept, turned);
  kept.part = mesh;
  kept.base = std::nullopt;
  kept.onBase.point = {1.0, 2.0, 3.0};
  const JointId ofMesh = session_.addJoint(kept, turned);
  const auto gap = [&](JointId id) {
    const Joint& of = session_.scene().getJoint(id);
    const auto poseOf = [&](PartId part) { return session_.scene().get(part).worldFromPart; };
    const RigidTransform worldFromBase = of.base ? poseOf(*of.base) : RigidTransform{};
    return glm::distance(poseOf(of.part).applyToPoint(of.onPart.point),
                         worldFromBase.applyToPoint(of.onBase.point));
  };
  ASSERT_LT(gap(toWorld), 1e-12);
  ASSERT_LT(gap(toPlate), 1e-12);
  session_.rescaleParts({{bolt, inUnit("/cad/a.glb", 1e-3)},
                         {plate, inUnit("/cad/a.glb", 1e-3)},
                         {mesh, inUnit("/cad/a.stl", 1e-3)}});
  EXPECT_LT(gap(toWorld), 1e-14);
  EXPECT_LT(gap(toPlate), 1e-14);
  EXPECT_EQ(session_.scene().getJoint(ofMesh).onBase.point, glm::dvec3(1.0, 2.0, 3.0))
      << "a mesh keeps its pose";
  session_.undo();
  EXPECT_LT(gap(toWorld), 1e-12);
}

}  // namespace
}  // namespace nearfit::session_joints_test
