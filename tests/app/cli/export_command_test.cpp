#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/import/mesh_import.h"
#include "tests/app/cli/plate_and_cube.h"

namespace nearfit::test::export_command_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class ExportCommand : public PlateAndCube {};

TEST_F(ExportCommand, TheNameOfTheFileSaysWhatIsWritten) {
  for (const char* name : {"a.stl", "a.OBJ", "a.ply"}) {
    const auto result = runCli({"export", scene_, path(name)});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(result.out, StartsWith("wrote "));
    const ImportedMesh read = importMesh(path(name), {.metresPerUnit = 1e-3});
    EXPECT_EQ(read.mesh.triangles().size(), 24U);
    EXPECT_NEAR(read.mesh.bounds().upper.z, 2.5, 1e-6) << "in millimetres unless said otherwise";
  }
  ASSERT_EQ(runCli({"export", scene_, path("a.json")}).exitCode, 0);
  EXPECT_EQ(nlohmann::json::parse(readBytes(path("a.json")))["moving"], "Cube");
  ASSERT_EQ(runCli({"export", scene_, path("a.csv")}).exitCode, 0);
  EXPECT_THAT(readBytes(path("a.csv")), HasSubstr("\nCube,"));
}

TEST_F(ExportCommand, AssembliesAreWrittenWithAllPartsOrThoseNamed) {
  for (const auto& [name, begin] :
       {std::pair("d.glb", "glTF"), std::pair("d.3mf", "PK"), std::pair("d.urdf", "<?xml")}) {
    const auto result = runCli({"export", scene_, "-o", path(name)});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_THAT(readBytes(path(name)), StartsWith(begin));
  }
  const std::string robot = readBytes(path("d.urdf"));
  EXPECT_THAT(robot, HasSubstr("<link name=\"Cube\">"));
  EXPECT_THAT(robot, HasSubstr("<link name=\"Plate\">"));
  ASSERT_EQ(runCli({"export", scene_, path("e.urdf"), "--part", "Cube"}).exitCode, 0);
  EXPECT_THAT(readBytes(path("e.urdf")), Not(HasSubstr("Plate")));
}

TEST_F(ExportCommand, APartAndAUnitAreChosen) {
  ASSERT_EQ(runCli({"export", scene_, path("b.obj"), "--part", "Cube", "--unit", "m"}).exitCode, 0);
  const ImportedMesh read = importMesh(path("b.obj"), {});
  EXPECT_EQ(read.mesh.triangles().size(), 12U);
  EXPECT_EQ(read.mesh.bounds().upper.z, 2.5);
}

TEST_F(ExportCommand, WhatMakesNoSenseIsWrongUsageAndWritesNothing) {
  for (const auto& arguments :
       std::vector<std::vector<std::string>>{{"export", scene_, path("c.dxf")},
                                             {"export", scene_, path("c.stl"), "--part", "Peg"},
                                             {"export", scene_, path("c.json"), "--part", "Cube"},
                                             {"export", scene_, path("c.stl"), "--unit", "parsec"},
                                             {"export", scene_, path("c.glb"), "--unit", "mm"},
                                             {"export", scene_, path("c.3mf"), "--unit", "0.5"},
                                             {"export", scene_, path("cube.obj")},
                                             {"clearance", scene_, "--part", "Peg"},
                                             {"clearance", scene_, "--cutoff", "-1"}}) {
    const auto result = runCli(arguments);
    EXPECT_EQ(result.exitCode, 2) << arguments.back();
    for (const char* name : {"c.stl", "c.glb", "c.3mf"})
      EXPECT_FALSE(std::filesystem::exists(path(name)));
  }
  EXPECT_EQ(importMesh(path("cube.obj"), {}).mesh.triangles().size(), 12U) << "it is not overwritten";
}

TEST_F(ExportCommand, ClearancesAreATable) {
  const auto result = runCli({"clearance", scene_, "--cutoff", "1.5"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("part,other,distance [m],part_x [m],")) << "lengths have their unit";
  EXPECT_THAT(result.out, HasSubstr("\nCube,Plate,1,"));
  EXPECT_THAT(result.out, HasSubstr(",1,1,no,0\n")) << "one minimum, the region between the faces";
}

}  // namespace
}  // namespace nearfit::test::export_command_test
