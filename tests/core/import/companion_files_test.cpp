#include "core/import/companion_files.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::companion_files_test {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::IsEmpty;

/// A package of a robot, with meshes that are never read.
class RobotFolder {
 public:
  RobotFolder() {
    for (const char* folder : {"arm/urdf", "arm/meshes"})
      fs::create_directories(folder_.path() / folder);
    for (const char* name : {"base.stl", "a&b.stl", "tip.GLB", "bolt.step", "packed.stl.gz", "other.stl"})
      folder_.write(fs::path("arm/meshes") / name, "a mesh");
    folder_.write("outside.stl", "a mesh");
  }
  fs::path write(const std::string& text, const char* name = "arm.urdf") const {
    return folder_.write(fs::path("arm/urdf") / name, text);
  }
  /// Names in meshes/ of what a file of this text names.
  std::vector<std::string> named(const std::string& text) const {
    std::vector<std::string> names;
    for (const fs::path& file : meshFilesNamedIn(write(text))) {
      EXPECT_EQ(file.parent_path(), folder_.path() / "arm/meshes");
      names.push_back(file.filename().string());
    }
    return names;
  }

 private:
  TemporaryFolder folder_;
};

TEST(MeshFilesNamedInUrdf, AreThoseThatAreThereAndCanBeRead) {
  const RobotFolder robot;
  EXPECT_THAT(robot.named(R"(<robot name="arm"><link name="base"><visual><geometry>
<mesh filename="package://arm/meshes/base.stl"/></geometry></visual><collision><geometry>
<mesh scale = "1 1 1"
  filename = '../meshes/a&amp;b.stl'></mesh><mesh filename="../meshes/tip.GLB"/>
</geometry></collision></link></robot>)"),
              ElementsAre("base.stl", "a&b.stl", "tip.GLB"));
  EXPECT_THAT(robot.named(R"(<mesh filename="../meshes/missing.stl"/><mesh filename="../meshes/bolt.step"/>
<mesh filename="../meshes/packed.stl.gz"/><mesh filename="../../outside.stl"/><mesh filename="/etc/passwd"/>
<mesh filename="http://x/base.stl"/><mesh/><mesh filename=""/>)"),
              IsEmpty());
}

TEST(MeshFilesNamedInUrdf, AreNeitherThoseOfCommentsNorOfOtherElements) {
  const RobotFolder robot;
  EXPECT_THAT(
      robot.named(R"(<!-- <mesh filename="../meshes/other.stl"/> --><mesh filename="../meshes/base.stl"/>
<texture filename="../meshes/other.stl"/><meshes filename="../meshes/other.stl"/>
<mesh myfilename="../meshes/other.stl"/>)"),
      ElementsAre("base.stl"));
}

TEST(MeshFilesNamedInUrdf, AreFoundInPackedAndInDamagedFilesWithoutAnError) {
  const RobotFolder robot;
  const std::string mesh = R"(<mesh filename="../meshes/base.stl"/>)";
  EXPECT_THAT(robot.named(mesh + "<mesh filename=\"../meshes/other.stl"), ElementsAre("base.stl"));
  EXPECT_THAT(robot.named(mesh + "<!-- "), ElementsAre("base.stl"));
  EXPECT_THAT(robot.named(""), IsEmpty());
  std::string entities;
  for (int i = 0; i < 2'000'000; ++i)
    entities += "&lt;";
  EXPECT_THAT(robot.named("<mesh filename=\"" + entities + "\"/>" + mesh), ElementsAre("base.stl"));
  const fs::path plain = robot.write(mesh, "packed.urdf");
  ASSERT_EQ(test::runProcess({"gzip", plain.string()}).exitCode, 0);
  EXPECT_EQ(meshFilesNamedIn(plain.string() + ".gz").size(), 1U);
  EXPECT_THAT(meshFilesNamedIn(robot.write("\x1F\x8B\x08 cut off", "cut.urdf.gz")), IsEmpty());
  EXPECT_THAT(meshFilesNamedIn(plain), IsEmpty()) << "it is there no more";
  EXPECT_THAT(meshFilesNamedIn(robot.write(mesh, "arm.gltf")), IsEmpty()) << "another format";
}

}  // namespace
}  // namespace nearfit::companion_files_test
