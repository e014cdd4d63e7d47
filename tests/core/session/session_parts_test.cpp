#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/session/session.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::session_parts_test {
namespace {

TEST(SessionParts, PartsThatComeTogetherAreOneStep) {
  Session session;
  int changes = 0;
  const Subscription told = session.onChange(SceneEvents::Stage::Model, [&] { ++changes; });
  const std::vector<PartId> added = session.addParts({{{}, "Peg"}, {{}, "Peg"}, {{}, "Hole"}});
  ASSERT_EQ(added.size(), 3U);
  EXPECT_EQ(changes, 1);
  EXPECT_EQ(session.undoText(), "Add 3 parts");
  EXPECT_EQ(session.scene().find(added[1])->name, "Peg 2");
  EXPECT_NE(session.scene().find(added[0])->colour, session.scene().find(added[1])->colour);
  session.undo();
  EXPECT_TRUE(session.scene().parts().empty());
  EXPECT_FALSE(session.canUndo());
}

TEST(SessionParts, OnePartIsNamedAndNoneIsNoStep) {
  Session session;
  EXPECT_TRUE(session.addParts({}).empty());
  EXPECT_FALSE(session.canUndo());
  session.addParts({{{}, "Peg"}});
  EXPECT_EQ(session.undoText(), "Add Peg");
}

TEST(SessionParts, ARefusedOneLeavesAllOut) {
  Session session;
  EXPECT_THROW(session.addParts({{{}, "Peg"}, {{}, ""}}), UsageError);
  EXPECT_TRUE(session.scene().parts().empty());
  EXPECT_FALSE(session.canUndo());
}

TEST(SessionParts, AnotherSceneHasAnotherSerialAndEditsHaveNot) {
  Session session;
  const std::uint64_t first = session.sceneSerial();
  session.addPart({}, "Peg");
  session.undo();
  EXPECT_EQ(session.sceneSerial(), first);
  session.reset();
  const std::uint64_t second = session.sceneSerial();
  EXPECT_NE(second, first);
  session.restore({}, {});
  EXPECT_NE(session.sceneSerial(), second);
}

TEST(SessionParts, ARepairIsOneStepThatKeepsPosesAndIsRefusedForLockedParts) {
  const PartGeometryPtr open = test::freshGeometryOf(test::squareMesh(1.0, 1)),
                        closed = test::freshGeometryOf(test::boxMesh({1, 1, 1}));
  Session session;
  const PartId peg = session.addPart(open, "Peg", {{1, 0, 0, 0}, {1, 2, 3}}),
               other = session.addPart(open, "Other");
  session.repairParts({{peg, closed}});
  EXPECT_EQ(session.undoText(), "Repair Peg");
  EXPECT_EQ(session.scene().get(peg).geometry, closed);
  EXPECT_EQ(session.scene().get(peg).worldFromPart.translation, glm::dvec3(1, 2, 3));
  EXPECT_EQ(session.scene().get(other).geometry, open);
  session.undo();
  EXPECT_EQ(session.scene().get(peg).geometry, open);
  session.setLocked(peg, true);
  EXPECT_THROW(session.repairParts({{peg, closed}}), UsageError);
}

/// A part that was named twice moved twice, away from the others.
TEST(SessionParts, APartThatIsNamedTwiceMovesOnce) {
  Session session;
  const PartId block = session.addPart({}, "Block"),
               peg = session.addPart({}, "Peg", {{1, 0, 0, 0}, {1, 0, 2}});
  // A quarter turn about z, and up by 3.
  const double half = std::sqrt(0.5);
  session.moveParts({block, peg, peg, block}, block, {{half, 0, 0, half}, {0, 0, 3}});
  EXPECT_EQ(session.undoText(), "Move 2 parts");
  const glm::dvec3 reached = session.scene().get(peg).worldFromPart.translation;
  EXPECT_NEAR(reached.x, 0.0, 1e-12);
  EXPECT_NEAR(reached.y, 1.0, 1e-12);
  EXPECT_NEAR(reached.z, 5.0, 1e-12);
  EXPECT_EQ(session.scene().get(block).worldFromPart.translation, glm::dvec3(0, 0, 3));
}

/// Twice in the list, the parts of the group in hand were taken for others, and each named.
TEST(SessionParts, AGroupInHandWhosePartIsNamedTwiceMovesAsTheGroup) {
  Session session;
  const PartId block = session.addPart({}, "Block"), peg = session.addPart({}, "Peg");
  session.setMovingGroup(session.group({{block, peg}, {}}, "Frame"));
  session.moveParts({block, peg, peg}, block, {{1, 0, 0, 0}, {0, 0, 1}});
  EXPECT_EQ(session.undoText(), "Move Frame");
}

}  // namespace
}  // namespace nearfit::session_parts_test
