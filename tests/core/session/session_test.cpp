#include "core/session/session.h"

#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/allocation_hook.h"

namespace nearfit::session_test {
namespace {

const RigidTransform kAside{{1, 0, 0, 0}, {0.1, 0.2, 0.3}};

HapticSettings withCutoff(double cutoff) {
  HapticSettings haptics;
  haptics.springs.cutoff = cutoff;
  return haptics;
}

/// Everything of a scene that a user sees, as text.
std::string describe(const Scene& scene) {
  std::string text;
  for (const auto& part : scene.parts()) {
    const RigidTransform& pose = part->worldFromPart;
    text += part->name + " " + std::to_string(static_cast<unsigned>(part->id)) + " " +
            std::to_string(pose.translation.x) + " " + std::to_string(pose.rotation.w) + " " +
            std::to_string(part->colour.r) + " " + std::to_string(part->density) +
            (part->isVisible ? " visible" : "") + (part->isLocked ? " locked" : "") +
            (scene.movingPart() == part->id ? " moving" : "") + "\n";
  }
  return text + std::to_string(scene.haptics().springs.cutoff);
}

TEST(Session, EveryCommandIsOneStepOfUndo) {
  Session session;
  std::vector<std::string> states{describe(session.scene())};
  const auto step = [&] { states.push_back(describe(session.scene())); };
  const PartId peg = session.addPart({}, "Peg");
  step();
  session.duplicatePart(peg);
  step();
  session.renamePart(peg, "Pin");
  step();
  session.movePart(peg, kAside);
  step();
  session.setColour(peg, {1, 0, 0});
  step();
  session.setDensity(peg, 7850.0);
  step();
  session.setMovingPart(peg);
  step();
  session.setHaptics(withCutoff(0.02));
  step();
  session.setVisible(peg, false);
  step();
  session.setMovingPart(std::nullopt);
  step();
  session.setLocked(peg, true);
  step();
  session.setLocked(peg, false);
  step();
  session.deletePart(peg);
  step();
  for (std::size_t i = 1; i < states.size(); ++i)
    EXPECT_NE(states[i], states[i - 1]) << "step " << i;

  for (std::size_t i = states.size() - 1; i > 0; --i) {
    ASSERT_TRUE(session.canUndo());
    session.undo();
    EXPECT_EQ(describe(session.scene()), states[i - 1]) << "after undoing step " << i;
  }
  EXPECT_FALSE(session.canUndo());
  session.undo();
  for (std::size_t i = 1; i < states.size(); ++i) {
    session.redo();
    EXPECT_EQ(describe(session.scene()), states[i]) << "after redoing step " << i;
  }
  EXPECT_FALSE(session.canRedo());
}

TEST(Session, SettingTheSameValueIsNoStep) {
  Session session;
  const PartId peg = session.addPart({}, "Peg", kAside);
  session.undo();
  session.redo();
  session.undo();
  session.redo();
  const Part part = *session.scene().find(peg);
  session.renamePart(peg, "Peg");
  session.movePart(peg, kAside);
  session.setColour(peg, part.colour);
  session.setDensity(peg, part.density);
  session.setVisible(peg, true);
  session.setLocked(peg, false);
  session.setMovingPart(std::nullopt);
  session.setHaptics(session.scene().haptics());
  EXPECT_EQ(session.undoText(), "Add Peg");
  session.undo();
  EXPECT_FALSE(session.canUndo());
}

TEST(Session, RefusedCommandChangesNothingAndKeepsRedo) {
  Session session;
  const PartId peg = session.addPart({}, "Peg");
  const PartId hole = session.addPart({}, "Hole");
  session.setLocked(peg, true);
  session.setHaptics(withCutoff(0.5));
  session.undo();
  const std::string before = describe(session.scene());
  EXPECT_THROW(session.movePart(peg, kAside), UsageError);
  EXPECT_THROW(session.renamePart(peg, "Pin"), UsageError);
  EXPECT_THROW(session.deletePart(peg), UsageError);
  EXPECT_THROW(session.setDensity(peg, 500.0), UsageError);
  EXPECT_THROW(session.setDensity(hole, 0.0), UsageError);
  EXPECT_THROW(session.setMovingPart(peg), UsageError);
  EXPECT_THROW(session.renamePart(hole, "Peg"), UsageError);
  EXPECT_THROW(session.renamePart(hole, ""), UsageError);
  EXPECT_THROW(session.movePart(hole, {{0, 0, 0, 0}, {}}), UsageError);
  EXPECT_THROW(session.addPart({}, ""), UsageError);
  EXPECT_THROW(session.duplicatePart(PartId{99}), UsageError);
  EXPECT_THROW(session.setVisible(PartId{99}, false), UsageError);
  EXPECT_THROW(session.setHaptics(withCutoff(-1.0)), UsageError);
  EXPECT_EQ(describe(session.scene()), before);
  EXPECT_EQ(session.undoText(), "Lock Peg");
  EXPECT_TRUE(session.canRedo());
}

TEST(Session, MessageOfALockedPartNamesItAndTheRemedy) {
  Session session;
  const PartId peg = session.addPart({}, "Peg");
  session.setLocked(peg, true);
  try {
    session.deletePart(peg);
    FAIL() << "a locked part was deleted";
  } catch (const UsageError& e) {
    EXPECT_STREQ(e.what(), "part \"Peg\": it is locked; unlock it first");
  }
}

TEST(Session, LockedPartCanBeHiddenAndDuplicatedAndItsCopyIsFree) {
  Session session;
  const PartId peg = session.addPart({}, "Peg");
  session.setLocked(peg, true);
  session.setVisible(peg, false);
  EXPECT_FALSE(session.scene().find(peg)->isVisible);
  const PartId copy = session.duplicatePart(peg);
  EXPECT_EQ(session.scene().find(copy)->name, "Peg 2");
  session.movePart(copy, kAside);
  EXPECT_EQ(session.scene().find(copy)->worldFromPart.translation, kAside.translation);
}

TEST(Session, NewCommandForgetsRedo) {
  Session session;
  session.addPart({}, "Peg");
  session.undo();
  session.addPart({}, "Hole");
  EXPECT_FALSE(session.canRedo());
  session.redo();
  EXPECT_EQ(session.scene().parts().size(), 1U);
}

TEST(Session, IdOfAnUndonePartIsNotGivenToAnother) {
  Session session;
  const PartId peg = session.addPart({}, "Peg");
  session.undo();
  EXPECT_NE(session.addPart({}, "Hole"), peg);
}

TEST(Session, TextsSayWhatUndoAndRedoWouldDo) {
  Session session;
  EXPECT_EQ(session.undoText(), "");
  const PartId peg = session.addPart({}, "Peg");
  session.movePart(peg, kAside);
  EXPECT_EQ(session.undoText(), "Move Peg");
  session.undo();
  EXPECT_EQ(session.undoText(), "Add Peg");
  EXPECT_EQ(session.redoText(), "Move Peg");
}

TEST(Session, UndoSaysWhatOfTheFeelChanged) {
  Session session;
  HapticSettings haptics = withCutoff(0.02);
  session.setHaptics(haptics);
  EXPECT_EQ(session.undoText(), "Feel settings: springs");
  haptics.proxy.margin = 1e-3;
  session.setHaptics(haptics);
  EXPECT_EQ(session.undoText(), "Feel settings: margin");
  haptics.proxy.friction = 0.25;
  session.setHaptics(haptics);
  EXPECT_EQ(session.undoText(), "Feel settings: friction");
  haptics.coupling = {false, 500.0, 1.0, 0.5, 0.1};
  session.setHaptics(haptics);
  EXPECT_EQ(session.undoText(), "Feel settings: coupling");
  haptics.weight.hasWeight = true;
  session.setHaptics(haptics);
  EXPECT_EQ(session.undoText(), "Feel settings: weight");
  haptics.mapping.scale = 2.0;
  session.setHaptics(haptics);
  EXPECT_EQ(session.undoText(), "Feel settings: scale");
  haptics.mapping.rotationLocks[2] = true;
  session.setHaptics(haptics);
  EXPECT_EQ(session.undoText(), "Feel settings: locked axes");
  haptics.mapping.scale = 3.0;
  haptics.proxy.friction = 0.5;
  session.setHaptics(haptics);
  EXPECT_EQ(session.undoText(), "Feel settings") << "more than one thing";
  haptics.mode = HapticMode::Springs;
  session.setHaptics(haptics);
  EXPECT_EQ(session.undoText(), "Feel settings: mode");
  haptics.mapping.translationLocks[1] = true;
  session.setHaptics(haptics);
  EXPECT_TRUE(session.scene().haptics() == haptics);
  session.undo();
  EXPECT_FALSE(session.scene().haptics().mapping.translationLocks[1]);
}

TEST(Session, UndoGoesBackAtLeastItsBoundAndNoFarther) {
  Session session;
  const PartId peg = session.addPart({}, "Peg");
  for (std::size_t i = 1; i <= Session::kMaxUndo + 5; ++i) {
    session.movePart(peg, {{1, 0, 0, 0}, {static_cast<double>(i), 0, 0}});
  }
  std::size_t steps = 0;
  for (; session.canUndo(); ++steps)
    session.undo();
  EXPECT_EQ(steps, Session::kMaxUndo);
  EXPECT_EQ(session.scene().find(peg)->worldFromPart.translation.x, 5.0);
}

TEST(Session, ModifiedMarkFollowsTheSavedState) {
  Session session;
  EXPECT_FALSE(session.isModified());
  session.addPart({}, "Peg");
  EXPECT_TRUE(session.isModified());
  session.undo();
  EXPECT_FALSE(session.isModified());
  session.addPart({}, "Peg");
  EXPECT_TRUE(session.isModified());
  session.reset(session.scene(), "/somewhere/peg.nearfit");
  EXPECT_FALSE(session.isModified());
  EXPECT_FALSE(session.canUndo());
  EXPECT_EQ(session.file(), "/somewhere/peg.nearfit");
}

TEST(Session, ListenersHearOfEachChangeOnce) {
  Session session;
  int calls = 0;
  const Subscription changes = session.onChange(SceneEvents::Stage::Model, [&] { ++calls; });
  const PartId peg = session.addPart({}, "Peg");
  EXPECT_EQ(calls, 1);
  session.renamePart(peg, "Peg");
  EXPECT_THROW(session.renamePart(peg, ""), UsageError);
  EXPECT_EQ(calls, 1);
  session.undo();
  session.undo();
  session.redo();
  session.redo();
  EXPECT_EQ(calls, 3);
  session.reset();
  EXPECT_EQ(calls, 4);
}

TEST(Session, RandomCommandsUndoneInFullGiveBackTheBeginning) {
  std::mt19937 random(7);
  Session session;
  const auto anyPart = [&] {
    const auto& parts = session.scene().parts();
    return parts.empty() ? PartId{0} : parts[random() % parts.size()]->id;
  };
  std::vector<std::string> states{describe(session.scene())};
  for (int i = 0; i < 900; ++i) {
    const std::string before = describe(session.scene());
    const std::string undoText = session.undoText();
    try {
      switch (random() % 8) {
        case 0:
          session.addPart({}, "Part");
          break;
        case 1:
          session.duplicatePart(anyPart());
          break;
        case 2:
          session.deletePart(anyPart());
          break;
        case 3:
          session.movePart(anyPart(), {{1, 0, 0, 0}, {static_cast<double>(random() % 5), 0, 0}});
          break;
        case 4:
          session.setLocked(anyPart(), random() % 4 == 0);
          break;
        case 5:
          session.setMovingPart(anyPart());
          break;
        case 6:
          session.setVisible(anyPart(), random() % 2 == 0);
          break;
        default:
          session.renamePart(anyPart(), "Name " + std::to_string(random() % 9));
          break;
      }
    } catch (const UsageError&) {
      EXPECT_EQ(describe(session.scene()), before);
      EXPECT_EQ(session.undoText(), undoText);
    }
    if (describe(session.scene()) != before) states.push_back(describe(session.scene()));
  }
  ASSERT_GT(states.size(), 300U);
  while (states.size() > 1) {
    states.pop_back();
    session.undo();
    ASSERT_EQ(describe(session.scene()), states.back());
  }
  EXPECT_FALSE(session.canUndo());
}

TEST(Session, HistoryNamesEveryStepAndSaysWhereTheSceneIs) {
  Session session;
  const auto labels = [&] {
    std::vector<std::string> texts;
    for (const Session::Step& step : session.history())
      texts.push_back(step.label);
    return texts;
  };
  EXPECT_EQ(labels(), std::vector<std::string>{""});
  EXPECT_EQ(session.historyIndex(), 0U);
  const PartId peg = session.addPart({}, "Peg");
  session.movePart(peg, kAside);
  session.setLocked(peg, true);
  const std::vector<std::string> all{"", "Add Peg", "Move Peg", "Lock Peg"};
  EXPECT_EQ(labels(), all);
  EXPECT_EQ(session.historyIndex(), 3U);
  session.undo();
  EXPECT_EQ(labels(), all) << "what can be redone stays in the list";
  EXPECT_EQ(session.historyIndex(), 2U);
  session.setVisible(peg, false);
  EXPECT_EQ(labels(), (std::vector<std::string>{"", "Add Peg", "Move Peg", "Hide Peg"}));
}

TEST(Session, HistorySaysHowFarAPartWent) {
  Session session;
  PartGeometry geometry;
  geometry.mass.centre = {0.0, 0.1, 0.0};
  const PartId peg = session.addPart(std::make_shared<const PartGeometry>(std::move(geometry)), "Peg");
  session.movePart(peg, {{1, 0, 0, 0}, {0.03, 0.0, -0.04}});
  // Half a turn about x takes the centre to the other side of the part's own origin.
  session.movePart(peg, {{0, 1, 0, 0}, {0.03, 0.0, -0.04}}, "Turn");
  session.setVisible(peg, false);
  session.undo();
  const std::vector<Session::Step> steps = session.history();
  ASSERT_EQ(steps.size(), 5U);
  EXPECT_EQ(steps[1].shift, 0.0);
  EXPECT_NEAR(steps[2].shift, 0.05, 1e-15);
  EXPECT_EQ(steps[2].angle, 0.0);
  EXPECT_NEAR(steps[3].shift, 0.2, 1e-15);
  EXPECT_NEAR(steps[3].angle, M_PI, 1e-12);
  EXPECT_EQ(steps[4], (Session::Step{"Hide Peg", 0.0, 0.0}));
}

TEST(Session, AssemblyIsAddedInOneStep) {
  Session session;
  NewNodes nodes;
  nodes.groups = {{"vise", {}}, {"jaws", 0}};
  nodes.parts = {{nullptr, "body", {}, {}, 0}, {nullptr, "jaw", {}, {}, 1}, {nullptr, "jaw", {}, {}, 1}};
  const SceneNodes added = session.addNodes(nodes);
  ASSERT_EQ(added.groups.size(), 1U);
  EXPECT_TRUE(added.parts.empty());
  EXPECT_EQ(session.undoText(), "Add vise");
  EXPECT_EQ(session.scene().parts().size(), 3U);
  EXPECT_EQ(session.scene().parts()[2]->name, "jaw 2");
  EXPECT_EQ(session.scene().groups().size(), 2U);
  session.undo();
  EXPECT_FALSE(session.canUndo());
  EXPECT_TRUE(session.scene().parts().empty() && session.scene().groups().empty());
  session.addNodes({});
  EXPECT_FALSE(session.canUndo());
}

TEST(Session, NodesThatCannotAllBeAddedChangeNothing) {
  Session session;
  NewNodes nodes;
  nodes.groups = {{"vise", {}}};
  nodes.parts = {{nullptr, "", {}, {}, 0}};
  EXPECT_THROW(session.addNodes(nodes), UsageError);
  EXPECT_TRUE(session.scene().groups().empty());
  EXPECT_FALSE(session.canUndo());
}

TEST(Session, RefiningKeepsPosesAndPivotsAndIsOneStep) {
  Session session;
  const PartGeometryPtr coarse = std::make_shared<const PartGeometry>(),
                        fine = std::make_shared<const PartGeometry>();
  const PartId a = session.addPart(coarse, "Pin", {{1, 0, 0, 0}, {0.1, 0.0, 0.0}});
  const PartId b = session.addPart(coarse, "Pin");
  session.setPivots({{a, glm::dvec3(0.01, 0.0, 0.0)}});
  session.refineParts({{a, fine}, {b, fine}});
  EXPECT_EQ(session.undoText(), "Refine 2 parts");
  EXPECT_EQ(session.scene().get(a).geometry, fine);
  EXPECT_EQ(session.scene().get(b).geometry, fine);
  EXPECT_EQ(session.scene().get(a).worldFromPart.translation.x, 0.1);
  EXPECT_EQ(session.scene().get(a).pivot, glm::dvec3(0.01, 0.0, 0.0));
  session.undo();
  EXPECT_EQ(session.scene().get(a).geometry, coarse);
  session.setLocked(b, true);
  EXPECT_THROW(session.refineParts({{a, fine}, {b, fine}}), UsageError);
  EXPECT_EQ(session.scene().get(a).geometry, coarse);
}

TEST(Session, GoToIsTheSameAsUndoAndRedoAndTellsOnce) {
  Session session, other;
  for (Session* s : {&session, &other}) {
    const PartId peg = s->addPart({}, "Peg");
    s->movePart(peg, kAside);
    s->duplicatePart(peg);
    s->deletePart(peg);
  }
  int told = 0;
  const Subscription changes = session.onChange(SceneEvents::Stage::Model, [&] { ++told; });
  for (const std::size_t index : {1U, 4U, 0U, 3U, 2U}) {
    while (other.historyIndex() > index)
      other.undo();
    while (other.historyIndex() < index)
      other.redo();
    session.goTo(index);
    EXPECT_EQ(describe(session.scene()), describe(other.scene())) << "at " << index;
    EXPECT_EQ(session.historyIndex(), index);
  }
  EXPECT_EQ(told, 5);
  session.goTo(2);
  session.goTo(5);
  EXPECT_EQ(told, 5) << "where it is already, and where there is nothing";
  EXPECT_EQ(session.historyIndex(), 2U);
}

TEST(Session, GoingBackFarGivesNoIdTwice) {
  Session session;
  const PartId first = session.addPart({}, "First");
  const PartId second = session.duplicatePart(first);
  session.goTo(0);
  const PartId third = session.addPart({}, "Third");
  EXPECT_NE(third, first);
  EXPECT_NE(third, second);
}

TEST(Session, CountsStepsFromWhatWasSavedEitherWay) {
  Session session;
  const PartId peg = session.addPart({}, "Peg");
  EXPECT_EQ(session.changesSinceSave(), 1U);
  session.setVisible(peg, false);
  session.setVisible(peg, true);
  EXPECT_EQ(session.changesSinceSave(), 3U);
  session.goTo(0);
  EXPECT_EQ(session.changesSinceSave(), 0U);
  session.redo();
  const std::uint64_t serial = session.stateSerial();
  session.redo();
  EXPECT_NE(session.stateSerial(), serial);
  session.undo();
  EXPECT_EQ(session.stateSerial(), serial);
  EXPECT_EQ(session.changesSinceSave(), 1U);
}

TEST(Session, RestoredSceneIsModifiedAndHasItsFile) {
  Session source, session;
  source.addPart({}, "Peg");
  session.restore(source.scene(), "somewhere.nearfit");
  EXPECT_TRUE(session.isModified());
  EXPECT_EQ(session.file(), "somewhere.nearfit");
  EXPECT_FALSE(session.canUndo());
  EXPECT_EQ(session.changesSinceSave(), 1U);
  session.setVisible(session.scene().parts()[0]->id, false);
  session.undo();
  EXPECT_TRUE(session.isModified()) << "no step of undo leads to what is in the file";
}

TEST(Session, ReloadedPartsKeepTheirPosesAndAreOneStep) {
  Session session;
  const auto old = std::make_shared<const PartGeometry>(), renewed = std::make_shared<const PartGeometry>();
  const PartId peg = session.addPart(old, "Peg", kAside);
  const PartId copy = session.duplicatePart(peg);
  session.setLocked(copy, true);
  const std::size_t before = session.historyIndex();
  session.reloadParts({{peg, renewed}, {copy, renewed}});
  EXPECT_EQ(session.historyIndex(), before + 1);
  EXPECT_EQ(session.undoText(), "Reload 2 parts");
  for (const PartId id : {peg, copy}) {
    EXPECT_EQ(session.scene().find(id)->geometry, renewed);
    EXPECT_EQ(session.scene().find(id)->worldFromPart.translation, kAside.translation);
  }
  session.reloadParts({{peg, renewed}});
  EXPECT_EQ(session.historyIndex(), before + 1) << "it has it already";
  session.undo();
  EXPECT_EQ(session.scene().find(copy)->geometry, old);
}

TEST(Session, LockedPartIsNotRescaled) {
  Session session;
  const PartId peg = session.addPart(std::make_shared<const PartGeometry>(), "Peg", kAside);
  const auto larger = std::make_shared<const PartGeometry>();
  session.rescaleParts({{peg, larger}});
  EXPECT_EQ(session.undoText(), "Change the unit of Peg");
  EXPECT_EQ(session.scene().find(peg)->geometry, larger);
  session.setLocked(peg, true);
  EXPECT_THROW(session.rescaleParts({{peg, std::make_shared<const PartGeometry>()}}), UsageError);
}

TEST(Session, PositionsInAGltfScaleWithItsUnitAndThoseOfMeshesStay) {
  const auto geometryIn = [](const char* file, double metresPerUnit) {
    PartGeometry geometry;
    geometry.file = file;
    geometry.metresPerUnit = metresPerUnit;
    return std::make_shared<const PartGeometry>(std::move(geometry));
  };
  Session session;
  const RigidTransform aside{glm::angleAxis(0.5, glm::dvec3(0, 0, 1)), {1.0, -2.0, 4.0}};
  const PartId ofGltf = session.addPart(geometryIn("/cad/a.glb", 1.0), "Bolt", aside);
  const PartId ofMesh = session.addPart(geometryIn("/cad/a.stl", 1.0), "Nut", aside);
  session.rescaleParts({{ofGltf, geometryIn("/cad/a.glb", 0.5)}, {ofMesh, geometryIn("/cad/a.stl", 0.5)}});
  EXPECT_EQ(session.scene().find(ofGltf)->worldFromPart.translation, glm::dvec3(0.5, -1.0, 2.0));
  EXPECT_EQ(session.scene().find(ofGltf)->worldFromPart.rotation,
            session.scene().find(ofMesh)->worldFromPart.rotation);
  EXPECT_EQ(session.scene().find(ofMesh)->worldFromPart.translation, aside.translation);
  session.undo();
  EXPECT_EQ(session.scene().find(ofGltf)->worldFromPart.translation, aside.translation);
}

TEST(Session, PivotsAreAStepAndStayWhereTheyAreOnThePart) {
  const auto geometryIn = [](double metresPerUnit) {
    PartGeometry geometry;
    geometry.metresPerUnit = metresPerUnit;
    return std::make_shared<const PartGeometry>(std::move(geometry));
  };
  Session session;
  const PartId peg = session.addPart(geometryIn(1e-3), "Peg", kAside);
  const PartId copy = session.duplicatePart(peg);
  const auto pivotOf = [&](PartId id) { return session.scene().find(id)->pivot; };
  session.setPivots({{peg, glm::dvec3(1, 2, 3)}, {copy, glm::dvec3(4, 5, 6)}});
  EXPECT_EQ(session.undoText(), "Move the pivot of 2 parts");
  session.movePart(peg, {});
  session.rescaleParts({{peg, geometryIn(1e-2)}});
  EXPECT_LT(glm::distance(*pivotOf(peg), {10, 20, 30}), 1e-12);
  EXPECT_THROW(session.rescaleParts({{peg, geometryIn(1e8)}}), UsageError) << "beyond the limit of a scene";
  EXPECT_EQ(pivotOf(copy), glm::dvec3(4, 5, 6));
  EXPECT_EQ(pivotOf(session.duplicatePart(copy)), glm::dvec3(4, 5, 6));
  session.setPivots({{copy, {}}});
  EXPECT_EQ(session.undoText(), "Reset the pivot of Peg 2");
  EXPECT_EQ(pivotOf(copy), std::nullopt);
  session.undo();
  EXPECT_EQ(pivotOf(copy), glm::dvec3(4, 5, 6));

  const std::size_t steps = session.historyIndex();
  session.setPivots({{copy, glm::dvec3(4, 5, 6)}});
  EXPECT_EQ(session.historyIndex(), steps) << "it is there already";
  EXPECT_THROW(session.setPivots({{copy, glm::dvec3(NAN, 0, 0)}}), UsageError);
  EXPECT_THROW(session.setPivots({{copy, glm::dvec3(0, -2 * kMaxPosition, 0)}}), UsageError);
  session.setLocked(copy, true);
  EXPECT_THROW(session.setPivots({{peg, {}}, {copy, {}}}), UsageError);
  EXPECT_LT(glm::distance(*pivotOf(peg), {10, 20, 30}), 1e-12) << "refused whole";
}

// A set of the names of all parts there were was once made for each.
TEST(Session, TensOfThousandsOfPartsAreAddedAndDuplicatedWithFewAllocationsEach) {
  constexpr std::size_t kCount = 30'000;
  constexpr std::uint64_t kMaxAllocations = 200;  // For a part and its copy; those sets take 100,000.
  Session session;
  test::resetAllocationCount();
  test::startCountingAllocations();
  const std::vector<PartId> added = session.addParts(std::vector<Session::NewPart>(kCount, {nullptr, "Peg"}));
  ASSERT_EQ(added.size(), kCount);
  EXPECT_EQ(session.scene().get(added.back()).name, "Peg 30000");
  EXPECT_EQ(session.scene().get(added.back()).colour, kPartPalette[(kCount - 1) % kPartPalette.size()]);
  const SceneNodes copies = session.duplicate({added, {}});
  test::stopCountingAllocations();
  EXPECT_LE(test::countedAllocations() / kCount, kMaxAllocations);
  ASSERT_EQ(copies.parts.size(), kCount);
  EXPECT_EQ(session.scene().get(copies.parts.back()).name, "Peg 60000");
  EXPECT_EQ(session.undoText(), "Duplicate 30000 parts");
}

}  // namespace
}  // namespace nearfit::session_test
