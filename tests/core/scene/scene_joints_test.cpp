#include <limits>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/scene.h"

namespace nearfit::scene_joints_test {
namespace {

Part named(const char* name) {
  Part part;
  part.name = name;
  return part;
}

class SceneJoints : public testing::Test {
 protected:
  Joint onAxis(PartId part, std::optional<PartId> base = std::nullopt) const {
    Joint joint;
    joint.part = part;
    joint.base = base;
    joint.onPart = {{0.1, 0.2, 0.3}, {0.0, 1.0, 0.0}};
    return joint;
  }
  void setLocked(PartId id, bool isLocked) {
    Part part = scene_.get(id);
    part.isLocked = isLocked;
    scene_.replace(part);
  }

  Scene scene_;
  const PartId peg_ = scene_.add(named("Peg")), hole_ = scene_.add(named("Hole")),
               plate_ = scene_.add(named("Plate"));
};

TEST_F(SceneJoints, AJointIsFoundByItsIdAndIdsAreNeverReused) {
  const JointId first = scene_.addJoint(onAxis(peg_, hole_)), second = scene_.addJoint(onAxis(peg_));
  ASSERT_EQ(scene_.joints().size(), 2U);
  EXPECT_EQ(scene_.findJoint(first)->base, hole_);
  EXPECT_EQ(scene_.findJoint(first)->onPart.point, glm::dvec3(0.1, 0.2, 0.3));
  EXPECT_FALSE(scene_.findJoint(second)->base);
  scene_.removeJoint(second);
  EXPECT_EQ(scene_.findJoint(second), nullptr);
  EXPECT_GT(scene_.addJoint(onAxis(peg_)), second);
}

TEST_F(SceneJoints, IdsOfAnotherSceneCanBeRetired) {
  Scene other = scene_;
  const JointId taken = other.addJoint(onAxis(peg_));
  scene_.retireIdsOf(other);
  EXPECT_GT(scene_.addJoint(onAxis(peg_)), taken);
}

TEST_F(SceneJoints, WhatCannotBeKeptIsRefusedAndChangesNothing) {
  Joint joint = onAxis(peg_, hole_);
  joint.part = PartId{99};
  EXPECT_THROW(scene_.addJoint(joint), UsageError);
  EXPECT_THROW(scene_.addJoint(onAxis(peg_, PartId{99})), UsageError);
  EXPECT_THROW(scene_.addJoint(onAxis(peg_, peg_)), UsageError);
  for (const double bad : {2e9, std::numeric_limits<double>::quiet_NaN()}) {
    joint = onAxis(peg_);
    joint.onBase.point.y = bad;
    EXPECT_THROW(scene_.addJoint(joint), UsageError) << bad;
  }
  for (const double bad : {0.0, 0.9, 2.0, std::numeric_limits<double>::infinity()}) {
    joint = onAxis(peg_);
    joint.onPart.direction = {0.0, bad, 0.0};
    EXPECT_THROW(scene_.addJoint(joint), UsageError) << bad;
  }
  EXPECT_TRUE(scene_.joints().empty());
  EXPECT_THROW(scene_.removeJoint(JointId{1}), UsageError);
  EXPECT_THROW(scene_.getJoint(JointId{1}), UsageError);
}

TEST_F(SceneJoints, DirectionsAreNormalisedAndThoseOfAPointAreNotUsed) {
  Joint joint = onAxis(peg_);
  joint.onPart.direction = {0.0, 1.0005, 0.0};
  EXPECT_EQ(scene_.getJoint(scene_.addJoint(joint)).onPart.direction, glm::dvec3(0.0, 1.0, 0.0));
  joint.kind = JointKind::ToPoint;
  joint.onPart.direction = joint.onBase.direction = glm::dvec3(0.0);
  EXPECT_EQ(scene_.getJoint(scene_.addJoint(joint)).onPart.direction, JointFeature().direction);
}

TEST_F(SceneJoints, APartHasThreeJointsAtMostAndASceneAThousand) {
  for (std::size_t i = 0; i < kMaxJointsPerPart; ++i)
    scene_.addJoint(onAxis(peg_));
  EXPECT_THROW(scene_.addJoint(onAxis(peg_)), UsageError);
  Joint moved = scene_.getJoint(scene_.addJoint(onAxis(hole_)));
  moved.part = peg_;
  EXPECT_THROW(scene_.replaceJoint(moved), UsageError) << "nor by way of another part";
  Joint changed = scene_.joints().front();
  changed.isOn = false;
  scene_.replaceJoint(changed);
  EXPECT_FALSE(scene_.joints().front().isOn);

  while (scene_.joints().size() < kMaxJoints) {
    const PartId part = scene_.add(named("Pin"));
    for (std::size_t i = 0; i < kMaxJointsPerPart && scene_.joints().size() < kMaxJoints; ++i)
      scene_.addJoint(onAxis(part));
  }
  EXPECT_THROW(scene_.addJoint(onAxis(plate_)), UsageError);
}

TEST_F(SceneJoints, ALockedPartKeepsItsJointsAsTheyAre) {
  const JointId id = scene_.addJoint(onAxis(peg_, hole_));
  setLocked(peg_, true);
  EXPECT_THROW(scene_.addJoint(onAxis(peg_)), UsageError);
  EXPECT_THROW(scene_.removeJoint(id), UsageError);
  EXPECT_THROW(scene_.replaceJoint(scene_.getJoint(id)), UsageError);
  Joint moved = scene_.getJoint(id);
  moved.part = plate_;
  EXPECT_THROW(scene_.replaceJoint(moved), UsageError) << "nor can it be given to another part";
  setLocked(peg_, false);
  setLocked(hole_, true);
  EXPECT_NO_THROW(scene_.addJoint(onAxis(peg_, hole_))) << "a base may be locked";
}

TEST_F(SceneJoints, GoWithThePartsThatTheyAreBetween) {
  scene_.addJoint(onAxis(peg_, hole_));
  scene_.addJoint(onAxis(hole_, plate_));
  const JointId left = scene_.addJoint(onAxis(peg_, plate_));
  setLocked(peg_, true);
  scene_.remove(hole_);
  ASSERT_EQ(scene_.joints().size(), 1U);
  EXPECT_EQ(scene_.joints().front().id, left);
}

TEST_F(SceneJoints, PointsScaleWithTheMeshThatTheyAreOn) {
  Joint joint = onAxis(peg_, hole_);
  joint.onBase.point = {1.0, 0.0, 0.0};
  const JointId id = scene_.addJoint(joint);
  scene_.scaleJointsOn(peg_, 10.0);
  EXPECT_EQ(scene_.getJoint(id).onPart.point, glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_EQ(scene_.getJoint(id).onBase.point, glm::dvec3(1.0, 0.0, 0.0));
  scene_.scaleJointsOn(hole_, 0.5);
  EXPECT_EQ(scene_.getJoint(id).onBase.point, glm::dvec3(0.5, 0.0, 0.0));
  EXPECT_THROW(scene_.scaleJointsOn(peg_, 1e9), UsageError);
  EXPECT_EQ(scene_.getJoint(id).onPart.point, glm::dvec3(1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace nearfit::scene_joints_test
