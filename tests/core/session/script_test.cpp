#include <algorithm>
#include <exception>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/scene_file.h"
#include "core/session/command_json.h"
#include "core/session/script_recorder.h"
#include "core/session/session_script.h"
#include "tests/support/documents.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::script_test {
namespace {

namespace fs = std::filesystem;
using ScriptJson = nlohmann::json;

const RigidTransform kTurned{{0.5, -0.5, 0.5, 0.5}, {0.1, -1e-17, 12345.678901234567}};

/// A session with parts, groups, joints and findings, and a recorder of it.
class ScriptTest : public ::testing::Test {
 protected:
  ScriptTest() {
    fs::create_directory(folder_.path() / "meshes");
    folder_.write("meshes/block.obj", test::objText(test::boxMesh({2, 2, 1})));
    folder_.write("meshes/peg.obj", test::objText(test::tetrahedronMesh(1)));
    folder_.write("meshes/vise.step", "the vise");
    changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { recorder_.follow(); });
  }

  PartGeometryPtr load(MeshSource source) const {
    source.file = folder_.path() / "meshes" / source.file;
    const LoadedPart loaded = loadPartGeometries(std::vector{source}).front();
    if (loaded.problem) std::rethrow_exception(loaded.problem);
    return loaded.geometry;
  }
  PartGeometryPtr block(double unit = 0.001) const { return load({"block.obj", unit, {}, {}, {}, {}}); }
  PartGeometryPtr pin(const Tessellation& tessellation = {}) const {
    return load({"vise.step", 1.0, {}, "pin", tessellation, {}});
  }

  /// Parts Block, Peg, Pin and Loose; Peg is in the first of two groups Frame, Pin in the other. Peg has two joints.
  void fill() {
    const PartGeometryPtr peg = load({"peg.obj", 0.0254, {}, {}, {}, {}});
    session_.addParts({{block(), "Block"}, {peg, "Peg \xC3\xA4"}, {pin(), "Pin"}, {block(), "Loose"}});
    session_.addNodes({{{"Frame", {}}, {"Inner", 0}}, {}});
    session_.group({{id("Pin")}, {}}, "Second");
    session_.renameGroup(groupId("Second"), "Frame");
    session_.regroup({{id("Peg \xC3\xA4")}, {}}, session_.scene().groups().front()->id);
    for (const JointKind kind : {JointKind::OnAxis, JointKind::ToPoint}) {
      Joint joint;
      joint.kind = kind;
      joint.part = id("Peg \xC3\xA4");
      joint.base = id("Block");
      joint.onPart.point = {0.1 + 0.2, 0.0, -1e-17};
      session_.addJoint(joint, {});
    }
    session_.setPairRecords({{{id("Block"), id("Loose")}, PairVerdict::Clash, 0.0, 1.0 / 3.0, {}, {}},
                             {{id("Pin"), id("Loose")}, PairVerdict::Near, 0.1, {}, {}, {}}});
  }

  PartId id(const char* name) const { return session_.scene().findByName(name)->id; }
  GroupId groupId(const std::string& name) const {
    for (const Scene::GroupPtr& group : session_.scene().groups())
      if (group->name == name) return group->id;
    throw UsageError(name, "there is no such group");
  }
  std::string textOf(const Session& session) const {
    return sceneFileText(session.scene(), folder_.path() / "out.nearfit");
  }

  /// The commands of the script, without its head.
  std::vector<ScriptJson> lines() const {
    std::vector<ScriptJson> all;
    for (const SessionScript::Line& line : readScript(script_).lines)
      all.push_back(ScriptJson::parse(line.text));
    return all;
  }
  void expectSameAfterReplay() const {
    const SessionScript script = readScript(script_);
    Session other;
    other.reset(startOf(script));
    replay(script, other);
    EXPECT_EQ(textOf(other), textOf(session_));
  }

  test::TemporaryFolder folder_;
  test::FakeImporter importer_;
  fs::path script_ = folder_.path() / "session.jsonl";
  Session session_;
  ScriptRecorder recorder_{session_};
  Subscription changes_;
};

using Act = std::function<void()>;

