// Files cut off anywhere, damaged at random and made up to hurt: each is loaded or refused, in time and
// memory bound to its size.
#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/files/input_file.h"
#include "core/import/mesh_file_check.h"
#include "core/import/mesh_import.h"
#include "tests/support/limited_process.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trial_share.h"

namespace nearfit::mesh_import_hostile_test {
namespace {

struct Sample {
  std::string name, content;
};

std::vector<Sample> samples() {
  const TriangleMesh mesh = test::starMesh(1, 1.0, 0, 0.3);
  return {{"binary.stl", test::stlBinary(mesh)},
          {"text.stl", test::stlText(mesh)},
          {"mesh.obj", test::objText(mesh)},
          {"mesh.off", test::offText(mesh)},
          {"text.ply", test::plyText(mesh)},
          {"little.ply", test::plyBinary(mesh)},
          {"big.ply", test::plyBinary(mesh, test::ByteOrder::Big)}};
}

/// Loads a file or sees it refused as it should be. Anything else fails the test. Returns whether it was
/// loaded.
bool loads(const std::filesystem::path& file) {
  try {
    const ImportedMesh imported = importMesh(file, {});
    EXPECT_GT(imported.mesh.triangles().size(), 0U);
    return true;
  } catch (const FileError& error) {
    EXPECT_THAT(error.where(), testing::StartsWith(file.string()));
    EXPECT_FALSE(error.problem().empty());
    EXPECT_FALSE(error.remedy().empty());
    return false;
  }
}

TEST(MeshImportHostile, EveryPrefixIsLoadedOrRefused) {
  const test::TemporaryFolder folder;
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    for (std::size_t length = 0; length < sample.content.size(); ++length) {
      loads(folder.write(sample.name, std::string_view(sample.content).substr(0, length)));
    }
    EXPECT_TRUE(loads(folder.write(sample.name, sample.content)));
  }
}

// Each element was compared with all before it: two million of them took an hour.
TEST(MeshImportHostile, PlyHeadersOfTooManyElementsOrPropertiesAreRefused) {
  const test::TemporaryFolder folder;
  const auto problemOf = [&](std::size_t count, const std::string& line) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex 0\n";
    for (std::size_t i = 0; i < count; ++i)
      text += line + std::to_string(i) + (line.starts_with("element") ? " 0\n" : "\n");
    try {
      importMesh(folder.write("x.ply", text + "end_header\n"), {});
    } catch (const FileError& error) {
      return error.problem();
    }
    return std::string();
  };
  using testing::HasSubstr;
  EXPECT_THAT(problemOf(2'000'000, "element e"), HasSubstr("more than 1000 elements"));
  EXPECT_THAT(problemOf(1'000'000, "property float p"), HasSubstr("more than 10000 properties"));
  EXPECT_THAT(problemOf(900, "element e"), testing::Not(HasSubstr("more than")));
}

TEST(MeshImportHostile, FormatsWithCountsAreRefusedWhereverTheyAreCutOff) {
  const test::TemporaryFolder folder;
  for (const Sample& sample : samples()) {
    if (sample.name == "mesh.obj" || sample.name == "text.stl") continue;
    // A last number that loses digits, or the line end behind it, is no less a number.
    const bool isText = sample.name == "mesh.off" || sample.name == "text.ply";
    const std::size_t end = isText ? sample.content.rfind(' ') : sample.content.size();
    for (std::size_t length = 0; length < end; ++length) {
      EXPECT_FALSE(loads(folder.write(sample.name, std::string_view(sample.content).substr(0, length))))
          << sample.name << " " << length;
    }
  }
}

TEST(MeshImportHostile, StlTextCutOffBetweenFacetsIsWarnedOfAndElsewhereRefused) {
  const test::TemporaryFolder folder;
  const std::string text = test::stlText(test::starMesh(1, 1.0, 0, 0.3));
  const std::size_t end = text.rfind("endsolid");
  for (std::size_t length = text.find("facet") + 1; length < end; ++length) {
    const std::filesystem::path file = folder.write("x.stl", text.substr(0, length));
    if (!loads(file)) continue;
    EXPECT_THAT(importMesh(file, {}).report.warnings,
                testing::Contains(testing::HasSubstr("may be cut off")));
  }
}

