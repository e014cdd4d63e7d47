// Commands about several parts and about groups: each one step of undo, whole or refused, stopped by every
// lock.
#include <optional>
#include <random>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/session/session.h"

namespace nearfit::session_groups_test {
namespace {

/// Everything of a scene's parts and groups, as text.
std::string describe(const Scene& scene) {
  std::string text;
  const auto number = [](auto id) { return id ? std::to_string(static_cast<unsigned>(*id)) : "-"; };
  for (const Scene::GroupPtr& g : scene.groups())
    text += g->name + " in " + number(g->parent) + (g->isLocked ? " locked" : "") + "\n";
  for (const Scene::PartPtr& p : scene.parts()) {
    const glm::dvec3& t = p->worldFromPart.translation;
    text += p->name + " in " + number(p->group) + " at " + std::to_string(t.x) + "," + std::to_string(t.y) +
            " turned " + std::to_string(p->worldFromPart.rotation.w) + " red " + std::to_string(p->colour.r) +
            " dense " + std::to_string(p->density) + " opaque " + std::to_string(p->opacity) +
            (p->isVisible ? " visible" : "") + (p->isLocked ? " locked" : "") +
            (p->wasVisible ? *p->wasVisible ? " was" : " wasnt" : "") + "\n";
  }
  return text;
}

class SessionGroups : public ::testing::Test {
 protected:
  SessionGroups() {
    a_ = session_.addPart({}, "a", {{1, 0, 0, 0}, {0.1, 0, 0}});
    b_ = session_.addPart({}, "b", {{0.6, 0, 0.8, 0}, {0, 0.2, 0}});
    c_ = session_.addPart({}, "c", {{0, 0, 0, 1}, {0, 0, -0.3}});
    session_.reset(session_.scene());
  }
  const Part& part(PartId id) { return *session_.scene().find(id); }
  const Group& group(GroupId id) { return *session_.scene().findGroup(id); }
  /// The command is one step, which undo takes back whole and redo makes again; returns its label.
  template <typename Command>
  std::string stepOf(Command command) {
    const std::string before = describe(session_.scene());
    command();
    const std::string after = describe(session_.scene()), label = session_.undoText();
    EXPECT_NE(after, before) << label;
    session_.undo();
    EXPECT_EQ(describe(session_.scene()), before) << label;
    session_.redo();
    EXPECT_EQ(describe(session_.scene()), after) << label;
    return label;
  }

  /// The same for a command that changes only what is in hand.
  template <typename Command>
  std::string stepOfHand(Command command) {
    const auto inHand = [this] {
      return std::pair(session_.scene().movingPart(), session_.scene().movingGroup());
    };
    const auto before = inHand();
    command();
    const auto after = inHand();
    EXPECT_NE(after, before);
    const std::string label = session_.undoText();
    session_.undo();
    EXPECT_EQ(inHand(), before) << label;
    session_.redo();
    EXPECT_EQ(inHand(), after) << label;
    return label;
  }