class EachStep : public ScriptTest {
 protected:
  /// Steps of each kind, by its name in scripts, for the scene that fill() makes.
  std::map<std::string, std::vector<Act>> acts() {
    const auto peg = [this] { return id("Peg \xC3\xA4"); };
    const auto frame = [this] { return session_.scene().groups().front()->id; };
    const auto second = [this] { return session_.scene().groups().back()->id; };
    const auto joints = [this] {
      std::vector<JointId> all;
      for (const Joint& joint : session_.scene().joints())
        all.push_back(joint.id);
      return all;
    };
    HapticSettings haptics;
    haptics.springs.cutoff = 0.1 + 0.2;
    haptics.mode = HapticMode::Springs;
    Joint joint;
    joint.kind = JointKind::InPlane;
    return {
        {"add",
         {[this] { session_.addPart(block(), "Block", kTurned); },
          [this] {
            const PartGeometryPtr shared = block();
            session_.addNodes({{{"Frame", {}}, {"In it", 0}},
                               {{shared, "New", kTurned, Colour{0.1F, 0.2F, 0.3F}, 1},
                                {shared, "New", {}, {}, {}},
                                {pin({1e-4, 0.2}), "Fine", {}, {}, 0}}});
          }}},
        {"delete", {[=, this] { session_.deleteNodes({{id("Block")}, {second()}}); }}},
        {"duplicate", {[=, this] { session_.duplicate({{id("Block")}, {frame()}}); }}},
        {"renamePart", {[=, this] { session_.renamePart(peg(), "Peg \"2\"\\"); }}},
        {"renameGroup", {[=, this] { session_.renameGroup(second(), "Other"); }}},
        {"move",
         {[=, this] { session_.movePart(peg(), kTurned); },
          [=, this] {
            session_.moveParts({id("Block"), id("Loose")}, id("Loose"),
                               {glm::normalize(glm::dquat(0.3, 0.1, -0.7, 0.2)), {1e-300, 0.1, 1.0 / 3.0}},
                               "Drop");
          }}},
        {"colour", {[=, this] { session_.setColour({peg(), id("Block")}, {0.1F, 1.0F / 3.0F, 0.7F}); }}},
        {"opacity", {[=, this] { session_.setOpacity({peg()}, 0.1 + 0.2); }}},
        {"density", {[=, this] { session_.setDensity(peg(), 7850.1); }}},
        {"visible", {[=, this] { session_.setVisible({peg(), id("Pin")}, false); }}},
        {"pivot",
         {[=, this] { session_.setPivots({{peg(), glm::dvec3(0.1 + 0.2, 0, -1e-17)}, {id("Pin"), {}}}); }}},
        {"reload", {[this] { session_.reloadParts({{id("Block"), block()}}); }}},
        {"repair", {[this] {
           session_.repairParts(
               {{id("Block"), load({"block.obj", 0.001, {}, {}, {}, {{RepairKind::Weld, 1e-5}}})}});
         }}},
        {"unit", {[this] { session_.rescaleParts({{id("Block"), block(0.0254)}}); }}},
        {"refine", {[this] { session_.refineParts({{id("Pin"), pin({1e-4, 0.1})}}); }}},
        {"isolate", {[=, this] { session_.isolate({peg()}); }}},
        {"endIsolation", {[=, this] {
           session_.isolate({peg()});
           session_.endIsolation();
         }}},
        {"lock",
         {[=, this] { session_.setLocked({{peg()}, {second()}}, true); },
          [this] {
            session_.setLocked(id("Block"), true);
            session_.setLocked(id("Block"), false);
          }}},
        {"group", {[=, this] { session_.group({{id("Block")}, {frame()}}, "Frame"); }}},
        {"ungroup", {[=, this] { session_.ungroup({frame(), second()}); }}},
        {"regroup",
         {[=, this] { session_.regroup({{id("Block")}, {frame()}}, second()); },
          [=, this] { session_.regroup({{peg()}, {}}, std::nullopt); }}},
        {"addJoint", {[=, this]() mutable {
           joint.part = id("Loose");
           session_.addJoint(joint, kTurned);
         }}},
        {"removeJoints", {[=, this] { session_.removeJoints({joints().back()}); }}},
        {"jointsOn", {[=, this] { session_.setJointsOn(joints(), false); }}},
        {"rules", {[this] {
           session_.setPairRules({{PairRuleKind::PressFit, "Blo*", "Pin", 2e-5}, {PairRuleKind::SameGroup}});
         }}},
        {"records", {[this] {
           session_.setPairRecords(
               {{{id("Block"), id("Pin")}, PairVerdict::Touching, 1e-9, {}, FindingState::Accepted, "so"}});
         }}},
        {"finding", {[this] {
           session_.setFindingState({{id("Block"), id("Loose")}}, FindingState::Accepted, "pressed in");
         }}},
        {"movingPart",
         {[=, this] { session_.setMovingPart(peg()); },
          [=, this] {
            session_.setMovingPart(peg());
            session_.setMovingPart(std::nullopt);
          }}},
        {"movingGroup", {[=, this] { session_.setMovingGroup(second()); }}},
        {"haptics", {[=, this] { session_.setHaptics(haptics, "Preset \xE2\x80\x9Csoft\xE2\x80\x9D"); }}},
    };
  }
};

