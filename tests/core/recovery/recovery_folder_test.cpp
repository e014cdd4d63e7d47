#include "core/recovery/recovery_folder.h"

#include <fstream>
#include <set>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/session/session.h"
#include "tests/core/scene/scene_file_fixture.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/process_identity_of.h"

namespace nearfit::recovery_folder_test {
namespace {

namespace fs = std::filesystem;

/// A process that has died: no process has its id from now on until the system wraps around.
ProcessIdentity deadProcess() {
  const ::pid_t child = ::fork();
  if (child == 0) ::pause();
  ProcessIdentity dead = thisProcess();
  dead.pid = child;
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  return dead;
}

/// A process that has ended, and whose parent has not asked how.
class Zombie {
 public:
  Zombie() : child_(::fork()) {
    if (child_ == 0) ::pause();
    identity_ = test::identityOf(child_);
    ::kill(child_, SIGKILL);
    // Until it has ended, and without taking it away.
    ::siginfo_t ended{};
    ::waitid(P_PID, static_cast<::id_t>(child_), &ended, WEXITED | WNOWAIT);
  }
  ~Zombie() { ::waitpid(child_, nullptr, 0); }
  Zombie(const Zombie&) = delete;
  Zombie& operator=(const Zombie&) = delete;

  const ProcessIdentity& identity() const { return identity_; }

 private:
  ::pid_t child_;
  ProcessIdentity identity_;
};

class RecoveryFolderTest : public test::SceneFileFixture {
 protected:
  /// What a process that died had written.
  void writeAsDead(const JournalHead& head, const Scene& scene) {
    RecoveryFolder(state_, deadProcess()).write(scene, head);
  }
  void writeAsDead(const JournalHead& head) { writeAsDead(head, movedScene()); }

  Scene movedScene() const {
    Scene scene = scene_;
    Part part = *scene.findByName("Peg");
    part.worldFromPart = {glm::normalize(glm::dquat(0.1, 0.2, 0.3, 0.4)), {0.1 + 0.2, -1e-300, 1.0 / 3.0}};
    scene.replace(part);
    return scene;
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> names;
    if (!fs::exists(state_)) return names;
    for (const auto& entry : fs::directory_iterator(state_))
      names.push_back(entry.path());
    return names;
  }
  void setAge(const fs::path& file, std::chrono::hours age) {
    fs::last_write_time(file, fs::file_time_type::clock::now() - age);
  }

