#include "core/scene/scene_tree.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace nearfit::scene_tree_test {
namespace {

/// top { a { b { Pin }, Peg }, Bolt }, Free
class SceneTree : public ::testing::Test {
 protected:
  GroupId addGroup(const char* name, std::optional<GroupId> parent = {}) {
    return scene_.addGroup({{}, name, parent, false});
  }
  PartId addPart(const char* name, std::optional<GroupId> group = {}) {
    Part part;
    part.name = name;
    part.group = group;
    return scene_.add(part);
  }

  Scene scene_;
  GroupId top_ = addGroup("top"), a_ = addGroup("a", top_), b_ = addGroup("b", a_);
  PartId pin_ = addPart("Pin", b_), peg_ = addPart("Peg", a_), bolt_ = addPart("Bolt", top_),
         free_ = addPart("Free");
};

TEST_F(SceneTree, ChildrenAreThoseThatStandDirectlyInAGroup) {
  EXPECT_EQ(childrenOf(scene_, std::nullopt), (SceneNodes{{free_}, {top_}}));
  EXPECT_EQ(childrenOf(scene_, top_), (SceneNodes{{bolt_}, {a_}}));
  EXPECT_EQ(childrenOf(scene_, b_), (SceneNodes{{pin_}, {}}));
}

TEST_F(SceneTree, GroupsAreVisitedFromTheTopDownEachWithAllThatItHolds) {
  // Made later, but moved above what was made before it.
  const GroupId late = addGroup("late");
  Group top = *scene_.findGroup(top_);
  top.parent = late;
  scene_.replaceGroup(top);
  addGroup("last");
  std::string visited;
  visitGroups(scene_, [&](const Group& group, std::size_t depth) {
    visited += group.name + std::to_string(depth) + " ";
  });
  EXPECT_EQ(visited, "late0 top1 a2 b3 last0 ");
}

TEST_F(SceneTree, GroupStandsForAllThatItHolds) {
  EXPECT_EQ(partsOf(scene_, {{free_, pin_}, {a_}}), (std::vector{pin_, peg_, free_}));
  EXPECT_EQ(partsOf(scene_, {{}, {top_}}), (std::vector{pin_, peg_, bolt_}));
  EXPECT_EQ(groupsOf(scene_, {{peg_}, {b_, a_}}), (std::vector{a_, b_}));
}

TEST_F(SceneTree, WhatStandsInAGroupAnywayIsLeftOut) {
  EXPECT_EQ(outermost(scene_, {{pin_, bolt_, bolt_}, {b_, a_}}), (SceneNodes{{bolt_}, {a_}}));
}

TEST_F(SceneTree, CommonGroupHoldsAllOfThem) {
  EXPECT_EQ(commonGroup(scene_, {{pin_}, {}}), b_);
  EXPECT_EQ(commonGroup(scene_, {{pin_, peg_}, {}}), a_);
  EXPECT_EQ(commonGroup(scene_, {{peg_}, {b_}}), a_);
  EXPECT_EQ(commonGroup(scene_, {{bolt_}, {b_}}), top_);
  EXPECT_EQ(commonGroup(scene_, {{pin_, free_}, {}}), std::nullopt);
  EXPECT_EQ(commonGroup(scene_, {{bolt_}, {top_}}), std::nullopt);
  EXPECT_EQ(commonGroup(scene_, {}), std::nullopt);
}

TEST_F(SceneTree, UnknownNodesAreRefused) {
  EXPECT_THROW(partsOf(scene_, {{PartId{99}}, {}}), UsageError);
  EXPECT_THROW(groupsOf(scene_, {{}, {GroupId{99}}}), UsageError);
  EXPECT_THROW(outermost(scene_, {{PartId{99}}, {}}), UsageError);
  EXPECT_THROW(commonGroup(scene_, {{}, {GroupId{99}}}), UsageError);
}

}  // namespace
}  // namespace nearfit::scene_tree_test
