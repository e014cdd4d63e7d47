#include "core/files/atomic_write.h"

#include <atomic>
#include <chrono>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"
#include "tests/support/ended_process.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::atomic_write_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::ptrdiff_t entryCount(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(AtomicWrite, NewFileHoldsTheContentAndNothingElseIsLeft) {
  const test::TemporaryFolder folder;
  const std::string content("a\0b\r\n", 5);
  atomicWrite(folder.path() / "file", content);
  EXPECT_EQ(test::readBytes(folder.path() / "file"), content);
  EXPECT_EQ(entryCount(folder.path()), 1);
}

TEST(AtomicWrite, ExistingFileIsReplacedWithItsPermissions) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.write("file", "a longer text that was there before");
  ASSERT_EQ(::chmod(file.c_str(), 0640), 0);
  atomicWrite(file, "new");
  EXPECT_EQ(test::readBytes(file), "new");
  EXPECT_EQ(fs::status(file).permissions(),
            fs::perms::owner_read | fs::perms::owner_write | fs::perms::group_read);
}

TEST(AtomicWrite, SymbolicLinkStaysALink) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder.path() / "real");
  const fs::path file = folder.write("real/file", "old");
  fs::create_symlink("real/file", folder.path() / "link");
  atomicWrite(folder.path() / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(test::readBytes(file), "new");
}

TEST(AtomicWrite, LongestNamePossibleIsWritten) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / std::string(255, 'x');
  atomicWrite(file, "text");
  EXPECT_EQ(test::readBytes(file), "text");
}

TEST(AtomicWrite, RelativePathIsWritten) {
  const test::TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  atomicWrite("file", "text");
  fs::current_path(before);
  EXPECT_EQ(test::readBytes(folder.path() / "file"), "text");
}

TEST(AtomicWrite, MissingFolderAndFolderAsTargetAreRefusedByName) {
  const test::TemporaryFolder folder;
  for (const fs::path& file : {folder.path() / "missing" / "file", folder.path(), folder.path() / ""}) {
    try {
      atomicWrite(file, "text");
      FAIL() << file;
    } catch (const FileError& error) {
      EXPECT_THAT(error.where(), HasSubstr(folder.path().string()));
      EXPECT_FALSE(error.remedy().empty());
    }
  }
  EXPECT_EQ(entryCount(folder.path()), 0);
}

// A limit on the size of files stands in for a full disk.
TEST(AtomicWrite, FailedWriteLeavesTheOldFileWhole) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.write("file", "old");
  rlimit before = {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  const rlimit small = {1000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  bool threw = false;
  try {
    atomicWrite(file, std::string(5000, 'x'));
  } catch (const FileError&) {
    threw = true;
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  EXPECT_TRUE(threw);
  EXPECT_EQ(test::readBytes(file), "old");
  EXPECT_EQ(entryCount(folder.path()), 1);
}

// A limit on the size of files is not a full disk: the remedy is another one.
TEST(AtomicWrite, LimitOnTheSizeOfFilesIsNamed) {
  const test::TemporaryFolder folder;
  const test::FileSizeLimit small(1000);
  try {
    atomicWrite(folder.path() / "file", std::string(5000, 'x'));
    FAIL() << "no error";
  } catch (const FileError& error) {
    EXPECT_THAT(error.remedy(), HasSubstr("ulimit"));
  }
}

/// Returns the message with which writing to a path is refused; empty if it is allowed.
std::string refusal(const fs::path& file) {
  try {
    checkReplaceable(file);
  } catch (const FileError& expected) {
    try {
      atomicWrite(file, "text");
    } catch (const FileError& error) {
      EXPECT_STREQ(error.what(), expected.what()) << "told before the work as after it";
      return error.what();
    }
  }
  return {};
}

// An administrator's output to /dev/null replaced the device by a file.
TEST(AtomicWrite, DevicesPipesAndLinksToThemAreRefusedAndStay) {
  const test::TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe", link = folder.path() / "link";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  fs::create_symlink("pipe", link);
  for (const fs::path& file : {pipe, link}) {
    EXPECT_THAT(refusal(file), HasSubstr(file.string() + ": it is a device, a pipe or a socket"));
    EXPECT_THAT(refusal(file), HasSubstr("choose another name"));
  }
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_TRUE(fs::is_symlink(link));
  constexpr ::dev_t kNull = 0x103;  // Major 1, minor 3.
  const fs::path device = folder.path() / "null";
  if (::mknod(device.c_str(), S_IFCHR | 0600, kNull) != 0) return;  // Not an administrator.
  EXPECT_THAT(refusal(device), HasSubstr("a device"));
  EXPECT_TRUE(fs::is_character_file(device));
}

TEST(AtomicWrite, LinkGivesWayToTheFileWhereAskedFor) {
  const test::TemporaryFolder folder;
  const fs::path precious = folder.write("precious", "old"), link = folder.path() / "link";
  fs::create_symlink("precious", link);
  AtomicFile file(link, FileAccess::Private, Unfinished::Hidden, Links::Replace);
  file.write("new");
  file.commit();
  EXPECT_EQ(test::readBytes(precious), "old");
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(link)));
  EXPECT_EQ(test::readBytes(link), "new");
}