template <std::size_t... Index>
std::vector<std::string> namesOf(std::index_sequence<Index...>) {
  return {std::variant_alternative_t<Index, SessionCommand>::kName...};
}
std::vector<std::string> allNames() {
  return namesOf(std::make_index_sequence<std::variant_size_v<SessionCommand>>());
}

TEST_F(EachStep, HasANameOfItsOwnAndIsTriedHere) {
  const std::vector<std::string> names = allNames();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  const auto tried = acts();
  for (const std::string& name : names)
    EXPECT_TRUE(tried.contains(name)) << "no test records the command \"" << name << "\"";
  EXPECT_EQ(tried.size(), names.size());
}

TEST_F(EachStep, IsRecordedAndReplayedToTheSameScene) {
  for (const auto& [name, variants] : acts()) {
    for (std::size_t i = 0; i < variants.size(); ++i) {
      SCOPED_TRACE(name + " " + std::to_string(i));
      recorder_.drop();
      session_.reset();
      fill();
      const std::string before = textOf(session_);
      recorder_.start(script_);
      variants[i]();
      const std::vector<Session::Step> steps = session_.history();
      recorder_.stop();
      const std::vector<ScriptJson> recorded = lines();
      ASSERT_FALSE(recorded.empty());
      EXPECT_EQ(recorded.back().at("do"), name);
      // What does and undoes something, and what reads the same file, comes back to the same scene.
      EXPECT_EQ(textOf(session_) == before, name == "reload" || recorded.size() == 2);
      expectSameAfterReplay();

      const SessionScript script = readScript(script_);
      Session other;
      other.reset(startOf(script));
      replay(script, other);
      // Findings are no step.
      if (name != "records") {
        EXPECT_EQ(other.history().back().label, steps.back().label);
      }
    }
  }
}

TEST_F(EachStep, IsWrittenTheSameAfterItWasRead) {
  fill();
  recorder_.start(script_);
  session_.movePart(id("Block"), kTurned);
  recorder_.stop();
  const SessionScript script = readScript(script_);
  const ScriptJson json = ScriptJson::parse(script.lines.front().text);
  const SessionCommand command = readCommand(JsonField(json, script_), session_.scene(), meshFolder(script_));
  EXPECT_EQ(commandJson(command, session_.scene(), script_).dump(), script.lines.front().text);
}

TEST_F(ScriptTest, TheGuideHasAnExampleOfEachCommandThatWorks) {
  const std::string guide = test::readBytes(test::sourceFolder() / "resources/docs/scripts.md");
  std::string text = "{\"nearfitScript\": 1}\n";
  std::set<std::string> shown;
  for (std::size_t at = 0; (at = guide.find("\n    {\"do\"", at)) != std::string::npos; ++at) {
    const std::string line = guide.substr(at + 1, guide.find('\n', at + 1) - at - 1);
    shown.insert(ScriptJson::parse(line).at("do"));
    text += line + "\n";
  }
  const std::vector<std::string> names = allNames();
  EXPECT_EQ(shown, std::set<std::string>(names.begin(), names.end()));
  EXPECT_NO_THROW(replay(readScript(folder_.write("guide.jsonl", text)), session_));
}

TEST_F(ScriptTest, FromAnEmptySceneNeedsNoSceneFile) {
  recorder_.start(script_);
  fill();
  recorder_.stop();
  EXPECT_FALSE(readScript(script_).scene);
  EXPECT_FALSE(fs::exists(ScriptRecorder::startFileOf(script_)));
  expectSameAfterReplay();
}

TEST_F(ScriptTest, TheStartIsKeptWhenTheSceneIsSavedMeanwhile) {
  fill();
  session_.save(folder_.path() / "own.nearfit");
  recorder_.start(script_);
  session_.deletePart(id("Pin"));
  session_.save(folder_.path() / "own.nearfit");
  recorder_.stop();
  EXPECT_TRUE(readScript(script_).scene);
  expectSameAfterReplay();
}

TEST_F(ScriptTest, StepsThatWereUndoneAreLeftOut) {
  fill();
  recorder_.start(script_);
  session_.renamePart(id("Block"), "One");
  session_.renamePart(id("One"), "Two");
  session_.undo();
  session_.renamePart(id("One"), "Three");
  session_.undo();
  session_.redo();
  EXPECT_EQ(recorder_.steps(), 2U);
  recorder_.stop();
  const std::vector<ScriptJson> recorded = lines();
  ASSERT_EQ(recorded.size(), 2U);
  EXPECT_EQ(recorded[1].at("name"), "Three");
  expectSameAfterReplay();
}

