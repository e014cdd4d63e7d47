#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/scene.h"
#include "tests/support/refusal_of.h"

namespace nearfit::scene_groups_test {
namespace {

using test::refusalOf;
using ::testing::HasSubstr;

Part named(const std::string& name, std::optional<GroupId> group = {}) {
  Part part;
  part.name = name;
  part.group = group;
  return part;
}

GroupId addGroup(Scene& scene, const std::string& name, std::optional<GroupId> parent = {}) {
  return scene.addGroup({{}, name, parent, false});
}

void lock(Scene& scene, GroupId id, bool isLocked = true) {
  Group group = *scene.findGroup(id);
  group.isLocked = isLocked;
  scene.replaceGroup(group);
}

void moveGroup(Scene& scene, GroupId id, std::optional<GroupId> parent) {
  Group group = *scene.findGroup(id);
  group.parent = parent;
  scene.replaceGroup(group);
}

TEST(SceneGroups, GroupsHoldPartsAndGroups) {
  Scene scene;
  const GroupId frame = addGroup(scene, "Frame"), bolts = addGroup(scene, "Bolts", frame);
  const PartId bolt = scene.add(named("Bolt", bolts));
  EXPECT_EQ(scene.findGroup(bolts)->parent, frame);
  EXPECT_EQ(scene.find(bolt)->group, bolts);
  EXPECT_EQ(scene.groups().size(), 2U);
}

TEST(SceneGroups, TwoGroupsMayHaveOneName) {
  Scene scene;
  addGroup(scene, "Bolts");
  EXPECT_NO_THROW(addGroup(scene, "Bolts"));
}

TEST(SceneGroups, NamesThatAreNoneAndUnknownGroupsAreRefused) {
  Scene scene;
  EXPECT_THROW(addGroup(scene, ""), UsageError);
  EXPECT_THROW(addGroup(scene, "a\nb"), UsageError);
  EXPECT_THROW(addGroup(scene, std::string(kMaxGroupNameBytes + 1, 'a')), UsageError);
  EXPECT_THROW(addGroup(scene, "a", GroupId{7}), UsageError);
  EXPECT_THROW(scene.add(named("Peg", GroupId{7})), UsageError);
  EXPECT_THROW(scene.replaceGroup({GroupId{7}, "a", {}, false}), UsageError);
  EXPECT_THROW(scene.removeGroup(GroupId{7}), UsageError);
  EXPECT_TRUE(scene.groups().empty() && scene.parts().empty());
}

TEST(SceneGroups, GroupDoesNotHoldItselfAtAnyDepth) {
  Scene scene;
  const GroupId a = addGroup(scene, "a"), b = addGroup(scene, "b", a), c = addGroup(scene, "c", b);
  for (const GroupId inner : {a, b, c})
    EXPECT_THAT(refusalOf([&] { moveGroup(scene, a, inner); }), HasSubstr("a group cannot contain itself"));
  EXPECT_EQ(scene.findGroup(a)->parent, std::nullopt);
}

TEST(SceneGroups, DepthIsBoundedForNewGroupsAndThoseThatBringOthersAlong) {
  Scene scene;
  std::optional<GroupId> last;
  for (std::size_t i = 0; i < kMaxGroupDepth; ++i)
    last = addGroup(scene, "g", last);
  EXPECT_THAT(refusalOf([&] { addGroup(scene, "g", last); }), HasSubstr("more than 32 deep"));
  const GroupId outer = addGroup(scene, "outer"), inner = addGroup(scene, "inner", outer);
  const GroupId nextToLast = *scene.findGroup(*last)->parent;
  EXPECT_THAT(refusalOf([&] { moveGroup(scene, outer, nextToLast); }), HasSubstr("more than 32 deep"));
  EXPECT_NO_THROW(moveGroup(scene, inner, nextToLast));
}

TEST(SceneGroups, CountIsBounded) {
  Scene scene;
  for (std::size_t i = 0; i < kMaxGroups; ++i)
    addGroup(scene, "g");
  EXPECT_THAT(refusalOf([&] { addGroup(scene, "g"); }), HasSubstr("10000 groups already"));
}

TEST(SceneGroups, OnlyAnEmptyGroupIsRemovedAndItsIdIsNotGivenAgain) {
  Scene scene;
  const GroupId outer = addGroup(scene, "outer"), inner = addGroup(scene, "inner", outer);
  const PartId peg = scene.add(named("Peg", inner));
  EXPECT_THROW(scene.removeGroup(outer), UsageError);
  EXPECT_THROW(scene.removeGroup(inner), UsageError);
  scene.remove(peg);
  scene.removeGroup(inner);
  scene.removeGroup(outer);
  const GroupId next = addGroup(scene, "next");
  EXPECT_TRUE(next != outer && next != inner);
}

TEST(SceneGroups, LockOfAGroupHoldsToAnyDepth) {
  Scene scene;
  const GroupId outer = addGroup(scene, "outer"), inner = addGroup(scene, "inner", outer);
  const PartId peg = scene.add(named("Peg", inner)), free = scene.add(named("Free"));
  lock(scene, outer);
  const Part& part = *scene.find(peg);
  EXPECT_TRUE(scene.isLocked(part) && !part.isLocked);
  EXPECT_TRUE(scene.isLocked(*scene.findGroup(inner)));
  EXPECT_FALSE(scene.isLocked(*scene.find(free)));
  EXPECT_THAT(refusalOf([&] { scene.requireUnlocked(part); }),
              HasSubstr("part \"Peg\": its group \"outer\" is locked; unlock that first"));
  lock(scene, outer, false);
  EXPECT_FALSE(scene.isLocked(*scene.find(peg)));
}

/// Every way to change a part or group through the scene that a lock keeps.
TEST(SceneGroups, LockedThingsAreChangedByNoWay) {
  Scene scene;
  const GroupId outer = addGroup(scene, "outer"), inner = addGroup(scene, "inner", outer),
                open = addGroup(scene, "open");
  const PartId own = scene.add(named("Own", open)), below = scene.add(named("Below", inner)),
               free = scene.add(named("Free"));
  Part locked = *scene.find(own);
  locked.isLocked = true;
  scene.replace(locked);
  lock(scene, outer);
  const std::vector<std::function<void(Part&)>> changes = {
      [](Part& p) { p.name = "Other"; }, [](Part& p) { p.worldFromPart.translation.x += 1e-300; },
      [](Part& p) { p.worldFromPart.rotation = {0, 1, 0, 0}; }, [](Part& p) { p.density = 1.0; },
      [](Part& p) { p.group.reset(); },
      [&](Part& p) { p.group = p.id == own ? std::optional<GroupId>() : open; },
      // Not even together with the lock.
      [](Part& p) { p.isLocked = false, p.density = 2.0; }};
  for (const PartId id : {own, below}) {
    for (std::size_t i = 0; i < changes.size(); ++i) {
      Part part = *scene.find(id);
      changes[i](part);
      EXPECT_THROW(scene.replace(part), UsageError) << part.name << ", change " << i;
    }
    EXPECT_THROW(scene.remove(id), UsageError);
    EXPECT_THROW(scene.setMovingPart(id), UsageError);
  }
  for (const GroupId id : {outer, inner}) {
    Group group = *scene.findGroup(id);
    group.name = "renamed";
    EXPECT_THROW(scene.replaceGroup(group), UsageError);
    EXPECT_THROW(moveGroup(scene, id, open), UsageError);
    EXPECT_THROW(scene.removeGroup(id), UsageError);
    EXPECT_THROW(addGroup(scene, "new", id), UsageError);
    EXPECT_THROW(moveGroup(scene, open, id), UsageError);
    Part part = *scene.find(free);
    part.group = id;
    EXPECT_THROW(scene.replace(part), UsageError);
    EXPECT_THROW(scene.add(named("New", id)), UsageError);
  }
}

TEST(SceneGroups, LookOfLockedPartsCanBeChanged) {
  Scene scene;
  const GroupId group = addGroup(scene, "group");
  const PartId peg = scene.add(named("Peg", group));
  lock(scene, group);
  Part part = *scene.find(peg);
  part.isVisible = false;
  part.opacity = 0.5;
  part.isLocked = true;
  EXPECT_NO_THROW(scene.replace(part));
}

TEST(SceneGroups, GroupOfTheMovingPartIsNotLocked) {
  Scene scene;
  const GroupId outer = addGroup(scene, "outer"), inner = addGroup(scene, "inner", outer);
  scene.setMovingPart(scene.add(named("Peg", inner)));
  EXPECT_THAT(refusalOf([&] { lock(scene, outer); }), HasSubstr("it contains the moving part \"Peg\""));
  scene.setMovingPart(std::nullopt);
  EXPECT_NO_THROW(lock(scene, outer));
}

TEST(SceneGroups, OpacityOutOfItsLimitsIsRefused) {
  Scene scene;
  Part part = named("Peg");
  for (const double opacity : {0.0, 0.049, 1.001, -1.0, std::nan(""), 1e300}) {
    part.opacity = opacity;
    EXPECT_THROW(scene.add(part), UsageError) << opacity;
  }
  for (const double opacity : {kMinOpacity, 0.3, 1.0}) {
    part.opacity = opacity;
    EXPECT_NO_THROW(scene.add(part));
  }
}

TEST(SceneGroups, IsolationIsTakenBackExactly) {
  Scene scene;
  const PartId a = scene.add(named("a")), b = scene.add(named("b")), c = scene.add(named("c"));
  Part hidden = *scene.find(b);
  hidden.isVisible = false;
  scene.replace(hidden);
  const auto shown = [&] {
    std::string names;
    for (const Scene::PartPtr& part : scene.parts())
      if (part->isVisible) names += part->name;
    return names;
  };
  EXPECT_FALSE(scene.isIsolated());
  scene.isolate({b});
  EXPECT_EQ(shown(), "b");
  EXPECT_TRUE(scene.isIsolated());
  // Others isolated, one hidden by hand, one that came since: what was before stays what it was.
  scene.isolate({a, c});
  EXPECT_EQ(shown(), "ac");
  hidden = *scene.find(a);
  hidden.isVisible = false;
  scene.replace(hidden);
  scene.add(named("d"));
  scene.endIsolation();
  EXPECT_EQ(shown(), "acd");
  EXPECT_FALSE(scene.isIsolated());
  EXPECT_THROW(scene.isolate({}), UsageError);
  EXPECT_THROW(scene.isolate({a, PartId{99}}), UsageError);
  EXPECT_EQ(shown(), "acd");
}

TEST(SceneGroups, GroupsAreAddedTogetherWithParentsThatAreYounger) {
  Scene scene;
  addGroup(scene, "first");
  const auto ids = scene.addGroups({{{}, "inner", {}, false}, {{}, "outer", {}, false}}, {1, std::nullopt});
  ASSERT_EQ(ids.size(), 2U);
  EXPECT_LT(ids[0], ids[1]);
  EXPECT_EQ(scene.findGroup(ids[0])->parent, ids[1]);
  EXPECT_EQ(scene.findGroup(ids[1])->parent, std::nullopt);
  EXPECT_EQ(scene.groups().size(), 3U);

  const auto refused = [&](std::vector<Group> groups,
                           const std::vector<std::optional<std::size_t>>& parents) {
    EXPECT_THROW(scene.addGroups(std::move(groups), parents), UsageError);
    EXPECT_EQ(scene.groups().size(), 3U);
  };
  refused({{{}, "a", {}, false}, {{}, "b", {}, false}}, {1, 0});
  refused({{{}, "", {}, false}}, {std::nullopt});
  refused(std::vector<Group>(kMaxGroups, {{}, "a", {}, false}),
          std::vector<std::optional<std::size_t>>(kMaxGroups));
}

}  // namespace
}  // namespace nearfit::scene_groups_test