  Session session_;
  PartId a_{}, b_{}, c_{};
};

TEST_F(SessionGroups, EveryCommandOverSeveralIsOneStepAndSaysWhatItIs) {
  EXPECT_EQ(stepOf([&] { session_.setVisible({a_, b_}, false); }), "Hide 2 parts");
  EXPECT_EQ(stepOf([&] { session_.setVisible({a_, b_, c_}, true); }), "Show 2 parts");
  EXPECT_EQ(stepOf([&] { session_.setColour({a_, b_}, {1, 0, 0}); }), "Recolour 2 parts");
  EXPECT_EQ(stepOf([&] { session_.setOpacity({a_, b_}, 0.5); }), "Change the transparency of 2 parts");
  EXPECT_EQ(stepOf([&] { session_.setDensity({a_, b_}, 7850); }), "Change the density of 2 parts");
  EXPECT_EQ(stepOf([&] { session_.moveParts({a_, b_}, a_, {}); }), "Move 2 parts");
  EXPECT_EQ(stepOf([&] { session_.isolate({c_}); }), "Isolate c");
  EXPECT_EQ(stepOf([&] { session_.endIsolation(); }), "End isolation");
  GroupId group{}, outer{};
  EXPECT_EQ(stepOf([&] { group = session_.group({{a_, b_}, {}}); }), "Group 2 parts");
  group = session_.scene().groups().back()->id;
  EXPECT_EQ(stepOf([&] { session_.renameGroup(group, "Pair"); }), "Rename Group to Pair");
  EXPECT_EQ(stepOf([&] { session_.setLocked({{c_}, {group}}, true); }), "Lock 3 parts");
  EXPECT_EQ(stepOf([&] { session_.setLocked({{c_}, {group}}, false); }), "Unlock 3 parts");
  EXPECT_EQ(stepOf([&] { session_.group({{}, {group}}, "Outer"); }), "Group Pair");
  outer = session_.scene().groups().back()->id;
  EXPECT_EQ(stepOf([&] { session_.regroup({{c_}, {}}, outer); }), "Move c into Outer");
  EXPECT_EQ(stepOf([&] { session_.regroup({{}, {group}}, std::nullopt); }), "Move Pair to the top level");
  EXPECT_EQ(stepOf([&] { session_.duplicate({{c_}, {group}}); }), "Duplicate 3 parts");
  EXPECT_EQ(stepOf([&] { session_.ungroup({outer}); }), "Ungroup Outer");
  EXPECT_EQ(stepOf([&] { session_.deleteNodes({{c_}, {group}}); }), "Delete 3 parts");
}

TEST_F(SessionGroups, CommandsThatChangeNothingAreNoStep) {
  const GroupId group = session_.group({{a_}, {}});
  session_.reset(session_.scene());
  session_.setVisible({a_, b_}, true);
  session_.setColour(a_, part(a_).colour);
  session_.setOpacity({a_, c_}, 1.0);
  session_.setLocked({{a_}, {group}}, false);
  session_.moveParts({a_, b_}, a_, part(a_).worldFromPart);
  session_.regroup({{a_}, {}}, group);
  session_.renameGroup(group, "Group");
  session_.endIsolation();
  session_.deleteNodes({});
  session_.ungroup({});
  session_.duplicate({});
  EXPECT_FALSE(session_.canUndo());
}

TEST_F(SessionGroups, PartsMovedTogetherKeepTheirPlaceToEachOther) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform aFromB = part(a_).worldFromPart.inverse() * part(b_).worldFromPart;
    const RigidTransform before = part(c_).worldFromPart;
    const RigidTransform pose = RigidTransform{
        {uniform(random), uniform(random), uniform(random), uniform(random)},
        {uniform(random), uniform(random),
         uniform(random)}}.normalized();
    session_.moveParts({b_, a_}, a_, pose);
    EXPECT_EQ(part(a_).worldFromPart.translation, pose.translation);
    EXPECT_LT(glm::length(part(a_).worldFromPart.rotation - pose.rotation), 1e-15);
    const RigidTransform after = part(a_).worldFromPart.inverse() * part(b_).worldFromPart;
    EXPECT_LT(glm::distance(after.translation, aFromB.translation), 1e-14);
    EXPECT_GT(std::abs(glm::dot(after.rotation, aFromB.rotation)), 1.0 - 1e-14);
    EXPECT_EQ(part(c_).worldFromPart.translation, before.translation);
  }
}

TEST_F(SessionGroups, AShiftTurnsNothingToTheLastDigit) {
  const glm::dquat before = part(b_).worldFromPart.rotation;
  for (int i = 1; i <= 100; ++i)
    session_.moveParts({a_, b_}, a_, {{1, 0, 0, 0}, {0.1 * i, 0, 0}});
  EXPECT_EQ(part(b_).worldFromPart.rotation, before);
}