TEST_F(ScriptTest, UndoneBeyondItsStartItStartsThere) {
  fill();
  recorder_.start(script_);
  session_.renamePart(id("Block"), "One");
  session_.goTo(session_.historyIndex() - 4);
  session_.renamePart(id("Loose"), "Two");
  recorder_.stop();
  EXPECT_EQ(lines().size(), 1U);
  expectSameAfterReplay();
}

std::size_t countOf(const std::vector<ScriptJson>& recorded, const char* name) {
  return static_cast<std::size_t>(
      std::ranges::count_if(recorded, [&](const ScriptJson& line) { return line.at("do") == name; }));
}

/// Each check left a line of all records: ten checks of a large scene made a script too large to be read.
TEST_F(ScriptTest, OfManyChecksTheScriptKeepsWhatLaterLinesRead) {
  fill();
  recorder_.start(script_);
  const PartPair pair{id("Block"), id("Loose")};
  const auto check = [&](double distance) {
    session_.setPairRecords({{pair, PairVerdict::Near, distance, {}, {}, {}}});
  };
  for (int i = 1; i <= 5; ++i) {
    session_.movePart(id("Block"), {{1, 0, 0, 0}, {0, 0, 1.0 * i}});
    check(0.1 * i);
  }
  session_.renamePart(id("Pin"), "Bolt");
  // It reads the records of the fifth check.
  session_.setFindingState({pair}, FindingState::Accepted, "so");
  for (int i = 6; i <= 9; ++i) {
    session_.movePart(id("Block"), {{1, 0, 0, 0}, {0, 0, 1.0 * i}});
    check(0.1 * i);
  }
  recorder_.stop();
  const std::vector<ScriptJson> recorded = lines();
  EXPECT_EQ(countOf(recorded, "move"), 9U);
  ASSERT_EQ(countOf(recorded, "records"), 2U);
  EXPECT_EQ(recorded[5].at("do"), "records");
  EXPECT_EQ(recorded[5].at("records").at(0).at("distance"), 0.1 * 5);
  EXPECT_EQ(recorded[7].at("do"), "finding");
  EXPECT_EQ(recorded.back().at("records").at(0).at("distance"), 0.1 * 9);
  expectSameAfterReplay();
}

TEST_F(ScriptTest, RecordsThatWereLeftOutComeBackWhenTheLaterOnesAreUndone) {
  fill();
  recorder_.start(script_);
  const PartPair pair{id("Block"), id("Loose")};
  session_.renamePart(id("Pin"), "Bolt");
  session_.setPairRecords({{pair, PairVerdict::Near, 0.25, {}, {}, {}}});
  session_.renamePart(id("Bolt"), "Screw");
  session_.renamePart(id("Screw"), "Nail");
  session_.setPairRecords({{pair, PairVerdict::Near, 0.5, {}, {}, {}}});
  session_.undo();
  session_.undo();
  session_.redo();
  session_.undo();
  session_.renamePart(id("Bolt"), "Rivet");
  session_.setFindingState({pair}, FindingState::Accepted, "so");
  recorder_.stop();
  EXPECT_EQ(countOf(lines(), "records"), 1U);
  expectSameAfterReplay();
}

/// At the start too, which has no command.
TEST_F(ScriptTest, RecordsOfTheStartThatWereLeftOutComeBack) {
  fill();
  recorder_.start(script_);
  session_.setPairRecords({{{id("Block"), id("Loose")}, PairVerdict::Near, 0.25, {}, {}, {}}});
  session_.renamePart(id("Pin"), "Bolt");
  session_.setPairRecords({});
  session_.undo();
  recorder_.stop();
  ASSERT_EQ(session_.scene().pairRecords().size(), 1U);
  EXPECT_EQ(countOf(lines(), "records"), 1U);
  expectSameAfterReplay();
}

