#include "core/files/input_file.h"

#include <array>
#include <cstring>
#include <span>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/checksum.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::input_file_test {
namespace {

namespace fs = std::filesystem;

std::string textAt(const InputFile& file, std::uint64_t offset, std::size_t size) {
  std::string text(size, '?');
  return file.readAt(offset, std::as_writable_bytes(std::span(text))) ? text : "cut";
}

TEST(InputFile, BytesAreReadFromAnyPlace) {
  const test::TemporaryFolder folder;
  const std::string content = std::string(10'000, 'x') + '\0' + "end";
  const InputFile file(folder.write("file", content));
  EXPECT_EQ(file.size(), content.size());
  EXPECT_EQ(textAt(file, 0, content.size()), content);
  EXPECT_EQ(textAt(file, 10'001, 3), "end");
  EXPECT_EQ(textAt(file, 10'001, 4), "cut");
  EXPECT_EQ(textAt(file, content.size(), 0), "");
  EXPECT_EQ(textAt(file, content.size() + 1, 1), "cut");
}

TEST(InputFile, StaysTheOneThatWasOpenedAndTellsWhenThatIsCut) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.write("file", "before");
  const InputFile file(path);
  atomicWrite(path, "after, and longer");
  EXPECT_EQ(textAt(file, 0, 6), "before");
  fs::remove(path);
  EXPECT_EQ(textAt(file, 0, 6), "before");
  const fs::path cut = folder.write("cut", "whole");
  const InputFile shorter(cut);
  fs::resize_file(cut, 2);
  EXPECT_EQ(textAt(shorter, 0, 2), "wh");
  EXPECT_EQ(textAt(shorter, 0, 5), "cut");
}

TEST(InputFile, WhatIsNoFileIsAnError) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(InputFile(folder.path() / "none"), FileError);
  EXPECT_THROW(InputFile(folder.path()), FileError);
  EXPECT_THROW(InputFile("/dev/null"), FileError);
}

TEST(InputFile, UsersOwnIsNoLinkAndNoneThatOthersCanWriteOrOwn) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.write("file", "text"), link = folder.path() / "link";
  fs::create_symlink("file", link);
  ASSERT_EQ(::chmod(path.c_str(), 0644), 0);
  EXPECT_EQ(InputFile(path, FileOwner::User).size(), 4U);
  EXPECT_EQ(InputFile(link).size(), 4U);
  EXPECT_THROW(InputFile(link, FileOwner::User), FileError);
  for (const ::mode_t mode : {0620, 0602}) {
    ASSERT_EQ(::chmod(path.c_str(), mode), 0);
    EXPECT_THROW(InputFile(path, FileOwner::User), FileError);
  }
  ASSERT_EQ(::chmod(path.c_str(), 0600), 0);
  if (::chown(path.c_str(), 12345, static_cast<::gid_t>(-1)) != 0) return;  // Not an administrator.
  EXPECT_THROW(InputFile(path, FileOwner::User), FileError);
}

TEST(InputFile, HolesCountAsNothingWritten) {
  const test::TemporaryFolder folder;
  constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;
  const fs::path full = folder.write("full", std::string(100'000, 'x'));
  const fs::path sparse = folder.write("sparse", "abc");
  fs::resize_file(sparse, kGiB);
  InputFile file(sparse);
  EXPECT_EQ(file.size(), kGiB);
  EXPECT_LT(file.writtenBytes(), std::uint64_t{1} << 20);
  std::array<char, 3> begin{};
  EXPECT_EQ(file.read(begin), 3U);
  EXPECT_EQ(begin[0], 'a') << "reading begins at the beginning all the same";
  EXPECT_EQ(InputFile(full).writtenBytes(), 100'000U);
  EXPECT_EQ(InputFile(folder.write("empty", "")).writtenBytes(), 0U);
}

TEST(Checksum, IsXxh3AsPublished) {
  const auto of = [](const char* text) {
    return checksumOf(std::as_bytes(std::span(text, std::strlen(text))));
  };
  EXPECT_EQ(of(""), 0x2D06800538D394C2U);
  EXPECT_EQ(of("a"), 0xE6C632B61E964E1FU);
  EXPECT_EQ(of("abc"), 0x78AF5F94892F3950U);
}

}  // namespace
}  // namespace nearfit::input_file_test