std::string damaged(std::string content, std::mt19937_64& random) {
  const std::size_t changes = 1 + random() % 4;
  for (std::size_t i = 0; i < changes && !content.empty(); ++i) {
    const std::size_t at = random() % content.size();
    const std::size_t span = std::min<std::size_t>(random() % 20, content.size() - at);
    switch (random() % 6) {
      case 0:
        content[at] = static_cast<char>(random());
        break;
      case 1:
        content[at] = static_cast<char>(content[at] ^ (1 << random() % 8));
        break;
      case 2:
        content.erase(at, span);
        break;
      case 3:
        content.insert(at, content.substr(random() % content.size(), span));
        break;
      case 4:
        content.insert(at, std::string(1 + random() % 12, '9'));
        break;
      default:
        content.replace(at, span, span, random() % 2 == 0 ? '\0' : '\xFF');
        break;
    }
  }
  return content;
}

TEST(MeshImportHostile, DamagedFilesAreLoadedOrRefused) {
  constexpr int kRounds = 3000;
  const test::TemporaryFolder folder;
  std::mt19937_64 random(20);
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    int loaded = 0;
    for (int i = 0; i < kRounds; ++i) {
      loaded += loads(folder.write(sample.name, damaged(sample.content, random))) ? 1 : 0;
    }
    // Both happen, or the damage was no test.
    EXPECT_GT(loaded, 0);
    EXPECT_LT(loaded, kRounds);
  }
}

/// What a limited import gives.
enum Outcome : int { kLoaded = 0, kRefused = 1, kOutOfMemory = 2 };

int importOutcome(const std::filesystem::path& file) {
  try {
    importMesh(file, {});
    return kLoaded;
  } catch (const FileError& error) {
    return error.problem().find("not enough memory") != std::string::npos ? kOutOfMemory : kRefused;
  }
}

/// Imports in a process of its own, with room for some times the file's size.
test::LimitedOutcome limitedImport(const std::filesystem::path& file) {
  constexpr std::size_t kFixedBytes = std::size_t{32} << 20, kTimesSize = 12;
  constexpr unsigned kSeconds = 20;
  const std::size_t room = kFixedBytes + kTimesSize * std::filesystem::file_size(file);
  return test::runLimited([&] { return importOutcome(file); }, room, kSeconds);
}

void append(std::string& bytes, std::uint32_t value) {
  for (int i = 0; i < 4; ++i)
    bytes += static_cast<char>(value >> (8 * i));
}

std::string plyHeader(const std::string& vertices, const std::string& faces, const std::string& countType) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list " + countType + " int vertex_indices\nend_header\n";
}

