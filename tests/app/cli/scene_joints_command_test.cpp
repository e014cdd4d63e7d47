#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/scene/joint_set.h"
#include "core/scene/scene_file.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test::scene_joints_command_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// A peg, turned and aside, and a hole.
class SceneJointsCommand : public ::testing::Test {
 protected:
  SceneJointsCommand() {
    folder_.write("hole.obj", objText(boxMesh({0.2, 0.2, 0.1})));
    folder_.write("peg.obj", objText(boxMesh({0.1, 0.1, 0.1})));
    options_.workingFolder = folder_.path();
    const ProcessResult made =
        run({"scene", "new", "fit.nearfit", "--unit", "m", "--part", "Hole=hole.obj@1,0,0,0.5,0.5,0.5,0.5",
             "--part", "Peg=peg.obj@0.3,0,0.5,0.5,-0.5,0.5,0.5"});
    EXPECT_EQ(made.exitCode, 0) << made.err;
  }
  ProcessResult run(const std::vector<std::string>& arguments) const { return runCli(arguments, options_); }
  Scene scene() const { return readSceneFile(folder_.path() / "fit.nearfit"); }
  std::string bytes() const { return readBytes(folder_.path() / "fit.nearfit"); }

  TemporaryFolder folder_;
  ProcessOptions options_;
};

TEST_F(SceneJointsCommand, APartIsKeptWhereItStands) {
  const std::vector<std::vector<std::string>> kept = {
      {"axis", "-0.3,0,0.5,0,0.6,0.8"}, {"plane", "0.3,0,0.5,0,0,-1"}, {"point", "0.1,0.2,0.3"}};
  for (const std::vector<std::string>& joint : kept) {
    const ProcessResult result =
        run({"scene", "keep", "fit.nearfit", "Peg", joint[0], "--at", joint[1], "--base", "Hole"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_THAT(result.out, HasSubstr("Peg"));
  }
  const Scene made = scene();
  ASSERT_EQ(made.joints().size(), 3U);
  const Part &peg = *made.findByName("Peg"), &hole = *made.findByName("Hole");
  for (const Joint& joint : made.joints()) {
    EXPECT_EQ(joint.part, peg.id);
    EXPECT_EQ(joint.base, hole.id);
    EXPECT_TRUE(joint.isOn);
    EXPECT_LT(glm::distance(peg.worldFromPart.applyToPoint(joint.onPart.point),
                            hole.worldFromPart.applyToPoint(joint.onBase.point)),
              1e-15);
  }
  EXPECT_EQ(made.joints()[0].kind, JointKind::OnAxis);
  const glm::dvec3 axis = peg.worldFromPart.applyToVector(made.joints()[0].onPart.direction);
  EXPECT_LT(glm::distance(axis, {0.0, 0.6, 0.8}), 1e-15);
  EXPECT_LT(glm::distance(hole.worldFromPart.applyToVector(made.joints()[0].onBase.direction), axis), 1e-15);
  EXPECT_EQ(made.joints()[1].kind, JointKind::InPlane);
  EXPECT_LT(glm::distance(hole.worldFromPart.applyToVector(made.joints()[1].onBase.direction), {0, 0, 1}),
            1e-15)
      << "faces look at each other";
  EXPECT_EQ(made.joints()[2].kind, JointKind::ToPoint);
  EXPECT_LT(jointsOf(made, peg.id).residual(peg.worldFromPart).distance, 1e-14);
}

TEST_F(SceneJointsCommand, InfoListsJointsAndReleaseRemovesThemByNumber) {
  ASSERT_EQ(run({"scene", "keep", "fit.nearfit", "Peg", "axis", "--at", "0.3,0,0.5,0,0,1"}).exitCode, 0);
  ASSERT_EQ(run({"scene", "keep", "fit.nearfit", "Hole", "point", "--at", "1,0,0", "--base", "Peg"}).exitCode,
            0);
  const ProcessResult text = run({"info", "fit.nearfit"});
  EXPECT_EQ(text.exitCode, 0) << text.err;
  EXPECT_THAT(text.out, AllOf(HasSubstr("parts       2"), HasSubstr("joints      2"),
                              HasSubstr("joint 1     Peg on axis of the world, on"),
                              HasSubstr("joint 2     Hole to point of Peg, on")));
  const Json json = Json::parse(run({"info", "--json", "fit.nearfit"}).out);
  ASSERT_EQ(json["joints"].size(), 2U);
  EXPECT_EQ(json["joints"][0]["kind"], "axis");
  EXPECT_EQ(json["joints"][0]["base"], nullptr);
  EXPECT_EQ(json["joints"][1]["base"], "Peg");
  EXPECT_EQ(json["joints"][1]["contradictory"], false);

  const ProcessResult released = run({"scene", "release", "fit.nearfit", "1"});
  EXPECT_EQ(released.exitCode, 0) << released.err;
  EXPECT_THAT(released.out, HasSubstr("1 joint left"));
  ASSERT_EQ(scene().joints().size(), 1U);
  EXPECT_EQ(scene().joints()[0].kind, JointKind::ToPoint);
}

TEST_F(SceneJointsCommand, WrongArgumentsAreToldInOneLineAndChangeNothing) {
  const std::string before = bytes();
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{"keep", "fit.nearfit", "Pin", "axis", "--at", "0,0,0,0,0,1"}, "there is no part \"Pin\""},
      {{"keep", "fit.nearfit", "Peg", "weld", "--at", "0,0,0,0,0,1"}, "give axis, plane or point"},
      {{"keep", "fit.nearfit", "Peg", "axis", "--at", "0,0,0"}, "--at: \"0,0,0\" is not a valid value"},
      {{"keep", "fit.nearfit", "Peg", "point", "--at", "0,0,0,0,0,1"}, "--at"},
      {{"keep", "fit.nearfit", "Peg", "axis", "--at", "0,0,0,0,0,0"}, "direction: its length is 0"},
      {{"keep", "fit.nearfit", "Peg", "axis", "--at", "0,0,0,0,0,1", "--base", "Peg"},
       "a part cannot be kept on itself"},
      {{"keep", "fit.nearfit", "Peg", "axis", "--at", "0,0,0,0,0,1", "--base", "Pin"},
       "--base: there is no part"},
      {{"keep", "fit.nearfit", "Peg", "point", "--at", "0,0,1e10"}, "position"},
      {{"release", "fit.nearfit", "1"}, "there is no joint 1"},
  };
  for (const auto& [arguments, problem] : wrong) {
    std::vector<std::string> all = arguments;
    all.insert(all.begin(), "scene");
    const ProcessResult result = run(all);
    EXPECT_EQ(result.exitCode, 2) << ::testing::PrintToString(arguments);
    EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
    EXPECT_THAT(result.err, HasSubstr(problem));
  }
  EXPECT_EQ(bytes(), before);
}

