#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test::lmd_command_test {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using Json = nlohmann::json;

void expectPoint(const Json& json, const glm::dvec3& expected, double tolerance = 1e-12) {
  ASSERT_EQ(json.size(), 3U);
  for (glm::length_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(json[static_cast<std::size_t>(i)].get<double>(), expected[i], tolerance);
  }
}

/// The scene mesh is a block whose top is the square [-1, 1]^2 at z = 0.5; the part is a cube of side 1.
class LmdCommand : public ::testing::Test {
 protected:
  ProcessResult run(std::vector<std::string> options) const {
    if (std::ranges::find(options, "--unit") == options.end())
      options.insert(options.begin(), {"--unit", "m"});
    options.insert(options.begin(), {"lmd", block_, cube_});
    return runCli(options);
  }
  Json only(const std::vector<std::string>& options) const {
    const ProcessResult result = run(options);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(result.err, "");
    EXPECT_EQ(linesOf(result.out).size(), 1U);
    return Json::parse(result.out);
  }

  TemporaryFolder folder_;
  std::string block_ = folder_.write("block.obj", objText(boxMesh({2, 2, 1}))).string();
  std::string cube_ = folder_.write("cube.obj", objText(boxMesh({1, 1, 1}))).string();
};

TEST_F(LmdCommand, CubeAboveBlockIsOneRegionAndPushesUp) {
  const Json json = only({"--cutoff", "0.5", "--pose", "0,0,1.25,1,0,0,0"});
  EXPECT_EQ(json["pose"], 0);
  ASSERT_EQ(json["lmds"].size(), 1U);
  const Json& lmd = json["lmds"][0];
  EXPECT_NEAR(lmd["distance"].get<double>(), 0.25, 1e-12);
  expectPoint(lmd["scene"], {0, 0, 0.5});
  expectPoint(lmd["part"], {0, 0, 0.75});
  EXPECT_EQ(lmd["region"], true);
  EXPECT_EQ(lmd["extent"]["dimension"], 2);
  EXPECT_NEAR(lmd["extent"]["measure"].get<double>(), 1.0, 1e-12);
  EXPECT_NEAR(lmd["extent"]["half"][0].get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(lmd["extent"]["half"][1].get<double>(), 0.5, 1e-12);
  // 200 N/m (0.5 m - 0.25 m)
  expectPoint(json["force"], {0, 0, 50}, 1e-9);
  expectPoint(json["torque"], {0, 0, 0}, 1e-9);
  EXPECT_GT(json["query_us"].get<double>(), 0.0);
}

// A region 140,000 sizes from the origin had the wrong dimension and measure, and nothing told of it.
TEST_F(LmdCommand, RegionsBeyondTenThousandSizesFromTheOriginAreMarked) {
  // The diagonals of block and cube are 3 and 1.73: 10,000 sizes are 47,321. Powers of two keep every coordinate.
  for (const auto& [away, isFar] : {std::pair{32'768.0, false}, std::pair{65'536.0, true}}) {
    const std::string block = folder_.write("away.obj", objText(boxMesh({2, 2, 1}, {away, 0, 0}))).string();
    for (const char* mode : {"cold", "tracked"}) {
      const ProcessResult result = runCli({"lmd", "--unit", "m", block, cube_, "--mode", mode, "--cutoff",
                                           "0.5", "--pose", fmt::format("{},0,1.25,1,0,0,0", away)});
      ASSERT_EQ(result.exitCode, 0) << result.err;
      const Json json = Json::parse(result.out);
      ASSERT_EQ(json["lmds"].size(), 1U) << away;
      EXPECT_EQ(json["lmds"][0]["region"], true) << away;
      EXPECT_EQ(json["lmds"][0]["marginal"], isFar) << away << ' ' << mode;
    }
  }
}

TEST_F(LmdCommand, OverhangingCubeIsTurnedAboutItsCentreOfMass) {
  // The faces overlap in x from 0.5 to 1, so that the region's centroid is 0.25 behind the centre at x = 1.
  const Json json = only({"--cutoff", "0.5", "--stiffness", "1000", "--pose", "1,0,1.25,1,0,0,0"});
  expectPoint(json["lmds"][0]["part"], {0.75, 0, 0.75});
  expectPoint(json["force"], {0, 0, 250}, 1e-9);
  expectPoint(json["torque"], {0, 62.5, 0}, 1e-9);
}

TEST_F(LmdCommand, NormalSpanRuleAddsWhatAJaggedVertexDoesNotCarry) {
  // A fan of steep valleys between shallow ridges; the tip of a tetrahedron stands over its apex, 0.1 away
  // and 30 degrees off its axis towards a ridge: nearer to that, and yet between the normals beside it.
  const std::string fan =
      folder_
          .write("fan.obj",
                 "v 0 0 0\nv 1 0 -.2\nv .7 .7 -1\nv 0 1 -.2\nv -.7 .7 -1\nv -1 0 -.2\n"
                 "v -.7 -.7 -1\nv 0 -1 -.2\nv .7 -.7 -1\nv 0 0 -3\n"
                 "f 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 6\nf 1 6 7\nf 1 7 8\nf 1 8 9\nf 1 9 2\n"
                 "f 10 3 2\nf 10 4 3\nf 10 5 4\nf 10 6 5\nf 10 7 6\nf 10 8 7\nf 10 9 8\n"
                 "f 10 2 9\n")
          .string();
  const std::string tip =
      folder_
          .write("tip.obj",
                 "v 0 0 0\nv .01 0 .2\nv -.01 .01 .2\nv -.01 -.01 .2\nf 1 3 2\nf 1 4 3\nf 1 2 4\nf 2 3 4\n")
          .string();
  const auto countOf = [&](const std::string& rule) {
    // Turned by -30 degrees about x, at 0.1 (0, sin 30, cos 30).
    const ProcessResult result =
        runCli({"lmd", "--unit", "m", fan, tip, "--cutoff", "0.11", "--rule", rule, "--pose",
                "0,0.05,0.08660254037844387,0.9659258262890683,-0.25881904510252074,0,0"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    const Json lmds = Json::parse(result.out)["lmds"];
    return std::ranges::count_if(
        lmds, [](const Json& lmd) { return std::abs(lmd["distance"].get<double>() - 0.1) < 1e-9; });
  };
  EXPECT_EQ(countOf("exact"), 0);
  EXPECT_EQ(countOf("normal-span"), 1);
  EXPECT_EQ(run({"--cutoff", "0.5", "--pose", "0,0,1.25,1,0,0,0", "--rule", "span"}).exitCode, 2);
}

TEST_F(LmdCommand, PrintedLawMultipliesByTheDistance) {
  const Json json =
      only({"--cutoff", "0.5", "--law", "printed", "--stiffness", "16", "--pose", "0,0,1.25,1,0,0,0"});
  expectPoint(json["force"], {0, 0, 16 * 0.25 * 0.25}, 1e-12);
}

TEST_F(LmdCommand, CubeOnItsCornerHasAVertexOverAFace) {
  // A turn about (1, -1, 0) that stands the cube's diagonal upright; the corner is half of sqrt(3) below its
  // centre.
  const double halfAngle = 0.5 * std::acos(1.0 / std::sqrt(3.0)), s = std::sin(halfAngle) / std::sqrt(2.0);
  char pose[200];
  std::snprintf(pose, sizeof pose, "0.1,0.2,%.17g,%.17g,%.17g,%.17g,0", 0.75 + 0.5 * std::sqrt(3.0),
                std::cos(halfAngle), s, -s);
  const Json json = only({"--cutoff", "0.5", "--pose", pose});
  ASSERT_EQ(json["lmds"].size(), 1U);
  const Json& lmd = json["lmds"][0];
  EXPECT_EQ(lmd["features"], Json({"face", "vertex"}));
  EXPECT_EQ(lmd["region"], false);
  EXPECT_FALSE(lmd.contains("extent"));
  expectPoint(lmd["scene"], {0.1, 0.2, 0.5});
  expectPoint(lmd["part"], {0.1, 0.2, 0.75});
}

TEST_F(LmdCommand, FollowingThePartFindsTheSameSetsAsSearchingAnewForEachPose) {
  std::string poses;
  for (int i = 0; i < 200; ++i) {
    const double angle = 0.005 * i;
    const int jump = i / 50;
    poses += fmt::format("{},{},{},{:.17g},0,{:.17g},0\n", 0.01 * i - 0.7 * jump, 0.3 * std::sin(0.05 * i),
                         1.6 - 0.002 * i, std::cos(angle), std::sin(angle));
  }
  const std::string file = folder_.write("poses.csv", poses).string();
  const auto setsBy = [&](const std::string& mode) {
    const ProcessResult result = run({"--cutoff", "0.5", "--poses", file, "--mode", mode});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    std::vector<Json> lines;
    for (const std::string& line : linesOf(result.out)) {
      lines.push_back(Json::parse(line));
      lines.back().erase("query_us");
    }
    return lines;
  };
  const std::vector<Json> cold = setsBy("cold");
  ASSERT_EQ(cold.size(), 200U);
  EXPECT_FALSE(cold[60]["lmds"].empty());
  EXPECT_EQ(setsBy("tracked"), cold);
  EXPECT_NE(run({"--cutoff", "0.5", "--poses", file, "--mode", "warm"}).exitCode, 0);
}

TEST_F(LmdCommand, MinimumThroughAnotherPartOfTheMeshIsBlockedAndPushesNothing) {
  // A thin plate floats 0.1 above the block; the cube is 0.05 above the plate.
  block_ =
      folder_.write("plated.obj", objText(joined(boxMesh({2, 2, 1}), boxMesh({2, 2, 0.01}, {0, 0, 0.605}))))
          .string();
  const Json json = only({"--cutoff", "0.5", "--pose", "0,0,1.16,1,0,0,0"});
  ASSERT_EQ(json["lmds"].size(), 2U);
  EXPECT_NEAR(json["lmds"][0]["distance"].get<double>(), 0.05, 1e-12);
  EXPECT_EQ(json["lmds"][0]["blocked"], false);
  EXPECT_NEAR(json["lmds"][1]["distance"].get<double>(), 0.16, 1e-12);
  EXPECT_EQ(json["lmds"][1]["blocked"], true);
  expectPoint(json["force"], {0, 0, 200 * (0.5 - 0.05)}, 1e-9);
}

TEST_F(LmdCommand, CornersThatFaceEachOtherAreVertices) {
  // From (1, 1, 0.5) to (1.3, 1.4, 1.7): sides 0.3, 0.4 and 1.2.
  const Json json = only({"--cutoff", "2", "--pose", "1.8,1.9,2.2,1,0,0,0"});
  ASSERT_EQ(json["lmds"].size(), 1U);
  const Json& lmd = json["lmds"][0];
  EXPECT_EQ(lmd["features"], Json({"vertex", "vertex"}));
  EXPECT_NEAR(lmd["distance"].get<double>(), 1.3, 1e-12);
  expectPoint(lmd["scene"], {1, 1, 0.5});
  expectPoint(lmd["part"], {1.3, 1.4, 1.7});
}

TEST_F(LmdCommand, NothingWithinTheCutoffIsAnEmptySetWithoutForce) {
  const Json json = only({"--cutoff", "0.2", "--pose", "0,0,1.25,1,0,0,0"});
  EXPECT_TRUE(json["lmds"].empty());
  expectPoint(json["force"], {0, 0, 0});
  expectPoint(json["torque"], {0, 0, 0});
}

TEST_F(LmdCommand, BodiesThatOverlapAreToldOfAlsoWhereTheSetIsEmpty) {
  const auto csv = folder_.write("poses.csv",
                                 "0,0,1.25,1,0,0,0\n"  // Apart.
                                 "0,0,0.75,1,0,0,0\n"  // Half in.
                                 "0,0,1,1,0,0,0\n"     // Touching.
                                 "0,0,5,1,0,0,0\n");
  const ProcessResult result = run({"--cutoff", "0.1", "--poses", csv.string()});
  EXPECT_EQ(result.exitCode, 0);
  std::vector<std::string> overlaps;
  for (const std::string& line : linesOf(result.out))
    overlaps.push_back(Json::parse(line)["overlap"].get<std::string>());
  EXPECT_EQ(overlaps, (std::vector<std::string>{"no", "surfaces meet", "surfaces meet", "no"}));
  EXPECT_EQ(result.err,
            "nearfit-cli: note: the bodies overlap at 2 of 4 poses, the first of them pose 1; minima do not "
            "tell how far\n");

  cube_ = folder_.write("small.obj", objText(boxMesh({0.1, 0.1, 0.1}))).string();
  const ProcessResult inside = run({"--cutoff", "0.1", "--pose", "0,0,0,1,0,0,0"});
  EXPECT_EQ(inside.exitCode, 0);
  EXPECT_TRUE(Json::parse(inside.out)["lmds"].empty());
  EXPECT_EQ(Json::parse(inside.out)["overlap"], "inside the other");
  EXPECT_EQ(inside.err, "nearfit-cli: note: the bodies overlap; minima do not tell how far\n");
}

TEST_F(LmdCommand, SeveralMinimaComeNearestFirst) {
  // Two cubes in one part, 0.25 and 0.375 above the block.
  cube_ = folder_
              .write("two.obj", objText(joined(boxMesh({0.5, 0.5, 0.5}, {0.6, 0, 0.375}),
                                               boxMesh({0.5, 0.5, 0.5}, {-0.6, 0, 0.25}))))
              .string();
  const Json json = only({"--cutoff", "0.5", "--pose", "0,0,0.75,1,0,0,0"});
  ASSERT_EQ(json["lmds"].size(), 2U);
  EXPECT_NEAR(json["lmds"][0]["distance"].get<double>(), 0.25, 1e-12);
  EXPECT_NEAR(json["lmds"][1]["distance"].get<double>(), 0.375, 1e-12);
  expectPoint(json["force"], {0, 0, 200 * (0.25 + 0.125)}, 1e-9);
}

TEST_F(LmdCommand, CutoffAtTheVeryDistanceIsMarginal) {
  EXPECT_EQ(only({"--cutoff", "0.25", "--pose", "0,0,1.25,1,0,0,0"})["lmds"][0]["marginal"], true);
  EXPECT_EQ(only({"--cutoff", "0.5", "--pose", "0,0,1.25,1,0,0,0"})["lmds"][0]["marginal"], false);
}

TEST_F(LmdCommand, LineHasExactlyThePromisedForm) {
  const ProcessResult result = run({"--cutoff", "0.5", "--pose", "0.1,0,1.25,1,0,0,0"});
  const std::string n = "-?[0-9.]+(e[-+][0-9]+)?", v = "\\[" + n + "," + n + "," + n + "\\]";
  const std::string extent =
      "\\{\"dimension\":2,\"measure\":" + n + ",\"axis\":" + v + ",\"half\":\\[" + n + "," + n + "\\]\\}";
  const std::string line =
      "\\{\"pose\":0,\"lmds\":\\[\\{\"distance\":" + n + ",\"scene\":" + v + ",\"part\":" + v +
      ",\"features\":\\[\"(vertex|edge|face)\",\"(vertex|edge|face)\"\\]," +
      "\"region\":true,\"extent\":" + extent + ",\"blocked\":false,\"marginal\":false\\}\\]," +
      "\"force\":" + v + ",\"torque\":" + v + ",\"overlap\":\"no\",\"query_us\":" + n + "\\}\n";
  EXPECT_THAT(result.out, MatchesRegex(line));
}

TEST_F(LmdCommand, NumbersCarrySeventeenDigits) {
  // 1.3 is no double: its seventeen digits are not the two that print it shortest.
  const ProcessResult result = run({"--cutoff", "0.5", "--pose", "0,0,1.3,1,0,0,0"});
  const double bottom = Json::parse(result.out)["lmds"][0]["part"][2].get<double>();
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.17g", bottom);
  EXPECT_GE(std::string(digits).size(), 18U);
  EXPECT_THAT(result.out, HasSubstr(std::string(",") + digits + "]"));
}

TEST_F(LmdCommand, PosesComeFromAFileInItsOrder) {
  const auto csv = folder_.write("poses.csv",
                                 "# distances 0.25, none, 0.125\n"
                                 "tx,ty,tz,qw,qx,qy,qz\n"
                                 "0,0,1.25,1,0,0,0\n"
                                 "# a remark in between\n"
                                 "0,0,5,1,0,0,0\n"
                                 "0,0,1.125,0.99995,0,0,0\n");
  const ProcessResult result = run({"--cutoff", "0.5", "--poses", csv.string()});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const std::vector<std::string> lines = linesOf(result.out);
  ASSERT_EQ(lines.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(Json::parse(lines[i])["pose"], i);
  EXPECT_NEAR(Json::parse(lines[0])["lmds"][0]["distance"].get<double>(), 0.25, 1e-12);
  EXPECT_TRUE(Json::parse(lines[1])["lmds"].empty());
  EXPECT_NEAR(Json::parse(lines[2])["lmds"][0]["distance"].get<double>(), 0.125, 1e-12);
}

TEST_F(LmdCommand, UnitScalesTheMeshesButNotPoseAndCutoff) {
  const Json json = only({"--unit", "mm", "--cutoff", "0.0005", "--pose", "0,0,0.00125,1,0,0,0"});
  ASSERT_EQ(json["lmds"].size(), 1U);
  EXPECT_NEAR(json["lmds"][0]["distance"].get<double>(), 0.00025, 1e-15);
}

TEST_F(LmdCommand, FirstNumberOfAPoseMayBeNegative) {
  for (const char* pose : {"-0.5,0,1.25,1,0,0,0", "-.5,0,1.25,1,0,0,0"}) {
    expectPoint(only({"--cutoff", "0.5", "--pose", pose})["lmds"][0]["part"], {-0.5, 0, 0.75});
  }
}

TEST_F(LmdCommand, MeshAgainstItselfWorks) {
  cube_ = block_;
  EXPECT_NEAR(only({"--cutoff", "0.5", "--pose", "0,0,1.25,1,0,0,0"})["lmds"][0]["distance"].get<double>(),
              0.25, 1e-12);
}

TEST_F(LmdCommand, OpenMeshIsWarnedOfAndQueriedAllTheSame) {
  // A square of two triangles has four open edges.
  cube_ = folder_.write("square.obj", objText(squareMesh(1, 1))).string();
  const ProcessResult result = run({"--cutoff", "0.5", "--pose", "0,0,0.75,0,1,0,0"});
  EXPECT_EQ(result.exitCode, 0);
  ASSERT_EQ(linesOf(result.err).size(), 1U) << result.err;
  EXPECT_THAT(result.err, MatchesRegex("nearfit-cli: warning: .*square.obj: 4 edges are open.*\n"));
  EXPECT_NEAR(Json::parse(result.out)["lmds"][0]["distance"].get<double>(), 0.25, 1e-12);
}

TEST_F(LmdCommand, WrongUsageIsToldInOneLine) {
  const std::string pose = "0,0,1.25,1,0,0,0";
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{"--pose", pose}, "--cutoff"},
      {{"--cutoff", "0.5"}, "--pose"},
      {{"--cutoff", "0.5", "--pose", pose, "--poses", "x.csv"}, "--pose"},
      {{"--cutoff", "0", "--pose", pose}, "--cutoff"},
      {{"--cutoff", "-1", "--pose", pose}, "--cutoff"},
      {{"--cutoff", "nan", "--pose", pose}, "--cutoff"},
      {{"--cutoff", "inf", "--pose", pose}, "--cutoff"},
      {{"--cutoff", "1mm", "--pose", pose}, "--cutoff"},
      {{"--cutoff", "1", "--pose", "0,0,1.25"}, "not a pose"},
      {{"--cutoff", "1", "--pose", "0,0,1.25,1,0,0,0,0"}, "not a pose"},
      {{"--cutoff", "1", "--pose", "0,0,1.25,1,0,0,x"}, "not a pose"},
      {{"--cutoff", "1", "--pose", "nan,0,1.25,1,0,0,0"}, "not finite"},
      {{"--cutoff", "1", "--pose", "0,0,1.25,2,0,0,0"}, "quaternion"},
      {{"--cutoff", "1", "--pose", "0,0,1.25,0,0,0,0"}, "quaternion"},
      {{"--cutoff", "1", "--pose", pose, "--stiffness", "-1"}, "--stiffness"},
      {{"--cutoff", "1", "--pose", pose, "--law", "cubic"}, "--law"},
      {{"--cutoff", "1", "--pose", pose, "--unit", "mile"}, "--unit"},
  };
  for (const auto& [options, problem] : wrong) {
    const ProcessResult result = run(options);
    EXPECT_EQ(result.exitCode, 2) << ::testing::PrintToString(options);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
    EXPECT_THAT(result.err, HasSubstr(problem));
  }
}

TEST_F(LmdCommand, FilesThatFailAreToldInOneLine) {
  const auto csv = folder_.write("poses.csv", "0,0,1,1,0,0,0\n0,0,1,1,0,0\n");
  ProcessResult result = run({"--cutoff", "1", "--poses", csv.string()});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_THAT(result.err, HasSubstr("poses.csv:2"));
  EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
  cube_ = (folder_.path() / "none.stl").string();
  result = run({"--cutoff", "1", "--pose", "0,0,1.25,1,0,0,0"});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_THAT(result.err, HasSubstr("none.stl"));
  EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
}

}  // namespace
}  // namespace nearfit::test::lmd_command_test