TEST(MeshImportHostile, PromisesThatTheFileCannotHoldTakeNoMemoryOrTime) {
  const std::string corners(36, '\0');
  std::string hugeList = plyHeader("3", "1", "uint") + corners;
  append(hugeList, 0xFFFFFFFF);
  std::string negativeList = plyHeader("3", "1", "int") + corners;
  append(negativeList, 0x80000000);
  std::string hugeStl(80, ' ');
  append(hugeStl, 0xFFFFFFFF);
  const std::vector<Sample> files{
      {"vertices.ply", plyHeader("4000000000", "1", "uchar") + corners},
      {"vertices64.ply", plyHeader("9000000000000000000", "1", "uchar") + corners},
      {"faces.ply", plyHeader("3", "4000000000", "uchar") + corners},
      {"list.ply", hugeList},
      {"negative.ply", negativeList},
      {"none.ply",
       "ply\nformat ascii 1.0\nelement nothing 9000000000000000000\nelement vertex 1\nproperty float x\n"
       "property float y\nproperty float z\nend_header\n1 2 3\n"},
      {"endless.ply", "ply\nformat ascii 1.0\ncomment " + std::string(100'000, 'x')},
      {"huge.stl", hugeStl + std::string(50, '\0')},
      {"vertices.off", "OFF\n353535235358 6 0\n0 0 0\n"},
      {"faces.off", "OFF\n3 4000000000 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"corners.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n"},
      {"zero.obj", "mtllib /dev/zero\nv 0 0 0\n"},
  };
  const test::TemporaryFolder folder;
  for (const Sample& file : files) {
    const test::LimitedOutcome outcome = limitedImport(folder.write(file.name, file.content));
    EXPECT_TRUE(outcome.hasEnded) << file.name << " signal " << outcome.signal;
    EXPECT_EQ(outcome.result, kRefused) << file.name;
  }
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string result;
  for (std::size_t i = 0; i < times; ++i)
    result += text;
  return result;
}

/// Files of a few megabytes made of whatever takes the most memory or time for its bytes.
std::vector<Sample> heavyFiles() {
  constexpr std::size_t kMany = 400'000 / test::kTrialShare;
  // Four times as many triangles a level.
  constexpr std::uint32_t kLevels = test::kTrialShare == 1 ? 7 : 6;
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::string polygon = "f", star;
  for (int i = 1; i <= 3000; ++i)
    polygon += " " + std::to_string(i);
  for (int i = 0; i < 3000; ++i) {
    star += "v " + std::to_string(i % 2 == 0 ? i : 3000 - i) + " " + std::to_string(i * 7919 % 3001) + " 0\n";
  }
  return {
      {"vertices.obj", triangle + repeated("v 0 0 0\n", kMany)},
      {"same.obj", triangle + repeated("f 1 2 3\n", kMany)},
      {"points.obj", triangle + repeated("f 1\n", kMany)},
      {"empty.obj", triangle + repeated("f\n", kMany)},
      {"lines.obj", triangle + repeated("\n", 4 * kMany)},
      {"returns.obj", triangle + repeated("\r", 4 * kMany)},
      {"continued.obj", triangle + "f " + repeated("1 \\\n", kMany)},
      {"crossing.obj", star + polygon + "\n"},
      {"longline.obj", triangle + "# " + std::string(4 * kMany, 'x')},
      {"lists.ply", plyHeader("3", std::to_string(4 * kMany + 1), "uchar") + std::string(8, '\0') +
                        std::string("\0\0\x80\x3F", 4) + std::string(16, '\0') +
                        std::string("\0\0\x80\x3F", 4) + std::string(4, '\0') +
                        std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13) + std::string(4 * kMany, '\0')},
      {"large.ply", test::plyBinary(test::icosphereMesh(1.0, kLevels))},
      {"large.stl", test::stlBinary(test::icosphereMesh(1.0, kLevels))},
      {"large.off", test::offText(test::icosphereMesh(1.0, kLevels))},
  };
}

TEST(MeshImportHostile, HeavyFilesTakeAFewTimesTheirSize) {
  const test::TemporaryFolder folder;
  for (const Sample& file : heavyFiles()) {
    const test::LimitedOutcome outcome = limitedImport(folder.write(file.name, file.content));
    EXPECT_TRUE(outcome.hasEnded) << file.name << " signal " << outcome.signal;
    EXPECT_EQ(outcome.result, kLoaded) << file.name;
  }
}

// A sparse file of no size on the disk took as much memory as it said to have.
TEST(MeshImportHostile, SparseFilesAreRefusedBeforeTheyAreRead) {
  const test::TemporaryFolder folder;
  constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;
  for (const char* name : {"hole.stl", "hole.obj", "hole.ply", "hole.off"}) {
    const std::filesystem::path file = folder.write(name, "solid\nply\nOFF\nv 0 0 0\n");
    std::filesystem::resize_file(file, kGiB);
    ASSERT_LT(InputFile(file).writtenBytes(), kGiB) << "the folder for temporary files must tell of holes";
    constexpr std::size_t kMemory = std::size_t{64} << 20;
    const test::LimitedOutcome outcome = test::runLimited([&] { return importOutcome(file); }, kMemory, 20);
    EXPECT_TRUE(outcome.hasEnded) << name << " signal " << outcome.signal;
    EXPECT_EQ(outcome.result, kRefused) << name;
    EXPECT_THROW(checkMeshFile(file), FileError);
  }
}

TEST(MeshImportHostile, FilesLargerThanTheMemoryAreRefusedByTheirSize) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("huge.stl", "");
  std::filesystem::resize_file(file, std::uint64_t{1} << 43);
  try {
    importMesh(file, {});
    FAIL() << "no error";
  } catch (const FileError& error) {
    EXPECT_EQ(error.where(), file.string());
    EXPECT_THAT(error.problem(), testing::HasSubstr("more than this machine has memory"));
  }
}

}  // namespace
}  // namespace nearfit::mesh_import_hostile_test