TEST_F(SessionGroups, NoCommandBypassesALockOfThePartOrOfItsGroup) {
  const GroupId inner = session_.group({{b_}, {}}, "inner"), outer = session_.group({{}, {inner}}, "outer"),
                open = session_.group({{}, {}}, "open");
  session_.setLocked({{a_}, {outer}}, true);
  session_.reset(session_.scene());
  const std::string before = describe(session_.scene());
  using Command = std::function<void(PartId)>;
  const RigidTransform aside{{1, 0, 0, 0}, {1, 1, 1}};
  const std::vector<Command> commands = {
      [&](PartId id) { session_.movePart(id, aside); },
      [&](PartId id) { session_.moveParts({c_, id}, c_, aside); },
      [&](PartId id) {
        session_.moveParts({c_}, c_, aside), session_.undo(), session_.moveParts({id}, c_, aside);
      },
      [&](PartId id) { session_.renamePart(id, "x"); },
      [&](PartId id) { session_.setDensity({c_, id}, 1.0); },
      [&](PartId id) { session_.deletePart(id); },
      [&](PartId id) { session_.deleteNodes({{c_, id}, {}}); },
      [&](PartId id) { session_.setMovingPart(id); },
      [&](PartId id) { session_.group({{c_, id}, {}}); },
      [&](PartId id) { session_.regroup({{id}, {}}, open); },
      [&](PartId) { session_.regroup({{c_}, {}}, inner); },
      [&](PartId) { session_.regroup({{}, {inner}}, std::nullopt); },
      [&](PartId) { session_.regroup({{}, {open}}, outer); },
      [&](PartId) { session_.ungroup({inner}); },
      [&](PartId) { session_.ungroup({outer}); },
      [&](PartId) { session_.deleteNodes({{}, {outer}}); },
      [&](PartId) { session_.deleteNodes({{}, {inner}}); },
      [&](PartId) { session_.renameGroup(inner, "x"); },
      [&](PartId) { session_.renameGroup(outer, "x"); },
  };
  for (const PartId locked : {a_, b_}) {
    for (std::size_t i = 0; i < commands.size(); ++i) {
      EXPECT_THROW(commands[i](locked), UsageError) << "command " << i << " on " << part(locked).name;
      EXPECT_EQ(describe(session_.scene()), before) << "command " << i;
    }
  }
  EXPECT_FALSE(session_.canUndo());
}

TEST_F(SessionGroups, AGroupWithALockedPartIsNeitherDeletedNorUngrouped) {
  const GroupId group = session_.group({{a_, b_}, {}});
  session_.setLocked(b_, true);
  EXPECT_THROW(session_.deleteNodes({{}, {group}}), UsageError);
  EXPECT_THROW(session_.ungroup({group}), UsageError);
  EXPECT_EQ(part(a_).group, group);
}

TEST_F(SessionGroups, TheMovingPartIsPutDownByWhatLocksIt) {
  const GroupId group = session_.group({{a_}, {}});
  session_.setMovingPart(a_);
  session_.setLocked({{b_}, {}}, true);
  EXPECT_EQ(session_.scene().movingPart(), a_);
  for (const SceneNodes& nodes : {SceneNodes{{a_}, {}}, SceneNodes{{}, {group}}}) {
    const std::size_t before = session_.historyIndex();
    session_.setLocked(nodes, true);
    EXPECT_EQ(session_.historyIndex(), before + 1);
    EXPECT_TRUE(session_.scene().isLocked(part(a_)));
    EXPECT_EQ(session_.scene().movingPart(), std::nullopt);
    session_.undo();
    EXPECT_FALSE(session_.scene().isLocked(part(a_)));
    EXPECT_EQ(session_.scene().movingPart(), a_);
  }
  // One that is not locked by it stays in hand.
  session_.setLocked({{a_}, {}}, false);
  EXPECT_EQ(session_.scene().movingPart(), a_);
}

TEST_F(SessionGroups, LockedPartsAreColouredAndThatIsOneStep) {
  session_.setLocked({{a_, b_}, {}}, true);
  const std::size_t before = session_.historyIndex();
  session_.setColour({a_, b_}, {0.25F, 0.5F, 0.75F});
  EXPECT_EQ(part(a_).colour, (Colour{0.25F, 0.5F, 0.75F}));
  EXPECT_EQ(part(b_).colour, (Colour{0.25F, 0.5F, 0.75F}));
  EXPECT_EQ(session_.historyIndex(), before + 1);
}

TEST_F(SessionGroups, LockedPartsAreHiddenIsolatedAndMadeTransparent) {
  session_.setLocked({{a_, b_}, {}}, true);
  session_.setVisible({a_, c_}, false);
  session_.setOpacity({a_, b_}, 0.3);
  session_.isolate({a_});
  EXPECT_TRUE(part(a_).isVisible && !part(b_).isVisible);
  EXPECT_EQ(part(b_).opacity, 0.3);
  session_.endIsolation();
  EXPECT_TRUE(!part(a_).isVisible && part(b_).isVisible && !part(c_).isVisible);
}

TEST_F(SessionGroups, UndoAndRedoOfAnIsolationKeepWhatWasVisible) {
  session_.setVisible(b_, false);
  session_.isolate({c_});
  session_.isolate({a_});
  session_.undo();
  EXPECT_TRUE(!part(a_).isVisible && part(c_).isVisible);
  session_.endIsolation();
  EXPECT_TRUE(part(a_).isVisible && !part(b_).isVisible && part(c_).isVisible);
  session_.undo();
  EXPECT_TRUE(session_.scene().isIsolated());
}