/// A recording that no reader would take is refused before anything is written, and nothing is lost.
TEST_F(ScriptTest, ARecordingBeyondTheLimitsIsRefusedAndGoesOn) {
  const std::vector<std::pair<ScriptLimits, const char*>> limits = {
      {ScriptLimits{.maxLines = 3}, "3 lines"},
      {ScriptLimits{.maxBytes = 200}, "200 bytes"},
      {ScriptLimits{.maxLineBytes = 60}, "60 bytes in a line"}};
  for (const auto& [limit, words] : limits) {
    SCOPED_TRACE(words);
    session_.reset();
    session_.addPart(block(), "Block");
    fs::remove(ScriptRecorder::startFileOf(script_));
    ScriptRecorder recorder(session_, limit);
    const Subscription changes =
        session_.onChange(SceneEvents::Stage::Panels, [&recorder] { recorder.follow(); });
    recorder.start(script_);
    session_.renamePart(id("Block"), "Base");
    session_.renamePart(id("Base"), "Bed");
    session_.renamePart(id("Bed"), "A name that makes the third line longer than the first two of them");
    try {
      recorder.stop();
      ADD_FAILURE() << "it was written";
    } catch (const UsageError& e) {
      EXPECT_EQ(e.where(), script_.string());
      EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
      EXPECT_FALSE(e.remedy().empty());
    }
    EXPECT_TRUE(recorder.isRecording());
    EXPECT_EQ(lines().size(), 0U);
    EXPECT_FALSE(fs::exists(ScriptRecorder::startFileOf(script_)));
    // The remedy that it names.
    session_.undo();
    recorder.stop();
    EXPECT_EQ(lines().size(), 2U);
    expectSameAfterReplay();
  }
}

TEST_F(ScriptTest, AFileBeyondTheLimitIsRefused) {
  folder_.write("session.jsonl", scriptHead({}) + "\n");
  EXPECT_NO_THROW(readScript(script_));
  fs::resize_file(script_, kMaxScriptBytes + 1);
  try {
    readScript(script_);
    FAIL() << "it was taken";
  } catch (const FileError& e) {
    EXPECT_NE(std::string(e.what()).find("larger than"), std::string::npos) << e.what();
  }
}

/// A line that loads told nothing until it was done, and could not be stopped.
TEST_F(ScriptTest, ALineThatLoadsTellsItsProgressAndCanBeStopped) {
  folder_.write("session.jsonl",
                scriptHead({}) +
                    "\n"
                    R"({"do": "group", "parts": [], "name": "G"})"
                    "\n"
                    R"({"do": "add", "files": [{"mesh": "meshes/vise.step", "metresPerUnit": 1, )"
                    R"("shape": {"key": "pin", "chord": 0.00017, "angle": 0.1}}], "parts": []})"
                    "\n");
  const SessionScript script = readScript(script_);
  std::vector<double> told;
  const auto replayUntil = [&](std::size_t calls) {
    told.clear();
    session_.reset();
    replay(script, session_, [&](double fraction) {
      told.push_back(fraction);
      return told.size() < calls;
    });
  };
  // The third call comes while the second line loads.
  EXPECT_THROW(replayUntil(3), Cancelled);
  ASSERT_GE(told.size(), 3U);
  EXPECT_EQ(told[0], 0.0);
  EXPECT_EQ(told[1], 0.5);
  EXPECT_EQ(session_.scene().groups().size(), 1U);
  replayUntil(1000);
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_GE(told.front(), 0.0);
  EXPECT_LE(told.back(), 1.0);
}

TEST_F(ScriptTest, GroupsAreNamedWithTheirNumbersAndOneThatIsNotThereIsRefused) {
  std::vector<GroupId> groups;
  for (int i = 0; i < 200; ++i)
    groups.push_back(session_.group({}, i % 2 == 0 ? "Even" : "Odd"));
  for (std::size_t i = 0; i < groups.size(); ++i)
    session_.renameGroup(groups[i], i % 2 == 0 ? "Even" : "Odd");
  const auto json = commandJson(steps::Ungroup{groups}, session_.scene(), script_);
  ASSERT_EQ(json.at("groups").size(), groups.size());
  EXPECT_EQ(json.at("groups").at(1), "Odd");
  EXPECT_EQ(json.at("groups").at(199).at("name"), "Odd");
  EXPECT_EQ(json.at("groups").at(199).at("number"), 100);
  session_.ungroup({groups.front()});
  EXPECT_THROW(commandJson(steps::Ungroup{{groups.front()}}, session_.scene(), script_), UsageError);
}

/// The records of the state that redo leads to are older than those of the state before it.
TEST_F(ScriptTest, RecordsAreThoseOfTheStateThatRedoLeadsTo) {
  fill();
  recorder_.start(script_);
  session_.renamePart(id("Loose"), "One");
  session_.undo();
  session_.setPairRecords({});
  session_.redo();
  EXPECT_FALSE(session_.scene().pairRecords().empty());
  recorder_.stop();
  expectSameAfterReplay();
}

