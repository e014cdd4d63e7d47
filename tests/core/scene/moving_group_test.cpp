#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/scene.h"
#include "tests/support/refusal_of.h"

namespace nearfit::moving_group_test {
namespace {

using test::refusalOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Part named(const std::string& name, std::optional<GroupId> group = {}) {
  Part part;
  part.name = name;
  part.group = group;
  return part;
}

/// A gripper of a base and two jaws in a group of their own, and a workpiece beside it.
struct Gripper {
  Gripper() { scene.setMovingGroup(gripper); }
  void putInto(PartId id, std::optional<GroupId> group) {
    Part part = scene.get(id);
    part.group = group;
    scene.replace(part);
  }

  Scene scene;
  PartId work = scene.add(named("Workpiece"));
  GroupId gripper = scene.addGroup({{}, "Gripper", {}, false});
  GroupId jaws = scene.addGroup({{}, "Jaws", gripper, false});
  PartId left = scene.add(named("Left jaw", jaws));
  PartId right = scene.add(named("Right jaw", jaws));
  PartId base = scene.add(named("Base", gripper));
};

TEST(MovingGroup, AllThatAGroupHoldsMovesAndItsFirstPartLeads) {
  const Gripper g;
  EXPECT_EQ(g.scene.movingGroup(), g.gripper);
  EXPECT_EQ(g.scene.movingPart(), g.left);
  EXPECT_THAT(g.scene.movingParts(), ElementsAre(g.left, g.right, g.base));
  EXPECT_TRUE(g.scene.isMoving(g.right));
  EXPECT_FALSE(g.scene.isMoving(g.work));
}

TEST(MovingGroup, APartTakenInHandReplacesTheGroup) {
  Gripper g;
  g.scene.setMovingPart(g.left);
  EXPECT_EQ(g.scene.movingGroup(), std::nullopt);
  EXPECT_THAT(g.scene.movingParts(), ElementsAre(g.left));
  EXPECT_FALSE(g.scene.isMoving(g.right));
  g.scene.setMovingPart(std::nullopt);
  EXPECT_THAT(g.scene.movingParts(), IsEmpty());
}

TEST(MovingGroup, AnotherMemberLeadsOnceTheFirstHasLeft) {
  Gripper g;
  g.putInto(g.left, {});
  EXPECT_EQ(g.scene.movingPart(), g.right);
  EXPECT_FALSE(g.scene.isMoving(g.left));
  g.scene.remove(g.right);
  EXPECT_EQ(g.scene.movingPart(), g.base);
  EXPECT_EQ(g.scene.movingGroup(), g.gripper);
  g.putInto(g.base, {});
  EXPECT_EQ(g.scene.movingPart(), std::nullopt) << "nobody is left";
  EXPECT_EQ(g.scene.movingGroup(), std::nullopt);
}

TEST(MovingGroup, AnInnerGroupThatLeavesTakesTheLeadAway) {
  Gripper g;
  Group jaws = *g.scene.findGroup(g.jaws);
  jaws.parent.reset();
  g.scene.replaceGroup(jaws);
  EXPECT_EQ(g.scene.movingPart(), g.base);
  EXPECT_THAT(g.scene.movingParts(), ElementsAre(g.base));
}

TEST(MovingGroup, APartThatIsPutIntoItMovesToo) {
  Gripper g;
  g.putInto(g.work, g.jaws);
  EXPECT_TRUE(g.scene.isMoving(g.work));
  EXPECT_EQ(g.scene.movingPart(), g.left) << "who leads stays";
}

TEST(MovingGroup, NothingInItCanBeLockedAndNothingLockedCanBeInIt) {
  Gripper g;
  Part right = g.scene.get(g.right);
  right.isLocked = true;
  EXPECT_THAT(refusalOf([&] { g.scene.replace(right); }), HasSubstr("it is in the moving group"));
  for (const GroupId id : {g.gripper, g.jaws}) {
    Group group = *g.scene.findGroup(id);
    group.isLocked = true;
    EXPECT_THAT(refusalOf([&] { g.scene.replaceGroup(group); }), HasSubstr("\"Gripper\" is in hand"));
  }
  Part locked = named("Screw", g.jaws);
  locked.isLocked = true;
  EXPECT_THAT(refusalOf([&] { g.scene.add(locked); }), HasSubstr("cannot be in the moving group"));
  EXPECT_EQ(g.scene.parts().size(), 4U);
}

TEST(MovingGroup, AGroupWithSomethingLockedOrWithoutPartsIsRefused) {
  Gripper g;
  const GroupId empty = g.scene.addGroup({{}, "Empty", {}, false});
  EXPECT_THAT(refusalOf([&] { g.scene.setMovingGroup(empty); }), HasSubstr("it has no parts"));
  EXPECT_THAT(refusalOf([&] { g.scene.setMovingGroup(GroupId{99}); }), HasSubstr("no such group"));
  g.scene.setMovingPart(std::nullopt);
  Part right = g.scene.get(g.right);
  right.isLocked = true;
  g.scene.replace(right);
  EXPECT_THAT(refusalOf([&] { g.scene.setMovingGroup(g.gripper); }),
              HasSubstr("\"Right jaw\": it is locked"));
  right.isLocked = false;
  g.scene.replace(right);
  Group jaws = *g.scene.findGroup(g.jaws);
  jaws.isLocked = true;
  g.scene.replaceGroup(jaws);
  EXPECT_THAT(refusalOf([&] { g.scene.setMovingGroup(g.gripper); }), HasSubstr("group \"Jaws\""));
  EXPECT_EQ(g.scene.movingGroup(), std::nullopt) << "a refusal changes nothing";
}

}  // namespace
}  // namespace nearfit::moving_group_test