// A temporary file that all could read for a moment was read by others in two of three tries.
TEST(AtomicWrite, WhoCannotReadTheFileCanAtNoTimeReadTheTemporaryOne) {
  const test::TemporaryFolder folder;
  const fs::path target = folder.write("secret", "old");
  ASSERT_EQ(::chmod(target.c_str(), 0600), 0);
  std::atomic<bool> hasEnded{false};
  std::atomic<int> seen{0}, readable{0};
  std::thread reader([&] {
    while (!hasEnded) {
      std::error_code gone;
      for (fs::directory_iterator it(folder.path(), gone), end; !gone && it != end; it.increment(gone)) {
        std::error_code missing;
        const fs::perms permissions = it->symlink_status(missing).permissions();
        if (missing || permissions == fs::perms::unknown || it->path() == target) continue;
        ++seen;
        if ((permissions & (fs::perms::group_all | fs::perms::others_all)) != fs::perms::none) ++readable;
      }
    }
  });
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (seen < 500 && std::chrono::steady_clock::now() < end) {
    const AtomicFile file(target);
  }
  hasEnded = true;
  reader.join();
  EXPECT_GT(seen, 0);
  EXPECT_EQ(readable, 0);
}

TEST(AtomicWrite, OneFileOfTwoSpellingsIsKnown) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.write("file", ""), other = folder.write("other", "");
  const fs::path sub = folder.path() / "sub";
  fs::create_directory(sub);
  fs::create_symlink("../file", sub / "link");
  fs::create_symlink("../new", sub / "dangling");
  fs::create_directory_symlink(folder.path(), sub / "up");
  for (const fs::path& same : {file, sub / ".." / "file", sub / "link", sub / "up" / "file"})
    EXPECT_TRUE(isSameTarget(file, same)) << same;
  const fs::path fresh = folder.path() / "new";
  for (const fs::path& same : {fresh, sub / ".." / "new", sub / "dangling", sub / "up" / "new"})
    EXPECT_TRUE(isSameTarget(same, fresh)) << same;
  for (const fs::path& different : {other, fresh, sub / "file", folder.path() / "missing" / "file"})
    EXPECT_FALSE(isSameTarget(file, different)) << different;
}

void setAge(const fs::path& file, std::chrono::seconds age) {
  fs::last_write_time(file, fs::file_time_type::clock::now() - age);
}

TEST(AtomicWrite, TemporaryFilesOfKilledProgramsAreSweptAndNoOthers) {
  const test::TemporaryFolder folder;
  const auto old = [&](const std::string& name) {
    const fs::path file = folder.write(name, "left");
    setAge(file, std::chrono::minutes(5));
    return file;
  };
  const auto nameOf = [](::pid_t process) { return ".nearfit-" + std::to_string(process); };
  const std::string ended = nameOf(test::endedProcess());
  const fs::path left = old(ended + "-0"), before = old(nameOf(::getpid()) + "-4000000");
  const fs::path fresh = folder.write(ended + "-1", "just written");
  const std::vector<fs::path> others{
      old(nameOf(::getppid()) + "-0"), old(".nearfit-notes"), old(".nearfit-12-"),
      old(ended + "-0.txt"),           old("letter"),         old("felt.unfinished.csv")};
  fs::create_symlink("letter", folder.path() / (ended + "-2"));
  atomicWrite(folder.path() / "file", "text");
  EXPECT_FALSE(fs::exists(left));
  EXPECT_FALSE(fs::exists(before)) << "of an earlier process of the same number";
  EXPECT_TRUE(fs::exists(fresh));
  EXPECT_TRUE(fs::is_symlink(folder.path() / (ended + "-2")));
  for (const fs::path& other : others)
    EXPECT_EQ(test::readBytes(other), "left") << other;
}

// Another machine's programs may write to the same folder, and their numbers say nothing here.
TEST(AtomicWrite, TemporaryFileThatAProgramHoldsIsNoneOfAKilledOne) {
  const test::TemporaryFolder folder;
  const fs::path held = folder.write(".nearfit-" + std::to_string(test::endedProcess()) + "-0", "going on");
  setAge(held, std::chrono::minutes(5));
  const int descriptor = ::open(held.c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(descriptor, LOCK_EX | LOCK_NB), 0);
  removeAbandoned(folder.path());
  EXPECT_TRUE(fs::exists(held));
  ::close(descriptor);
  removeAbandoned(folder.path());
  EXPECT_FALSE(fs::exists(held));
}

TEST(AtomicWrite, VisibleTemporaryFilesAreKeptIfThereIsAnythingInThem) {
  const test::TemporaryFolder folder;
  const fs::path target = folder.path() / "felt.csv", first = folder.path() / "felt.unfinished.csv";
  const fs::path second = folder.path() / "felt.unfinished-2.csv";
  const fs::path third = folder.path() / "felt.unfinished-3.csv";
  setAge(folder.write(first.filename(), "rows"), std::chrono::minutes(5));
  setAge(folder.write(second.filename(), ""), std::chrono::minutes(5));
  AtomicFile mine(target, FileAccess::Usual, Unfinished::Visible);
  mine.write("mine");
  EXPECT_EQ(test::readBytes(first), "rows");
  EXPECT_EQ(test::readBytes(second), "mine") << "the empty one made room";
  // Empty as well, but held.
  const AtomicFile held(target, FileAccess::Usual, Unfinished::Visible);
  setAge(third, std::chrono::minutes(5));
  const AtomicFile another(target, FileAccess::Usual, Unfinished::Visible);
  EXPECT_TRUE(fs::exists(third));
  EXPECT_TRUE(fs::exists(folder.path() / "felt.unfinished-4.csv"));
}

}  // namespace
}  // namespace nearfit::atomic_write_test