TEST_F(ScriptTest, AnotherSceneEndsTheRecording) {
  fill();
  recorder_.start(script_);
  session_.renamePart(id("Block"), "One");
  const std::string before = textOf(session_);
  session_.reset();
  session_.addPart(block(), "Elsewhere");
  EXPECT_TRUE(recorder_.endsHere());
  recorder_.stop();
  const SessionScript script = readScript(script_);
  Session other;
  other.reset(startOf(script));
  replay(script, other);
  EXPECT_EQ(textOf(other), before);
}

TEST_F(ScriptTest, TheFileOfTheOpenSceneIsNotReplaced) {
  const fs::path own = ScriptRecorder::startFileOf(script_);
  session_.addPart(block(), "Block");
  session_.save(own);
  EXPECT_THROW(recorder_.start(script_), UsageError);
  EXPECT_FALSE(recorder_.isRecording());
}

TEST_F(ScriptTest, ASceneThatWasSavedWhereTheStartGoesIsNotReplaced) {
  session_.addPart(block(), "Block");
  recorder_.start(script_);
  session_.renamePart(id("Block"), "Base");
  session_.save(ScriptRecorder::startFileOf(script_));
  EXPECT_THROW(recorder_.stop(), UsageError);
  EXPECT_TRUE(recorder_.isRecording()) << "nothing is lost";
  EXPECT_EQ(
      sceneFileText(readSceneFile(ScriptRecorder::startFileOf(script_)), folder_.path() / "out.nearfit"),
      textOf(session_));
  session_.save(folder_.path() / "elsewhere.nearfit");
  recorder_.stop();
  expectSameAfterReplay();
}

TEST_F(ScriptTest, ASceneThatIsThereAlreadyIsNotReplacedByTheStart) {
  folder_.write(ScriptRecorder::startFileOf(script_).filename().string(), "somebody's");
  session_.addPart(block(), "Block");
  EXPECT_THROW(recorder_.start(script_), UsageError);
  EXPECT_FALSE(fs::exists(script_));
  // With its script it is a recording's own.
  folder_.write(script_.filename().string(), "a former recording");
  EXPECT_NO_THROW(recorder_.start(script_));
}

TEST_F(ScriptTest, ARuleThatBreaksOffIsRefused) {
  fill();
  const std::string head = scriptHead({}) + "\n";
  // Longer than a string keeps within itself: what was read before the fault is freed once.
  folder_.write("session.jsonl", head + R"({"do":"rules","rules":[{"kind":"touching","part":")" +
                                     std::string(64, 'x') + R"("}]})" + "\n");
  EXPECT_THROW(replay(readScript(script_), session_), FileError);
}

/// Ages of groups once got lost in scene files, and with them the order of groups that come to stand side by side.
TEST_F(ScriptTest, AGroupThatIsYoungerThanItsMembersKeepsItsPlace) {
  session_.addPart(block(), "Block");
  const GroupId a = session_.group({}, "A"), b = session_.group({}, "B"), c = session_.group({}, "C");
  session_.regroup({{}, {a}}, c);
  recorder_.start(script_);
  session_.regroup({{}, {a}}, std::nullopt);
  session_.regroup({{id("Block")}, {}}, b);
  recorder_.stop();
  expectSameAfterReplay();
}

/// Commands by chance, with undo and redo among them.
class RandomSession : public ScriptTest, public ::testing::WithParamInterface<unsigned> {
 protected:
  std::size_t below(std::size_t count) { return count == 0 ? 0 : random_() % count; }
  double number() { return static_cast<double>(random_()) / 4294967296.0 - 0.5; }
  PartId anyPart() {
    const auto& parts = session_.scene().parts();
    return parts.empty() ? PartId{0} : parts[below(parts.size())]->id;
  }
  GroupId anyGroup() {
    const auto& groups = session_.scene().groups();
    return groups.empty() ? GroupId{0} : groups[below(groups.size())]->id;
  }
  RigidTransform pose() {
    return {glm::normalize(glm::dquat(number() + 1.0, number(), number(), number())),
            {number(), number(), number()}};
  }