TEST_F(SceneJointsCommand, PlaceKeepsThePartOnItsJoint) {
  ASSERT_EQ(run({"scene", "keep", "fit.nearfit", "Peg", "axis", "--at", "0.3,0,0.5,0,0,1"}).exitCode, 0);
  std::string path = "tx,ty,tz,qw,qx,qy,qz\n";
  for (int i = 0; i < 300; ++i)
    path += fmt::format("{},{},{},0.5,-0.5,0.5,0.5\n", 0.3 + 1e-4 * i, 2e-4 * i, 0.5 + 1e-4 * i);
  folder_.write("path.csv", path);
  const ProcessResult result =
      run({"place", "fit.nearfit", "--part", "Peg", "--path", "path.csv", "--fast", "--export", "end.json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const Json end = Json::parse(readBytes(folder_.path() / "end.json"));
  ASSERT_EQ(end["parts"].size(), 2U);
  EXPECT_EQ(end["parts"][1]["name"], "Peg");
  const Json& position = end["parts"][1]["position"];
  EXPECT_NEAR(position[0].get<double>(), 0.3, 1e-9);
  EXPECT_NEAR(position[1].get<double>(), 0.0, 1e-9);
  EXPECT_NEAR(position[2].get<double>(), 0.5 + 1e-4 * 299, 1e-6);
}

}  // namespace
}  // namespace nearfit::test::scene_joints_command_test
