#include "core/files/sha256.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::sha256_test {
namespace {

// FIPS 180-4 example vectors.
constexpr const char* kEmptyDigest = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
constexpr const char* kAbcDigest = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
constexpr const char* kMillionADigest = "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0";

TEST(Sha256, BytesGiveTheStandardsExamples) {
  EXPECT_EQ(sha256OfBytes({}), kEmptyDigest);
  EXPECT_EQ(sha256OfBytes(std::string_view("abc")), kAbcDigest);
}

TEST(Sha256, FilesGiveTheStandardsExamples) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(sha256OfFile(folder.write("empty", "")), kEmptyDigest);
  EXPECT_EQ(sha256OfFile(folder.write("abc", "abc")), kAbcDigest);
  EXPECT_EQ(sha256OfFile(folder.write("a", std::string(1'000'000, 'a'))), kMillionADigest);
}

TEST(Sha256, FileLongerThanABlockIsHashedWhole) {
  const std::string bytes(3'500'001, '\xA5');
  const test::TemporaryFolder folder;
  EXPECT_EQ(sha256OfFile(folder.write("long", bytes)), sha256OfBytes(bytes));
}

TEST(Sha256, MissingFileFolderAndPipeAreRefused) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(sha256OfFile(folder.path() / "nothing"), FileError);
  EXPECT_THROW(sha256OfFile(folder.path()), FileError);
  const std::filesystem::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(sha256OfFile(pipe), FileError);
}

}  // namespace
}  // namespace nearfit::sha256_test