  void act() {
    switch (below(22)) {
      case 0:
        session_.undo();
        break;
      case 1:
        session_.redo();
        break;
      case 2:
        session_.goTo(below(session_.history().size()));
        break;
      case 3:
        session_.addPart(block_, "Block", pose());
        break;
      case 4:
        session_.duplicate({{anyPart()}, {anyGroup()}});
        break;
      case 5:
        if (session_.scene().parts().size() > 12) session_.deleteNodes({{anyPart()}, {}});
        break;
      case 6:
        session_.renamePart(anyPart(), "Part " + std::to_string(below(8)));
        break;
      case 7: {
        const PartId lead = anyPart();
        session_.moveParts({anyPart(), lead}, lead, pose());
        break;
      }
      case 8:
        session_.setColour(anyPart(), {float(number() + 0.5), 0.1F, 0.7F});
        break;
      case 9:
        session_.group({{anyPart()}, {anyGroup()}}, "Frame");
        break;
      case 10:
        session_.regroup({{anyPart()}, {anyGroup()}}, anyGroup());
        break;
      case 11:
        session_.regroup({{}, {anyGroup()}}, std::nullopt);
        break;
      case 12:
        session_.ungroup({anyGroup()});
        break;
      case 13:
        session_.setLocked({{anyPart()}, {}}, below(2) == 0);
        break;
      case 14:
        session_.isolate({anyPart(), anyPart()});
        break;
      case 15:
        session_.endIsolation();
        break;
      case 16: {
        const PartId a = anyPart(), b = anyPart();
        session_.setPairRecords(
            {{{std::min(a, b), std::max(a, b)}, PairVerdict::Near, 1.0 + number(), {}, {}, {}}});
        break;
      }
      case 17:
        session_.setMovingGroup(anyGroup());
        break;
      case 18: {
        Joint joint;
        joint.part = anyPart();
        joint.onPart.point = {number(), number(), number()};
        session_.addJoint(joint, pose());
        break;
      }
      case 19:
      case 20: {
        const auto& records = session_.scene().pairRecords();
        if (!records.empty())
          session_.setFindingState({records[below(records.size())].pair},
                                   below(2) == 0 ? FindingState::Accepted : FindingState::New, "so");
        break;
      }
      default:
        session_.renameGroup(anyGroup(), "Frame");
        break;
    }
  }

  std::mt19937 random_{GetParam()};
  PartGeometryPtr block_;
};

