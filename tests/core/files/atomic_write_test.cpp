#include "core/files/atomic_write.h"

#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "core/base/error.h"
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

}  // namespace
}  // namespace nearfit::atomic_write_test
