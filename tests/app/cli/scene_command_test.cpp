#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/scene/scene_file.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test::scene_command_test {
namespace {

using ::testing::HasSubstr;

class SceneNewCommand : public ::testing::Test {
 protected:
  SceneNewCommand() {
    std::filesystem::create_directory(folder_.path() / "meshes");
    folder_.write("meshes/hole.obj", objText(boxMesh({20, 20, 10})));
    folder_.write("meshes/peg@2.obj", objText(boxMesh({10, 10, 10})));
    folder_.write("meshes/v@1,2.obj", objText(boxMesh({10, 10, 10})));
    options_.workingFolder = folder_.path();
  }
  ProcessResult run(std::vector<std::string> arguments) const {
    if (std::ranges::find(arguments, "--unit") == arguments.end())
      arguments.insert(arguments.begin(), {"--unit", "m"});
    arguments.insert(arguments.begin(), {"scene", "new"});
    return runCli(arguments, options_);
  }
  Scene scene() const { return readSceneFile(folder_.path() / "fit.nearfit"); }

  TemporaryFolder folder_;
  ProcessOptions options_;
};

TEST_F(SceneNewCommand, SceneHasThePartsPosesAndSettingsThatWereAsked) {
  const ProcessResult result =
      run({"fit.nearfit", "--part", "Hole=meshes/hole.obj", "--part",
           "Peg=meshes/peg@2.obj@0.01,-0.02,3e-2,0.5,0.5,0.5,-0.5", "--moving", "Peg", "--cutoff", "0.005",
           "--unit", "mm", "--stiffness", "350", "--damping", "1.5", "--mode", "printed"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, HasSubstr("fit.nearfit"));
  const Scene made = scene();
  ASSERT_EQ(made.parts().size(), 2U);
  const Part &hole = *made.parts()[0], &peg = *made.parts()[1];
  EXPECT_EQ(hole.name, "Hole");
  EXPECT_EQ(hole.worldFromPart.translation, glm::dvec3(0.0));
  EXPECT_EQ(hole.geometry->metresPerUnit, 0.001);
  EXPECT_NEAR(hole.geometry->mesh.bounds().upper.x, 0.01, 1e-15);
  EXPECT_EQ(peg.name, "Peg");
  EXPECT_EQ(peg.worldFromPart.translation, glm::dvec3(0.01, -0.02, 0.03));
  EXPECT_EQ(peg.worldFromPart.rotation, glm::dquat(0.5, 0.5, 0.5, -0.5));
  EXPECT_FALSE(hole.colour == peg.colour);
  EXPECT_EQ(made.movingPart(), peg.id);
  EXPECT_EQ(made.haptics().springs.cutoff, 0.005);
  EXPECT_EQ(made.haptics().springs.stiffness, 350.0);
  EXPECT_EQ(made.haptics().springs.damping, 1.5);
  EXPECT_EQ(made.haptics().springs.law, SpringLaw::Printed);
  EXPECT_EQ(made.haptics().mode, HapticMode::Springs);
}

TEST_F(SceneNewCommand, WithoutOptionsTheFeelIsThatOfANewSceneAndTheMarginSuitsTheCutoff) {
  ASSERT_EQ(run({"fit.nearfit", "--part", "Hole=meshes/hole.obj"}).exitCode, 0);
  EXPECT_TRUE(scene().haptics() == HapticSettings{});
  EXPECT_EQ(scene().haptics().mode, HapticMode::Proxy);
  ASSERT_EQ(run({"fit.nearfit", "--part", "Hole=meshes/hole.obj", "--cutoff", "0.005"}).exitCode, 0);
  EXPECT_DOUBLE_EQ(scene().haptics().proxy.margin, 5e-5);
  ASSERT_EQ(run({"fit.nearfit", "--part", "Hole=meshes/hole.obj", "--cutoff", "0.005", "--margin", "1e-3"})
                .exitCode,
            0);
  EXPECT_EQ(scene().haptics().proxy.margin, 1e-3);
}

TEST_F(SceneNewCommand, EveryOptionOfTheFeelArrives) {
  const ProcessResult result = run({"fit.nearfit",
                                    "--part",
                                    "Hole=meshes/hole.obj",
                                    "--mode",
                                    "spring",
                                    "--cutoff",
                                    "0.02",
                                    "--stiffness",
                                    "300",
                                    "--damping",
                                    "2",
                                    "--margin",
                                    "3e-4",
                                    "--friction",
                                    "0.4",
                                    "--coupling-stiffness",
                                    "1500",
                                    "--coupling-damping",
                                    "0.6",
                                    "--rotational-stiffness",
                                    "2.5",
                                    "--rotational-damping",
                                    "0.01",
                                    "--weight",
                                    "--inertia",
                                    "--gravity",
                                    "-1,0,9.5",
                                    "--scale",
                                    "20",
                                    "--orientation",
                                    "0.5,-0.5,0.5,0.5",
                                    "--lock",
                                    "tz,rx,ry"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  HapticSettings expected;
  expected.mode = HapticMode::Springs;
  expected.springs = {0.02, 300.0, 2.0, SpringLaw::Linear};
  expected.proxy = {3e-4, 0.4};
  expected.coupling = {false, 1500.0, 0.6, 2.5, 0.01};
  expected.weight = {true, true, {-1.0, 0.0, 9.5}};
  expected.mapping = {20.0, {0.5, -0.5, 0.5, 0.5}, {false, false, true}, {true, true, false}};
  EXPECT_TRUE(scene().haptics() == expected);
}

TEST_F(SceneNewCommand, AnyNumberForTheCouplingTurnsItsAutomaticChoiceOff) {
  for (const char* option :
       {"--coupling-stiffness", "--coupling-damping", "--rotational-stiffness", "--rotational-damping"}) {
    ASSERT_EQ(run({"fit.nearfit", "--part", "Hole=meshes/hole.obj", option, "0.5"}).exitCode, 0);
    EXPECT_FALSE(scene().haptics().coupling.isAutomatic) << option;
  }
}

TEST_F(SceneNewCommand, DensitiesGoToTheirParts) {
  const ProcessResult result = run({"fit.nearfit", "--part", "Hole=meshes/hole.obj", "--part",
                                    "Peg=meshes/peg@2.obj", "--density", "Peg=7850", "--unit", "mm"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(scene().findByName("Hole")->density, 1000.0);
  EXPECT_EQ(scene().findByName("Peg")->density, 7850.0);
  EXPECT_NEAR(massOf(*scene().findByName("Peg")), 7850.0 * 1e-6, 1e-15);
}

TEST_F(SceneNewCommand, MeshPathsAreRelativeToTheSceneFile) {
  ASSERT_EQ(run({"fit.nearfit", "--part", "Hole=meshes/hole.obj"}).exitCode, 0);
  const auto json = nlohmann::json::parse(readBytes(folder_.path() / "fit.nearfit"));
  EXPECT_EQ(json["parts"][0]["mesh"], "meshes/hole.obj");
  EXPECT_TRUE(json["moving"].is_null());
}

TEST_F(SceneNewCommand, OutMayComeLast) {
  EXPECT_EQ(run({"--part", "Hole=meshes/hole.obj", "fit.nearfit"}).exitCode, 0);
  EXPECT_EQ(scene().parts().size(), 1U);
}

TEST_F(SceneNewCommand, AtSignInAFileNameIsNoPose) {
  const ProcessResult result =
      run({"fit.nearfit", "--part", "A=meshes/peg@2.obj", "--part", "B=meshes/v@1,2.obj"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(scene().parts()[0]->geometry->file.filename(), "peg@2.obj");
  EXPECT_EQ(scene().parts()[1]->geometry->file.filename(), "v@1,2.obj");
}

TEST_F(SceneNewCommand, FileNameMayHoldAnEqualsSign) {
  folder_.write("meshes/a=b.obj", objText(boxMesh({1, 1, 1})));
  ASSERT_EQ(run({"fit.nearfit", "--part", "A=meshes/a=b.obj"}).exitCode, 0);
  EXPECT_EQ(scene().parts()[0]->name, "A");
}

TEST_F(SceneNewCommand, WrongUsageIsToldInOneLineAndWritesNothing) {
  const std::string hole = "Hole=meshes/hole.obj";
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{}, "out"},
      {{"fit.nearfit"}, "--part"},
      {{"fit.nearfit", "--part", "meshes/hole.obj"}, "NAME=FILE"},
      {{"fit.nearfit", "--part", "=meshes/hole.obj"}, "NAME=FILE"},
      {{"fit.nearfit", "--part", "Hole="}, "NAME=FILE"},
      {{"fit.nearfit", "--part", hole, "--part", hole}, "two parts are named \"Hole\""},
      {{"fit.nearfit", "--part", hole, "--moving", "Peg"}, "there is no part \"Peg\""},
      {{"fit.nearfit", "--part", hole + "@0,0,1"}, "\"0,0,1\" is not a pose"},
      {{"fit.nearfit", "--part", hole + "@0,0,1,1,1,0,0"}, "quaternion"},
      {{"fit.nearfit", "--part", hole + "@0,0,1e10,1,0,0,0"}, "position"},
      {{"fit.nearfit", "--part", hole, "--cutoff", "0"}, "--cutoff: 0 m is out of range"},
      {{"fit.nearfit", "--part", hole, "--mode", "soft"}, "--mode"},
      {{"fit.nearfit", "--part", hole, "--margin", "0.02"}, "--margin: 0.02 m is greater than the cutoff"},
      {{"fit.nearfit", "--part", hole, "--margin", "nan"}, "--margin"},
      {{"fit.nearfit", "--part", hole, "--friction", "2.5"}, "--friction: 2.5 is out of range"},
      {{"fit.nearfit", "--part", hole, "--coupling-stiffness", "-1"}, "--coupling-stiffness"},
      {{"fit.nearfit", "--part", hole, "--coupling-damping", "1e5"}, "--coupling-damping"},
      {{"fit.nearfit", "--part", hole, "--rotational-stiffness", "inf"}, "--rotational-stiffness"},
      {{"fit.nearfit", "--part", hole, "--rotational-damping", "-0.1"}, "--rotational-damping"},
      {{"fit.nearfit", "--part", hole, "--gravity", "0,0"}, "--gravity: \"0,0\" is not a valid value"},
      {{"fit.nearfit", "--part", hole, "--gravity", "0,0,2000"}, "--gravity: 2000 m/s^2 is out of range"},
      {{"fit.nearfit", "--part", hole, "--scale", "0"}, "--scale"},
      {{"fit.nearfit", "--part", hole, "--orientation", "1,1,0,0"}, "--orientation: its length is 1.4"},
      {{"fit.nearfit", "--part", hole, "--lock", "tx,tw"}, "--lock: \"tx,tw\" is not a list of axes"},
      {{"fit.nearfit", "--part", hole, "--lock", "tx,"}, "--lock"},
      {{"fit.nearfit", "--part", hole, "--lock", ""}, "--lock"},
      {{"fit.nearfit", "--part", hole, "--density", "7850"}, "NAME=VALUE"},
      {{"fit.nearfit", "--part", hole, "--density", "Peg=7850"}, "there is no part \"Peg\""},
      {{"fit.nearfit", "--part", hole, "--density", "Hole=heavy"}, "--density: \"heavy\""},
      {{"fit.nearfit", "--part", hole, "--density", "Hole=0"}, "density: 0 kg/m^3 is out of range"},
      {{"fit.nearfit", "--part", hole, "--cutoff", "1e9"}, "cutoff"},
      {{"fit.nearfit", "--part", hole, "--stiffness", "-3"}, "stiffness"},
      {{"fit.nearfit", "--part", hole, "--unit", "0"}, "unit"},
      {{"fit.nearfit", "--part", "A\nB=meshes/hole.obj"}, "name"},
  };
  for (const auto& [arguments, problem] : wrong) {
    const ProcessResult result = run(arguments);
    EXPECT_EQ(result.exitCode, 2) << ::testing::PrintToString(arguments);
    EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
    EXPECT_THAT(result.err, HasSubstr(problem));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "fit.nearfit"));
  }
}

TEST_F(SceneNewCommand, AMeshIsNotOverwritten) {
  const std::filesystem::path mesh = folder_.path() / "meshes/hole.obj";
  const std::string before = readBytes(mesh);
  EXPECT_EQ(run({"./meshes/hole.obj", "--part", "Hole=meshes/hole.obj"}).exitCode, 2);
  EXPECT_EQ(readBytes(mesh), before);
}

TEST_F(SceneNewCommand, FilesThatFailAreToldInOneLine) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> failing = {
      {{"fit.nearfit", "--part", "Hole=meshes/none.obj"}, "none.obj"},
      {{"fit.nearfit", "--part", "Hole=meshes"}, "meshes"},
      {{"none/fit.nearfit", "--part", "Hole=meshes/hole.obj"}, "none/fit.nearfit"},
  };
  for (const auto& [arguments, problem] : failing) {
    const ProcessResult result = run(arguments);
    EXPECT_EQ(result.exitCode, 1) << ::testing::PrintToString(arguments);
    EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
    EXPECT_THAT(result.err, HasSubstr(problem));
  }
}

}  // namespace
}  // namespace nearfit::test::scene_command_test
