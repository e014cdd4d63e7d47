#include <cmath>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/import/mesh_import.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test::check_command_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// A box in millimetres without one of its twelve triangles, 3 x 4 x 5.
std::string openBoxText() {
  const TriangleMesh box = boxMesh({3, 4, 5});
  return objText(
      {{box.vertices().begin(), box.vertices().end()}, {box.triangles().begin(), box.triangles().end() - 1}});
}

class CheckCommand : public ::testing::Test {
 protected:
  std::string path(const char* name) { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
  std::string box_ = folder_.write("box.obj", objText(boxMesh({3, 4, 5}))).string();
  std::string open_ = folder_.write("open.obj", openBoxText()).string();
};

TEST_F(CheckCommand, SoundAndOpenMeshesAreReportedWithExitCode0) {
  const ProcessResult result = runCli({"check", "--unit", "mm", box_, open_});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("box.obj\n  triangles            12\n  no findings\n"),
                                HasSubstr("openEdges            warning  3, length ")));
}

TEST_F(CheckCommand, JsonSaysWhatIsWhereInMetres) {
  const ProcessResult result = runCli({"check", "--json", "--unit", "mm", open_});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const Json json = Json::parse(result.out);
  EXPECT_EQ(json["triangles"], 11);
  EXPECT_EQ(json["check"]["totals"]["openEdges"]["count"], 3);
  EXPECT_EQ(json["check"]["totals"]["openEdges"]["complete"], true);
  EXPECT_EQ(json["check"]["totals"]["selfIntersections"]["places"], 0);
  ASSERT_EQ(json["check"]["findings"].size(), 1U);
  const Json& finding = json["check"]["findings"][0];
  EXPECT_EQ(finding["kind"], "openEdges");
  EXPECT_EQ(finding["edges"].size(), 3U);
  // Two sides of the face of 4 mm by 5 mm, and its diagonal.
  EXPECT_NEAR(finding["length"].get<double>(), 1e-3 * (4.0 + 5.0 + std::sqrt(41.0)), 1e-12);
  EXPECT_FALSE(json.contains("repair"));
}

TEST_F(CheckCommand, FacesThatLoadingLeftOutHaveTheirPlace) {
  // A face that repeats the first one, and one without area.
  const std::string file =
      folder_.write("faulty.obj", objText(boxMesh({3, 4, 5})) + "f 1 3 4\nf 1 2 2\n").string();
  const Json json = Json::parse(runCli({"check", "--unit", "m", "--json", file}).out);
  ASSERT_EQ(json["check"]["findings"].size(), 2U) << json.dump(1);
  for (const Json& finding : json["check"]["findings"]) {
    EXPECT_EQ(finding["mended"], true);
    EXPECT_EQ(finding["count"], 1);
    EXPECT_EQ(finding["triangles"].size(), 1U);
    EXPECT_EQ(finding["point"].size(), 3U);
  }
}

