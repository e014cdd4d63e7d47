#include "core/files/input_file.h"

#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/files/atomic_write.h"
#include "core/files/checksum.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::input_file_test {
namespace {

namespace fs = std::filesystem;

std::string textOf(const MappedFile& file) {
  return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

TEST(MappedFile, ShowsTheBytesOfTheFileFromAPageOn) {
  const test::TemporaryFolder folder;
  const std::string content = std::string(10'000, 'x') + '\0' + "end";
  const MappedFile file(folder.write("file", content));
  EXPECT_EQ(textOf(file), content);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(file.bytes().data()) % 4096, 0U);
}

TEST(MappedFile, EmptyFileHasNoBytes) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(MappedFile(folder.write("file", "")).bytes().empty());
}

TEST(MappedFile, StaysAsItWasWhenTheFileIsReplacedOrRemoved) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.write("file", "before");
  const MappedFile file(path);
  atomicWrite(path, "after, and longer");
  EXPECT_EQ(textOf(file), "before");
  fs::remove(path);
  EXPECT_EQ(textOf(file), "before");
}

TEST(MappedFile, WhatIsNoFileIsAnError) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(MappedFile(folder.path() / "none"), FileError);
  EXPECT_THROW(MappedFile(folder.path()), FileError);
  EXPECT_THROW(MappedFile("/dev/null"), FileError);
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