TEST_P(RandomSession, IsReplayedToTheSameScene) {
  block_ = block();
  fill();
  for (int round = 0; round < 4; ++round) {
    recorder_.start(script_);
    for (int i = 0; i < 80; ++i) {
      try {
        act();
      } catch (const UsageError&) {
        // Chance asks for what cannot be done, too.
      }
    }
    recorder_.stop();
    expectSameAfterReplay();
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomSession, ::testing::Range(1U, 7U));

/// A line of a script that is refused.
struct Refused {
  const char* line;
  const char* words;  ///< In the message.
};

class RefusedLine : public ScriptTest, public ::testing::WithParamInterface<Refused> {};

TEST_P(RefusedLine, LeavesTheSceneAsBeforeIt) {
  fill();
  session_.setLocked(id("Loose"), true);
  const fs::path file = folder_.write("bad.jsonl", std::string("{\"nearfitScript\": 1}\n\n") +
                                                       R"({"do": "renamePart", "part": "Block", "name": "B"})"
                                                       "\n" +
                                                       GetParam().line + "\n" +
                                                       R"({"do": "renamePart", "part": "B", "name": "C"})"
                                                       "\n");
  Session expected;
  expected.reset(session_.scene());
  expected.renamePart(id("Block"), "B");
  try {
    replay(readScript(file), session_);
    FAIL() << "it was taken";
  } catch (const FileError& e) {
    EXPECT_TRUE(e.where().starts_with(file.string() + ":4")) << e.where();
    EXPECT_NE(std::string(e.what()).find(GetParam().words), std::string::npos) << e.what();
    EXPECT_FALSE(e.remedy().empty());
  }
  EXPECT_EQ(textOf(session_), textOf(expected));
}

INSTANTIATE_TEST_SUITE_P(
    Lines, RefusedLine,
    ::testing::Values(
        Refused{"{", "not valid JSON"}, Refused{"[]", "an object is expected"},
        Refused{"{}", "it is missing"}, Refused{R"({"do": "undo"})", "there is no command"},
        Refused{R"({"do": "renamePart", "part": "B", "part": "B", "name": "C"})", "twice"},
        Refused{R"({"do": "renamePart", "part": "Nobody", "name": "C"})", "there is no part \"Nobody\""},
        Refused{R"({"do": "renamePart", "part": "B", "name": "Pin"})", "Pin"},
        Refused{R"({"do": "renamePart", "part": "B", "name": ""})", "empty"},
        Refused{R"({"do": "renameGroup", "group": {"name": "Frame", "number": 3}, "name": "C"})", "number 3"},
        Refused{R"({"do": "renameGroup", "group": {"name": "Frame", "number": 0}, "name": "C"})",
                "count from 1"},
        Refused{R"({"do": "renameGroup", "group": {"name": "Frame", "number": 1e300}, "name": "C"})",
                "1e+300"},
        Refused{R"({"do": "opacity", "parts": ["B"], "opacity": 1e999})", "not valid JSON"},
        Refused{R"({"do": "opacity", "parts": ["B"], "opacity": 7})", "out of range"},
        Refused{R"({"do": "colour", "parts": ["B"], "colour": [0, 0]})", "3 are expected"},
        Refused{R"({"do": "density", "parts": ["B", "Loose"], "density": 2})", "locked"},
        Refused{
            R"({"do": "move", "parts": ["B"], "lead": "Pin", "position": [0, 0, 0], "quaternion": [1, 0, 0, 0]})",
            "not one of"},
        Refused{
            R"({"do": "move", "parts": ["B"], "lead": "B", "position": [0, 0, 1e10], "quaternion": [1, 0, 0, 0]})",
            "out of range"},
        Refused{
            R"({"do": "move", "parts": ["B"], "lead": "B", "position": [0, 0, 0], "quaternion": [2, 0, 0, 0]})",
            "length is 2"},
        Refused{R"({"do": "add", "files": [], "parts": [{"name": "N", "file": 0}]})", "0 is not the number"},
        Refused{R"({"do": "add", "files": [{"mesh": "no.obj", "metresPerUnit": 1}], "parts": []})",
                "is missing"},
        Refused{R"({"do": "add", "files": [{"mesh": "bad.jsonl", "metresPerUnit": 1}], "parts": []})",
                "bad.jsonl"},
        Refused{R"({"do": "add", "files": [{"mesh": "meshes/peg.obj", "metresPerUnit": 0}], "parts": []})",
                "out of range"},
        Refused{
            R"({"do": "add", "files": [{"mesh": "meshes/peg.obj", "metresPerUnit": 1}], "groups": [{"name": "G", "parent": 0}], "parts": []})",
            "earlier groups"},
        Refused{R"({"do": "removeJoints", "joints": [{"part": "B", "number": 1}]})", "joints of the part"},
        Refused{R"({"do": "finding", "pairs": [{"part": "B", "other": "B"}], "state": "new"})", "same part"},
        Refused{R"({"do": "regroup", "parts": [], "groups": ["Frame"], "target": "Inner"})",
                "contain itself"}));

TEST_F(ScriptTest, AHeadThatIsNotOneOfOursIsRefused) {
  const std::pair<const char*, const char*> heads[] = {
      {"", "it is empty"},
      {"\n \n", "it is empty"},
      {"{\"do\": \"endIsolation\"}\n", "nearfitScript"},
      {"{\"nearfitScript\": 2}\n", "version 2"},
      {"{\"nearfitScript\": 1, \"scene\": \"\"}\n", "it is empty"},
      {"{\"nearfitScript\": \"1\"}\n", "a number is expected"},
  };
  for (const auto& [text, words] : heads) {
    const fs::path file = folder_.write("head.jsonl", text);
    try {
      readScript(file);
      ADD_FAILURE() << "it was taken: " << text;
    } catch (const FileError& e) {
      EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
      EXPECT_FALSE(e.remedy().empty()) << e.what();
    }
  }
}

TEST_F(ScriptTest, DuplicatesDoNotOutgrowASceneFile) {
  std::string text = "{\"nearfitScript\": 1}\n";
  text += R"({"do": "add", "files": [{"mesh": "meshes/peg.obj", "metresPerUnit": 1}], "parts": [)"
          R"({"name": "A", "file": 0, "group": 0}, {"name": "B", "file": 0, "group": 0}, )"
          R"({"name": "C", "file": 0, "group": 0}], "groups": [{"name": "G"}]})"
          "\n";
  // Each puts the group and a copy of it into a new one: the parts double.
  for (int i = 0; i < 20; ++i) {
    text += R"({"do": "duplicate", "groups": ["G"]})"
            "\n";
    text += R"({"do": "group", "groups": ["G", "G 2"], "name": "H"})"
            "\n";
    text += R"({"do": "renameGroup", "group": "G", "name": "g"})"
            "\n";
    text += R"({"do": "renameGroup", "group": "G 2", "name": "g"})"
            "\n";
    text += R"({"do": "renameGroup", "group": "H", "name": "G"})"
            "\n";
  }
  const fs::path file = folder_.write("many.jsonl", text);
  try {
    replay(readScript(file), session_);
    FAIL() << session_.scene().parts().size();
  } catch (const FileError& e) {
    EXPECT_NE(std::string(e.what()).find("more than 10000 parts"), std::string::npos) << e.what();
  }
  EXPECT_LE(session_.scene().parts().size(), 10'000U);
}

}  // namespace
}  // namespace nearfit::script_test