TEST_F(CheckCommand, ARepairedCopyIsWrittenAndTheChangeIsStated) {
  for (const char* name : {"closed.obj", "closed.stl", "closed.ply"}) {
    const std::string out = path(name);
    const ProcessResult result =
        runCli({"check", "--json", "--unit", "mm", open_, "--repair", out, "--fill", "10mm", "--orient"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const Json json = Json::parse(result.out);
    EXPECT_EQ(json["repair"]["steps"].size(), 3U) << "orient, fill, orient";
    EXPECT_EQ(json["repair"]["steps"][1]["addedFaces"], 1);
    EXPECT_TRUE(json["repair"]["before"]["volume"].is_null());
    EXPECT_NEAR(json["repair"]["after"]["volume"].get<double>(), 60e-9, 1e-15);
    EXPECT_TRUE(json["checkAfter"]["findings"].empty());
    // In the unit of the file that was repaired.
    MeshBuildOptions options;
    options.metresPerUnit = 1.0;
    const TriangleMesh mesh = importMesh(out, options).mesh;
    EXPECT_TRUE(mesh.topology().isClosed()) << name;
    EXPECT_NEAR(mesh.bounds().upper.z, 2.5, 1e-6);
  }
  EXPECT_EQ(readBytes(open_), openBoxText()) << "the original stays";
}

TEST_F(CheckCommand, TextSaysWhatTheRepairDid) {
  const ProcessResult result = runCli({"check", "--unit", "m", open_, "--fill", "10"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("fillHoles   1 changed, 1 faces added"),
                                HasSubstr("volume      none to 60 m^3"), HasSubstr("no findings")));
}

TEST_F(CheckCommand, TextSaysWhyWhatIsLeftIsNotRepaired) {
  const TriangleMesh crossing =
      joined(boxMesh({3, 4, 5}), transformed(boxMesh({3, 4, 5}), 1.0, {{1, 0, 0, 0}, {1.0, 1.1, 1.2}}));
  const std::string file = folder_.write("crossing.obj", objText(crossing)).string();
  EXPECT_THAT(runCli({"check", "--unit", "m", file, "--orient"}).out,
              HasSubstr("selfIntersections: cannot be repaired: the mesh does not say which of the faces"));
  const std::string single = folder_.write("single.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").string();
  const std::string before = runCli({"check", "--unit", "m", single}).out;
  EXPECT_THAT(before, testing::Not(HasSubstr("cannot be repaired"))) << "a hole may be filled";
  EXPECT_THAT(runCli({"check", "--unit", "m", single, "--fill", "10"}).out,
              HasSubstr("openEdges: cannot be repaired: filling has left them"));
}

TEST_F(CheckCommand, TheToleranceForCracksIsChosen) {
  const TriangleMesh sheets =
      joined(squareMesh(1.0, 1), transformed(squareMesh(1.0, 1), 1.0, {{1, 0, 0, 0}, {1.01, 0, 0}}));
  const std::string file = folder_.write("sheets.obj", objText(sheets)).string();
  const auto cracksWithin = [&](const char* width) {
    const Json json = Json::parse(runCli({"check", "--unit", "m", "--json", file, "--crack", width}).out);
    return json["check"]["totals"]["hairlineCracks"]["places"].get<int>();
  };
  EXPECT_EQ(cracksWithin("20 mm"), 1);
  EXPECT_EQ(cracksWithin("0.005"), 0);
}

TEST_F(CheckCommand, WrongUseIsExplainedWithExitCode2) {
  const auto failureOf = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin() + 1, {"--unit", "m"});
    const ProcessResult result = runCli(arguments);
    EXPECT_EQ(result.exitCode, 2) << result.err;
    EXPECT_EQ(result.out, "");
    return result.err;
  };
  EXPECT_THAT(failureOf({"check", open_, "--repair", path("out.stl")}), HasSubstr("no repair is chosen"));
  EXPECT_THAT(failureOf({"check", open_, "--repair", path("out.step"), "--orient"}),
              HasSubstr("use .stl, .obj or .ply"));
  EXPECT_THAT(failureOf({"check", open_, "--repair", open_, "--orient"}), HasSubstr("is an input"));
  EXPECT_THAT(failureOf({"check", open_, box_, "--repair", path("out.stl"), "--orient"}),
              HasSubstr("one file at a time"));
  EXPECT_THAT(failureOf({"check", open_, "--weld", "-1"}), HasSubstr("weld"));
  EXPECT_THAT(failureOf({"check", open_, "--fill", "1 kg"}), HasSubstr("--fill"));
  EXPECT_THAT(failureOf({"check"}), HasSubstr("mesh"));
}

TEST_F(CheckCommand, AFileThatCannotBeReadIsExitCode1AndTheOthersAreChecked) {
  const std::string broken = folder_.write("broken.stl", "").string();
  const ProcessResult result = runCli({"check", "--unit", "m", broken, box_});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_THAT(result.err, HasSubstr("broken.stl"));
  EXPECT_THAT(result.out, HasSubstr("no findings"));
  EXPECT_EQ(runCli({"check", "--unit", "m", box_, "--drop", "100"}).exitCode, 1) << "nothing would be left";
}

}  // namespace
}  // namespace nearfit::test::check_command_test