TEST_F(SessionGroups, NewGroupStandsInTheInnermostOneThatHoldsAllOfThem) {
  const GroupId outer = session_.group({{a_, b_, c_}, {}}, "outer");
  const GroupId inner = session_.group({{a_, b_}, {}});
  EXPECT_EQ(group(inner).parent, outer);
  EXPECT_EQ(part(c_).group, outer);
  EXPECT_EQ(part(b_).group, inner);
  EXPECT_EQ(group(session_.group({{a_, c_}, {}})).name, "Group 2");
}

TEST_F(SessionGroups, UngroupingPutsWhatItHoldsInItsPlace) {
  const GroupId inner = session_.group({{a_}, {}}, "inner"), outer = session_.group({{b_}, {inner}}, "outer");
  session_.ungroup({outer});
  EXPECT_EQ(group(inner).parent, std::nullopt);
  EXPECT_EQ(part(b_).group, std::nullopt);
  EXPECT_EQ(part(a_).group, inner);
  session_.undo();
  session_.ungroup({outer, inner});
  EXPECT_TRUE(session_.scene().groups().empty());
  EXPECT_EQ(part(a_).group, std::nullopt);
}

TEST_F(SessionGroups, CopyOfAGroupHoldsCopiesOfAllThatItHolds) {
  const GroupId inner = session_.group({{a_}, {}}, "inner"), outer = session_.group({{b_}, {inner}}, "outer");
  session_.setLocked(b_, true);
  session_.setColour(a_, {0.25F, 0.5F, 0.75F});
  const SceneNodes copies = session_.duplicate({{a_, b_}, {outer, inner}});
  ASSERT_EQ(copies.groups.size(), 1U);
  EXPECT_TRUE(copies.parts.empty());
  const SceneNodes in = childrenOf(session_.scene(), copies.groups[0]);
  ASSERT_EQ(in.groups.size(), 1U);
  ASSERT_EQ(in.parts.size(), 1U);
  EXPECT_EQ(group(copies.groups[0]).name, "outer 2");
  EXPECT_EQ(group(in.groups[0]).name, "inner");
  EXPECT_EQ(part(in.parts[0]).name, "b 2");
  EXPECT_FALSE(part(in.parts[0]).isLocked);
  const SceneNodes deep = childrenOf(session_.scene(), in.groups[0]);
  ASSERT_EQ(deep.parts.size(), 1U);
  EXPECT_EQ(part(deep.parts[0]).colour, part(a_).colour);
  EXPECT_EQ(part(deep.parts[0]).worldFromPart.translation, part(a_).worldFromPart.translation);
}

TEST_F(SessionGroups, CopyOfAPartInALockedGroupStandsOutsideOfIt) {
  const GroupId inner = session_.group({{a_}, {}}, "inner"), outer = session_.group({{b_}, {inner}}, "outer");
  session_.setLocked({{}, {inner}}, true);
  EXPECT_EQ(part(session_.duplicatePart(a_)).group, outer);
  session_.setLocked({{}, {outer}}, true);
  const PartId copy = session_.duplicatePart(a_);
  EXPECT_EQ(part(copy).group, std::nullopt);
  EXPECT_FALSE(session_.scene().isLocked(part(copy)));
}

/// Whatever is done: each group stands under the top, each part in a group that there is.
void expectTree(const Scene& scene) {
  std::size_t groups = 0;
  visitGroups(scene, [&](const Group&, std::size_t depth) {
    EXPECT_LT(depth, kMaxGroupDepth);
    ++groups;
  });
  EXPECT_EQ(groups, scene.groups().size());
  for (const Scene::PartPtr& part : scene.parts())
    EXPECT_TRUE(!part->group || scene.findGroup(*part->group) != nullptr);
}

