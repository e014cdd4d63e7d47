#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/servo/servo_tick.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/part_geometries.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::servo_scene_test {
namespace {

class ServoSceneOfThree : public testing::Test {
 protected:
  ServoSceneOfThree() {
    first_ = scene_.add(test::partOf(geometry_, "First", {glm::dquat(1, 0, 0, 0), {1.0, 0.0, 0.0}}));
    second_ = scene_.add(test::partOf(geometry_, "Second", {glm::dquat(1, 0, 0, 0), {2.0, 0.0, 0.0}}));
    third_ = scene_.add(test::partOf(geometry_, "Third", {glm::dquat(1, 0, 0, 0), {3.0, 0.0, 0.0}}));
  }
  void hide(PartId id) {
    Part part = *scene_.find(id);
    part.isVisible = false;
    scene_.replace(part);
  }

  const PartGeometryPtr geometry_ = test::geometryOf(test::boxMesh({1.0, 1.0, 1.0}), {0.1, 0.2, 0.3});
  Scene scene_;
  PartId first_{}, second_{}, third_{};
};

TEST_F(ServoSceneOfThree, HoldsTheMovingPartAndAllOthersWhereTheyAre) {
  scene_.setMovingPart(second_);
  const auto servo = makeServoScene(scene_);
  EXPECT_EQ(servo->moving.id, second_);
  EXPECT_EQ(servo->moving.geometry, geometry_);
  EXPECT_EQ(servo->moving.worldFromPart.translation.x, 2.0);
  EXPECT_EQ(servo->centreInPart, glm::dvec3(0.1, 0.2, 0.3));
  ASSERT_EQ(servo->bodies.size(), 2U);
  EXPECT_EQ(servo->bodies[0].id, first_);
  EXPECT_EQ(servo->bodies[1].id, third_);
  EXPECT_EQ(servo->bodies[1].worldFromPart.translation.x, 3.0);
}

TEST_F(ServoSceneOfThree, HoldsTheJointsOfTheMovingPartThatAreOn) {
  scene_.setMovingPart(second_);
  EXPECT_TRUE(makeServoScene(scene_)->joints.isEmpty());
  Joint joint;
  joint.part = second_;
  joint.base = third_;
  const JointId kept = scene_.addJoint(joint);
  joint.part = first_;
  scene_.addJoint(joint);
  const auto servo = makeServoScene(scene_);
  EXPECT_EQ(servo->joints.size(), 1U);
  EXPECT_FALSE(servo->areJointsContradictory);
  // The second's origin is a metre off the third's axis.
  EXPECT_NEAR(servo->joints.residual(servo->moving.worldFromPart).distance, 1.0, 1e-12);
  joint = scene_.getJoint(kept);
  joint.isOn = false;
  scene_.replaceJoint(joint);
  EXPECT_TRUE(makeServoScene(scene_)->joints.isEmpty());
}

TEST_F(ServoSceneOfThree, TellsOfJointsThatContradictEachOtherAndHoldsNone) {
  scene_.setMovingPart(second_);
  Joint joint;
  joint.kind = JointKind::ToPoint;
  joint.part = second_;
  scene_.addJoint(joint);
  joint.onBase.point.x = 1.0;
  scene_.addJoint(joint);
  const auto servo = makeServoScene(scene_);
  EXPECT_TRUE(servo->areJointsContradictory);
  EXPECT_TRUE(servo->joints.isEmpty());
}

TEST_F(ServoSceneOfThree, MassAndInertiaAreTheMovingPartsOfItsDensity) {
  // A box of 1 x 2 x 3 m: its inertia about x is m (2^2 + 3^2) / 12, and so on.
  const test::TemporaryFolder folder;
  const auto file = folder.write("box.obj", test::objText(test::boxMesh({1.0, 2.0, 3.0}, {5.0, 0.0, 0.0})));
  Part part = test::partOf(loadPartGeometry(file, 1.0), "Box");
  part.density = 200.0;
  scene_.setMovingPart(scene_.add(part));
  const auto servo = makeServoScene(scene_);
  constexpr double kMass = 1200.0;
  EXPECT_NEAR(servo->mass, kMass, 1e-9);
  // Radii of gyration, smallest first.
  const glm::dvec3 expected = glm::sqrt(glm::dvec3(1.0 + 4.0, 1.0 + 9.0, 4.0 + 9.0) / 12.0);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(servo->metric.gyration[axis], expected[axis], 1e-9);
  EXPECT_NEAR(servo->centreInPart.x, 5.0, 1e-12);
}

TEST_F(ServoSceneOfThree, ASheetHasAMassAndAnInertiaThatCanBeInverted) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("sheet.obj", test::objText(test::squareMesh(1, 1)));
  scene_.setMovingPart(scene_.add(test::partOf(loadPartGeometry(file, 0.01), "Sheet")));
  const auto servo = makeServoScene(scene_);
  EXPECT_GT(servo->mass, 0.0);
  EXPECT_GT(servo->metric.gyration[0], 1e-3 * servo->metric.gyration[2]);
}

TEST_F(ServoSceneOfThree, HiddenPartsAreNotFelt) {
  scene_.setMovingPart(second_);
  hide(first_);
  const auto servo = makeServoScene(scene_);
  ASSERT_EQ(servo->bodies.size(), 1U);
  EXPECT_EQ(servo->bodies[0].id, third_);
}

TEST_F(ServoSceneOfThree, AHiddenPartInHandFeelsNothing) {
  scene_.setMovingPart(second_);
  hide(second_);
  const auto servo = makeServoScene(scene_);
  EXPECT_TRUE(servo->bodies.empty());
  EXPECT_EQ(servo->moving.id, second_);
}

TEST_F(ServoSceneOfThree, HierarchiesThatAreMissingAreBuiltBeforeTheServoHasTheScene) {
  const PartGeometryPtr fresh = test::freshGeometryOf(test::boxMesh({1.0, 1.0, 1.0}));
  scene_.setMovingPart(scene_.add(test::partOf(fresh, "fresh")));
  EXPECT_FALSE(fresh->hierarchy->isReady());
  makeServoScene(scene_);
  EXPECT_TRUE(fresh->hierarchy->isReady());
}

TEST_F(ServoSceneOfThree, NoPartInHandIsRefused) {
  EXPECT_THROW(makeServoScene(scene_), UsageError);
}

}  // namespace
}  // namespace nearfit::servo_scene_test