  fs::path state_ = folder_.path() / "state" / "recovery";
};

TEST(ProcessIdentity, TellsThisProcessFromOthersOfItsId) {
  const ProcessIdentity self = thisProcess();
  EXPECT_TRUE(isRunning(self));
  EXPECT_EQ(processFromText(textOf(self)), self);
  ProcessIdentity earlier = self;
  --earlier.start;
  EXPECT_FALSE(isRunning(earlier)) << "the id was given again";
  ProcessIdentity beforeBoot = self;
  beforeBoot.boot = self.boot == "00000000" ? "11111111" : "00000000";
  EXPECT_FALSE(isRunning(beforeBoot));
  EXPECT_FALSE(isRunning(deadProcess()));
  for (const char* text : {"", "scene", "0f3a9c12-1", "0f3a9c12-x-1", "0f3a9c1z-1-1", "0f3a9c12-0-1"})
    EXPECT_FALSE(processFromText(text)) << text;
}

// Who starts it anew at once after it was killed may be there before the parent has asked how it ended.
TEST(ProcessIdentity, AZombieDoesNotRun) {
  EXPECT_FALSE(isRunning(Zombie().identity()));
}

TEST_F(RecoveryFolderTest, WorkOfAZombieIsFound) {
  const Zombie zombie;
  RecoveryFolder(state_, zombie.identity()).write(movedScene(), {file_, 1, 0});
  const FoundWork found = RecoveryFolder(state_).takeLost();
  EXPECT_EQ(found.lost.size(), 1U);
  EXPECT_FALSE(found.areOthersRunning);
}

TEST_F(RecoveryFolderTest, SceneOfADeadProcessComesBackBitForBit) {
  const Scene moved = movedScene();
  writeAsDead({file_, 12, 0});
  const FoundWork found = RecoveryFolder(state_).takeLost();
  ASSERT_EQ(found.lost.size(), 1U);
  EXPECT_TRUE(found.damaged.empty());
  EXPECT_EQ(found.lost[0].head.scene, file_);
  EXPECT_EQ(found.lost[0].head.changes, 12U);
  EXPECT_EQ(found.lost[0].head.parts, 3U);
  const Scene read = readSceneFile(found.lost[0].journal);
  ASSERT_EQ(read.parts().size(), moved.parts().size());
  for (std::size_t i = 0; i < read.parts().size(); ++i) {
    const Part &a = *read.parts()[i], &b = *moved.parts()[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.worldFromPart.translation, b.worldFromPart.translation);
    EXPECT_EQ(a.worldFromPart.rotation, b.worldFromPart.rotation);
    EXPECT_EQ(a.colour, b.colour);
    EXPECT_EQ(a.isLocked, b.isLocked);
    EXPECT_EQ(a.geometry->sha256, b.geometry->sha256);
  }
  EXPECT_EQ(read.haptics(), moved.haptics());
}

TEST_F(RecoveryFolderTest, SceneThatWasNeverSavedIsFoundToo) {
  writeAsDead({{}, 3, 0});
  const FoundWork found = RecoveryFolder(state_).takeLost();
  ASSERT_EQ(found.lost.size(), 1U);
  EXPECT_TRUE(found.lost[0].head.scene.empty());
}

TEST_F(RecoveryFolderTest, WhatTheFileHoldsTooIsNotOfferedAndIsRemoved) {
  writeAsDead({file_, 1, 0}, scene_);
  EXPECT_TRUE(RecoveryFolder(state_).takeLost().lost.empty());
  EXPECT_TRUE(files().empty());
}

// Keys were kept in the file's order, which takes the square of their number: a sorted file is found equal only by
// sorted keys.
TEST_F(RecoveryFolderTest, TheOrderOfKeysInTheFileMakesNoDifference) {
  ASSERT_NE(json_.dump(), nlohmann::ordered_json::parse(test::readBytes(file_)).dump())
      << "a file as written has its keys in another order";
  folder_.write(file_.filename(), json_.dump());
  writeAsDead({file_, 1, 0}, scene_);
  EXPECT_TRUE(RecoveryFolder(state_).takeLost().lost.empty());
}

TEST_F(RecoveryFolderTest, WhatIsOlderThanTheFileIsNotOfferedButKeptAside) {
  writeAsDead({file_, 1, 0});
  setAge(files().front(), std::chrono::hours(1));
  EXPECT_TRUE(RecoveryFolder(state_).takeLost().lost.empty());
  ASSERT_EQ(files().size(), 1U);
  EXPECT_EQ(files().front().extension(), ".older");
  setAge(files().front(), RecoveryFolder::kKeptAside + std::chrono::hours(1));
  RecoveryFolder(state_).takeLost();
  EXPECT_TRUE(files().empty()) << "kept for a while, not for ever";
}

TEST_F(RecoveryFolderTest, HalfWrittenJournalsOfDeadProcessesAreSweptAndNothingElse) {
  writeAsDead({file_, 1, 0});
  const fs::path half = state_ / fmt::format(".nearfit-{}-7", deadProcess().pid);
  const fs::path discarded = state_ / "some.nearfit.discarded";
  for (const fs::path& file : {half, discarded}) {
    std::ofstream(file) << "{";
    setAge(file, std::chrono::hours(1));
  }
  EXPECT_EQ(RecoveryFolder(state_).takeLost().lost.size(), 1U);
  EXPECT_FALSE(fs::exists(half));
  EXPECT_TRUE(fs::exists(discarded));
  EXPECT_EQ(files().size(), 2U) << "the journal is there still";
}

TEST_F(RecoveryFolderTest, WorkOfAFileThatIsGoneIsOffered) {
  writeAsDead({file_, 1, 0}, scene_);
  fs::remove(file_);
  EXPECT_EQ(RecoveryFolder(state_).takeLost().lost.size(), 1U);
}

TEST_F(RecoveryFolderTest, JournalOfARunningProcessIsLeftAlone) {
  RecoveryFolder running(state_);
  running.write(movedScene(), {file_, 1, 0});
  const std::vector<fs::path> before = files();
  EXPECT_TRUE(RecoveryFolder(state_).takeLost().lost.empty());
  const FoundWork found = RecoveryFolder(state_, deadProcess()).takeLost();
  EXPECT_TRUE(found.lost.empty());
  EXPECT_TRUE(found.areOthersRunning) << "it may be about to end";
  EXPECT_EQ(files(), before);
  running.clear();
  EXPECT_TRUE(files().empty());
}

TEST_F(RecoveryFolderTest, OnlyOneOfTwoTakesALostSceneAndItsHeirLosesNothing) {
  writeAsDead({file_, 1, 0});
  RecoveryFolder first(state_, deadProcess()), second(state_);
  EXPECT_EQ(first.takeLost().lost.size(), 1U);
  // The first has died before its user answered.
  const FoundWork again = second.takeLost();
  ASSERT_EQ(again.lost.size(), 1U);
  EXPECT_TRUE(second.takeLost().lost.empty()) << "it is taken, and its taker runs";
  second.clear();
  EXPECT_TRUE(fs::exists(again.lost[0].journal)) << "a clean exit removes what is its own alone";
}

TEST_F(RecoveryFolderTest, DamagedJournalsAreToldAndKeptAside) {
  const auto damage = [&](const std::function<void(std::string&)>& change) {
    writeAsDead({file_, 1, 0});
    const fs::path journal = files().front();
    std::string text = test::readBytes(journal);
    const std::string before = text;
    change(text);
    ASSERT_NE(text, before);
    std::ofstream(journal) << text;
    const FoundWork found = RecoveryFolder(state_).takeLost();
    EXPECT_TRUE(found.lost.empty());
    ASSERT_EQ(found.damaged.size(), 1U);
    EXPECT_EQ(test::readBytes(found.damaged[0]), text) << "it may still be of use to somebody";
    fs::remove(found.damaged[0]);
  };
  damage([](std::string& text) { text.resize(text.size() / 2); });
  damage([](std::string& text) { text.clear(); });
  damage([](std::string& text) { text = "[1, 2]"; });
  damage([](std::string& text) { text[text.find("7850.1")] = '6'; });
  damage([](std::string& text) { text.replace(text.find("\"sha256\""), 8, "\"sha255\""); });
}

// Each that was put aside once took the place of the one before.
TEST_F(RecoveryFolderTest, EachOfSeveralJournalsPutAsideIsKept) {
  for (int i = 0; i < 5; ++i)
    writeAsDead({file_, 1, 0});
  for (const fs::path& journal : files())
    std::ofstream(journal) << "what is left of " << journal.filename().string();
  const FoundWork found = RecoveryFolder(state_).takeLost();
  EXPECT_EQ(found.damaged.size(), 5U);
  std::set<std::string> kept;
  for (const fs::path& journal : found.damaged)
    kept.insert(test::readBytes(journal));
  EXPECT_EQ(kept.size(), 5U);
  RecoveryFolder folder(state_);
  for (int i = 0; i < 3; ++i) {
    writeAsDead({file_, 1, 0});
    folder.discard(folder.takeLost().lost.at(0));
  }
  EXPECT_EQ(files().size(), 8U);
}

TEST_F(RecoveryFolderTest, FolderAndJournalAreTheUsersAlone) {
  RecoveryFolder(state_).write(scene_, {file_, 1, 0});
  const auto others = fs::perms::group_all | fs::perms::others_all;
  EXPECT_EQ(fs::status(state_).permissions() & others, fs::perms::none);
  EXPECT_EQ(fs::status(files().front()).permissions() & others, fs::perms::none);
}

TEST_F(RecoveryFolderTest, DiscardedWorkIsNotOfferedAgainButNotGone) {
  writeAsDead({file_, 1, 0});
  RecoveryFolder folder(state_);
  const FoundWork found = folder.takeLost();
  folder.discard(found.lost.at(0));
  EXPECT_TRUE(RecoveryFolder(state_, deadProcess()).takeLost().lost.empty());
  ASSERT_EQ(files().size(), 1U);
  EXPECT_EQ(files().front().extension(), ".discarded");
}

TEST_F(RecoveryFolderTest, FolderThatCannotBeMadeIsAnErrorThatSaysWhere) {
  const fs::path blocked = folder_.write("blocked", "a file") / "recovery";
  RecoveryFolder folder(blocked);
  EXPECT_TRUE(folder.takeLost().lost.empty());
  try {
    folder.write(scene_, {file_, 1, 0});
    FAIL();
  } catch (const FileError& error) {
    EXPECT_THAT(error.where(), testing::HasSubstr(blocked.string()));
  }
  folder.clear();
}

// A limit on the size of files stands in for a full disk.
TEST_F(RecoveryFolderTest, FullDiskKeepsTheLastJournalWhole) {
  RecoveryFolder folder(state_, deadProcess());
  folder.write(movedScene(), {file_, 7, 0});
  {
    const test::FileSizeLimit full(100);
    EXPECT_THROW(folder.write(scene_, {file_, 8, 0}), FileError);
  }
  const FoundWork found = RecoveryFolder(state_).takeLost();
  ASSERT_EQ(found.lost.size(), 1U);
  EXPECT_EQ(found.lost[0].head.changes, 7U);
  EXPECT_EQ(files().size(), 1U) << "nothing half written is left";
}

}  // namespace
}  // namespace nearfit::recovery_folder_test