TEST_F(SessionGroups, RandomCommandsKeepTheTreeAndUndoneInFullGiveBackTheBeginning) {
  std::mt19937 random(11);
  const auto anyNodes = [&] {
    SceneNodes nodes;
    for (const Scene::PartPtr& p : session_.scene().parts())
      if (random() % 4 == 0) nodes.parts.push_back(p->id);
    for (const Scene::GroupPtr& g : session_.scene().groups())
      if (random() % 6 == 0) nodes.groups.push_back(g->id);
    return nodes;
  };
  const auto anyGroup = [&]() -> std::optional<GroupId> {
    const auto& groups = session_.scene().groups();
    if (groups.empty() || random() % 4 == 0) return std::nullopt;
    return groups[random() % groups.size()]->id;
  };
  const std::vector<std::function<void()>> commands = {
      [&] { session_.addPart({}, "p"); },
      [&] { session_.group(anyNodes()); },
      [&] { session_.ungroup(anyNodes().groups); },
      [&] { session_.regroup(anyNodes(), anyGroup()); },
      [&] {
        if (session_.scene().parts().size() < 60) session_.duplicate(anyNodes());
      },
      [&] { session_.deleteNodes(anyNodes()); },
      [&] { session_.setLocked(anyNodes(), random() % 4 == 0); },
      [&] { session_.setVisible(anyNodes().parts, random() % 2 == 0); },
      [&] { session_.isolate(anyNodes().parts); },
      [&] { session_.endIsolation(); },
      [&] { session_.setOpacity(anyNodes().parts, random() % 2 == 0 ? 0.5 : 1.0); },
  };
  std::vector<std::string> states{describe(session_.scene())};
  for (int i = 0; i < 900; ++i) {
    const std::string before = describe(session_.scene()), label = session_.undoText();
    try {
      commands[random() % commands.size()]();
    } catch (const UsageError&) {
      EXPECT_EQ(describe(session_.scene()), before);
      EXPECT_EQ(session_.undoText(), label);
    }
    expectTree(session_.scene());
    if (describe(session_.scene()) != before) states.push_back(describe(session_.scene()));
  }
  ASSERT_GT(states.size(), 300U);
  while (states.size() > 1) {
    states.pop_back();
    session_.undo();
    ASSERT_EQ(describe(session_.scene()), states.back());
  }
  EXPECT_FALSE(session_.canUndo());
}

TEST_F(SessionGroups, AGroupIsTakenInHandAndMovedAsOneStep) {
  const GroupId pair = session_.group({{a_, b_}, {}}, "Pair");
  session_.setMovingPart(a_);
  EXPECT_EQ(stepOfHand([&] { session_.setMovingGroup(pair); }), "Make Pair the moving group");
  EXPECT_EQ(session_.scene().movingGroup(), pair);
  session_.setMovingGroup(pair);
  EXPECT_EQ(session_.undoText(), "Make Pair the moving group") << "once more is no step";
  const RigidTransform aFromB = part(a_).worldFromPart.inverse() * part(b_).worldFromPart;
  const RigidTransform pose{glm::dquat(0.6, 0.0, 0.8, 0.0), {1.0, 2.0, 3.0}};
  EXPECT_EQ(stepOf([&] { session_.moveMoving(pose, "Feel"); }), "Feel Pair");
  EXPECT_EQ(part(a_).worldFromPart.translation, pose.translation);
  const RigidTransform expected = pose * aFromB;
  EXPECT_LT(glm::distance(part(b_).worldFromPart.translation, expected.translation), 1e-13);
  EXPECT_EQ(part(c_).worldFromPart.translation.z, -0.3);
  session_.setMovingPart(a_);
  EXPECT_EQ(session_.scene().movingGroup(), std::nullopt);
}

TEST_F(SessionGroups, LockingAnythingOfTheMovingGroupPutsItDown) {
  const GroupId inner = session_.group({{b_}, {}}, "Inner"), outer = session_.group({{a_}, {inner}}, "Outer");
  for (const SceneNodes& nodes : {SceneNodes{{b_}, {}}, SceneNodes{{}, {inner}}, SceneNodes{{}, {outer}}}) {
    session_.setMovingGroup(outer);
    session_.setLocked(nodes, true);
    EXPECT_EQ(session_.scene().movingPart(), std::nullopt);
    EXPECT_EQ(session_.scene().movingGroup(), std::nullopt);
    EXPECT_THROW(session_.setMovingGroup(outer), UsageError);
    session_.undo();
    EXPECT_EQ(session_.scene().movingGroup(), outer);
    session_.setMovingPart(std::nullopt);
  }
  session_.setMovingGroup(outer);
  session_.setLocked({{c_}, {}}, true);
  EXPECT_EQ(session_.scene().movingGroup(), outer) << "it is not of the group";
  session_.deleteNodes({{}, {outer}});
  EXPECT_EQ(session_.scene().movingGroup(), std::nullopt);
  session_.undo();
  EXPECT_EQ(session_.scene().movingGroup(), outer);
}

}  // namespace
}  // namespace nearfit::session_groups_test
