#include "core/files/ownership.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::ownership_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(Ownership, FolderThatOthersCanWriteToOrOwnIsNotTrusted) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(distrustOfFolder(folder.path()), "");
  EXPECT_EQ(distrustOfFolder(folder.path() / "none"), "");
  for (const ::mode_t mode : {0770, 0707, 01777}) {
    ASSERT_EQ(::chmod(folder.path().c_str(), mode), 0);
    EXPECT_THAT(distrustOfFolder(folder.path()), HasSubstr("other users can write"));
  }
  ASSERT_EQ(::chmod(folder.path().c_str(), 0755), 0);
  EXPECT_EQ(distrustOfFolder(folder.path()), "") << "reading changes nothing";
  const fs::path foreign = folder.path() / "foreign";
  createPrivateFolder(foreign);
  if (::chown(foreign.c_str(), 12345, static_cast<::gid_t>(-1)) != 0) return;  // Not an administrator.
  EXPECT_THAT(distrustOfFolder(foreign), HasSubstr("another user"));
}

TEST(Ownership, NewFolderIsTheUsersAloneAndAnExistingOneStays) {
  const test::TemporaryFolder folder;
  for (const fs::path& name : {folder.path() / "a" / "b", folder.path() / "c" / ""}) {
    createPrivateFolder(name);
    EXPECT_EQ(fs::status(name).permissions(), fs::perms::owner_all) << name;
  }
  const fs::path wide = folder.path() / "a";
  ASSERT_EQ(::chmod(wide.c_str(), 0750), 0);
  createPrivateFolder(wide);
  EXPECT_EQ(fs::status(wide).permissions(),
            fs::perms::owner_all | fs::perms::group_read | fs::perms::group_exec);
}

TEST(Ownership, FolderThatCannotBeMadeIsNamed) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.write("file", "");
  for (const fs::path& name : {file, file / "below"}) {
    try {
      createPrivateFolder(name);
      FAIL() << name;
    } catch (const FileError& error) {
      EXPECT_EQ(error.where(), name.string());
      EXPECT_FALSE(error.remedy().empty());
    }
  }
}

}  // namespace
}  // namespace nearfit::ownership_test
