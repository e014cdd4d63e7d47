#include "core/files/gunzip.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/files/input_file.h"
#include "core/import/mesh_import.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::gunzip_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr std::uint64_t kEnough = std::uint64_t{1} << 30;

class Gunzip : public testing::Test {
 protected:
  /// The file packed by the gzip program.
  fs::path packed(const std::string& name, const std::string& content) const {
    const fs::path file = folder_.write(name, content);
    EXPECT_EQ(test::runProcess({"gzip", file.string()}).exitCode, 0);
    return file.string() + ".gz";
  }
  std::vector<char> packedBytes(const std::string& content) const {
    return readWholeFile(packed("text", content));
  }

  test::TemporaryFolder folder_;
};

std::string unpacked(const std::vector<char>& bytes, std::uint64_t maxBytes = kEnough) {
  const std::vector<char> text = gunzip(bytes, "a.gz", maxBytes);
  return {text.begin(), text.end()};
}

TEST_F(Gunzip, UnpacksWhatGzipPacked) {
  std::string text;
  for (std::uint32_t i = 0; i < 400'000; ++i)
    text += std::to_string(i * 7919 % 1000) + " ";
  const std::vector<char> bytes = packedBytes(text);
  EXPECT_TRUE(isGzip(bytes));
  EXPECT_EQ(unpacked(bytes), text);
}

TEST_F(Gunzip, UnpacksSeveralMembersOneAfterTheOther) {
  std::vector<char> both = packedBytes("first ");
  fs::remove(folder_.path() / "text.gz");
  const std::vector<char> second = packedBytes("second");
  both.insert(both.end(), second.begin(), second.end());
  EXPECT_EQ(unpacked(both), "first second");
}

TEST_F(Gunzip, EveryPrefixIsRefused) {
  const std::vector<char> bytes =
      packedBytes("some text that is long enough to be packed, text that is long enough");
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_THROW(unpacked({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}), FileError)
        << size;
}

TEST_F(Gunzip, DamageIsFoundByTheChecksum) {
  std::vector<char> bytes = packedBytes("some text");
  bytes[bytes.size() - 6] ^= 1;
  EXPECT_THROW(unpacked(bytes), FileError);
}

TEST_F(Gunzip, WhatFollowsTheLastMemberIsRefused) {
  std::vector<char> bytes = packedBytes("some text");
  bytes.push_back('x');
  EXPECT_THROW(unpacked(bytes), FileError);
}

TEST_F(Gunzip, MoreThanTheBoundIsRefused) {
  std::string zeros;
  zeros.resize(50'000'000, '0');
  const std::vector<char> bytes = packedBytes(zeros);
  EXPECT_LT(bytes.size(), 100'000U);
  EXPECT_EQ(unpacked(bytes).size(), 50'000'000U);
  try {
    unpacked(bytes, 10'000'000);
    ADD_FAILURE() << "was unpacked";
  } catch (const FileError& error) {
    EXPECT_THAT(error.problem(), HasSubstr("too large"));
  }
}

TEST_F(Gunzip, MeshesOfAllFormatsAreReadPacked) {
  const TriangleMesh mesh = test::tetrahedronMesh();
  for (const auto& [name, content] : {std::pair<std::string, std::string>{"a.stl", test::stlText(mesh)},
                                      {"b.stl", test::stlBinary(mesh)},
                                      {"a.off", test::offText(mesh)},
                                      {"a.ply", test::plyText(mesh)},
                                      {"a.obj", test::objText(mesh)}}) {
    const ImportedMesh imported = importMesh(packed(name, content), {});
    EXPECT_EQ(imported.mesh.triangles().size(), 4U) << name;
  }
}

}  // namespace
}  // namespace nearfit::gunzip_test
