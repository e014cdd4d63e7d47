#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/files/sha256.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test::info_command_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

class InfoCommand : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const TriangleMesh& mesh) const {
    return folder_.write(name, objText(mesh)).string();
  }
  TemporaryFolder folder_;
};

TEST_F(InfoCommand, BoxIsDescribedInJson) {
  const std::string file = write("box.obj", boxMesh({20, 30, 40}, {100, 0, 0}));
  const ProcessResult result = runCli({"info", "--json", "--unit", "mm", file});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  ASSERT_EQ(linesOf(result.out).size(), 1U);
  const Json json = Json::parse(result.out);
  EXPECT_EQ(json["file"], file);
  EXPECT_EQ(json["sha256"], sha256OfFile(file));
  EXPECT_EQ(json["triangles"], 12);
  EXPECT_EQ(json["vertices"], 8);
  EXPECT_EQ(json["closed"], true);
  EXPECT_EQ(json["oriented"], true);
  EXPECT_EQ(json["components"], 1);
  EXPECT_EQ(json["edges"],
            Json({{"total", 18}, {"open", 0}, {"nonManifold", 0}, {"inconsistent", 0}, {"stitched", 0}}));
  // The six diagonals of the faces are flat edges, which carry no minimum.
  EXPECT_EQ(json["features"]["kept"], Json({{"vertices", 8}, {"edges", 12}, {"faces", 12}, {"total", 32}}));
  EXPECT_EQ(json["features"]["all"], Json({{"vertices", 8}, {"edges", 18}, {"faces", 12}, {"total", 38}}));
  EXPECT_NEAR(json["bounds"]["lower"][0].get<double>(), 0.09, 1e-12);
  EXPECT_NEAR(json["bounds"]["upper"][2].get<double>(), 0.02, 1e-12);
  EXPECT_EQ(json["mass"]["basis"], "volume integrals");
  EXPECT_NEAR(json["mass"]["volume"].get<double>(), 24e-6, 1e-15);
  EXPECT_NEAR(json["mass"]["centre"][0].get<double>(), 0.1, 1e-12);
  EXPECT_EQ(json["hierarchy"]["from"], "building");
  EXPECT_GT(json["hierarchy"]["seconds"].get<double>(), 0.0);
  EXPECT_GT(json["bytes"]["mesh"].get<double>(), 8 * 24 + 12 * 12);
  EXPECT_GT(json["bytes"]["hierarchy"].get<double>(), 0.0);
  EXPECT_EQ(json["turnedInsideOut"], false);
}

TEST_F(InfoCommand, FinelyCutFlatsAreSearchedAsIfTheyWereNot) {
  const ProcessResult result =
      runCli({"info", "--unit", "m", "--json", write("box.obj", subdivided(boxMesh({1, 2, 3}), 3))});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const Json json = Json::parse(result.out);
  EXPECT_EQ(json["triangles"], 12 * 64);
  EXPECT_EQ(json["searched"]["triangles"], 12);
  EXPECT_LT(json["searched"]["deviation"].get<double>(), 1e-5);
  EXPECT_EQ(json["features"]["kept"], Json({{"vertices", 8}, {"edges", 12}, {"faces", 12}, {"total", 32}}));
}

TEST_F(InfoCommand, TextSaysTheSame) {
  const ProcessResult result = runCli({"info", "--unit", "m", write("box.obj", boxMesh({1, 1, 1}))});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("box.obj\n"), HasSubstr("triangles   12\n"), HasSubstr("closed      yes\n"),
                    HasSubstr("components  1\n"), HasSubstr("18: 0 open, 0 non-manifold, 0 inconsistent\n"),
                    HasSubstr("32 kept of 38: 8 of 8 vertices, 12 of 18 edges, 12 of 12 faces\n"),
                    HasSubstr("searched    12 triangles, once flats are merged"),
                    HasSubstr("by volume integrals: volume 1 m^3")));
}

TEST_F(InfoCommand, DensityGivesMassAndInertiaAboutTheCentre) {
  // Of 20 x 30 x 40 mm in steel: 24 cm^3, and m (b^2 + c^2) / 12 about each axis.
  const std::string file = write("box.obj", boxMesh({20, 30, 40}, {100, 0, 0}));
  const ProcessResult result = runCli({"info", "--json", "--unit", "mm", "--density", "7850", file});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const Json mass = Json::parse(result.out)["mass"];
  constexpr double kMass = 7850 * 24e-6;
  EXPECT_EQ(mass["density"], 7850.0);
  EXPECT_NEAR(mass["mass"].get<double>(), kMass, 1e-12);
  const std::vector<double> expected{kMass / 12 * (9e-4 + 16e-4), kMass / 12 * (4e-4 + 16e-4),
                                     kMass / 12 * (4e-4 + 9e-4)};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(mass["inertia"][i][j].get<double>(), i == j ? expected[i] : 0.0, 1e-15);
  }
  EXPECT_FALSE(Json::parse(runCli({"info", "--unit", "m", "--json", file}).out)["mass"].contains("mass"));
  EXPECT_THAT(runCli({"info", "--unit", "mm", "--density", "1000", file}).out,
              AllOf(HasSubstr("weighs      0.024 kg at 1000 kg/m^3\n"), HasSubstr("inertia     (5e-06, ")));
  for (const char* density : {"0", "-1", "nan", "1e9", "steel"}) {
    const ProcessResult refused = runCli({"info", "--unit", "m", "--density=" + std::string(density), file});
    EXPECT_EQ(refused.exitCode, 2) << density;
    EXPECT_THAT(refused.err, HasSubstr("density"));
  }
}

TEST_F(InfoCommand, OpenMeshSaysItsEdgesAndItsMassBasis) {
  // A square of two triangles: four open edges and the diagonal.
  const ProcessResult result =
      runCli({"info", "--unit", "m", "--json", write("square.obj", squareMesh(1, 1))});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const Json json = Json::parse(result.out);
  EXPECT_EQ(json["closed"], false);
  EXPECT_EQ(json["edges"]["open"], 4);
  EXPECT_EQ(json["edges"]["total"], 5);
  EXPECT_EQ(json["mass"]["basis"], "oriented box");
  EXPECT_FALSE(json["warnings"].empty());
}

TEST_F(InfoCommand, TwoBodiesInOneMeshAreTwoComponents) {
  const TriangleMesh mesh = joined(boxMesh({1, 1, 1}), boxMesh({1, 1, 1}, {5, 0, 0}));
  EXPECT_EQ(Json::parse(runCli({"info", "--unit", "m", "--json", write("two.obj", mesh)}).out)["components"],
            2);
}

TEST_F(InfoCommand, UnitsScaleToMetres) {
  const std::string file = write("box.obj", boxMesh({2, 2, 2}));
  const auto upperWith = [&](const std::string& unit) {
    return Json::parse(runCli({"info", "--json", "--unit", unit, file}).out)["bounds"]["upper"][0]
        .get<double>();
  };
  EXPECT_NEAR(upperWith("m"), 1.0, 1e-12);
  EXPECT_NEAR(upperWith("cm"), 0.01, 1e-14);
  EXPECT_NEAR(upperWith("mm"), 0.001, 1e-15);
  EXPECT_NEAR(upperWith("um"), 1e-6, 1e-18);
  EXPECT_NEAR(upperWith("in"), 0.0254, 1e-14);
  EXPECT_NEAR(upperWith("ft"), 0.3048, 1e-13);
  EXPECT_NEAR(upperWith("2.5e-3"), 0.0025, 1e-15);
  for (const char* unit : {"0", "-1", "nan", "inf", "1e99", "mm2", ""}) {
    EXPECT_EQ(runCli({"info", "--unit=" + std::string(unit), file}).exitCode, 2) << unit;
  }
}

TEST_F(InfoCommand, MeshThatFailsLeavesTheOthersReported) {
  const std::string first = write("first.obj", boxMesh({1, 1, 1})),
                    last = write("last.obj", tetrahedronMesh(1));
  const std::string bad = folder_.write("bad.obj", "no mesh").string(),
                    none = (folder_.path() / "none.stl").string();
  const ProcessResult result = runCli({"info", "--unit", "m", "--json", first, bad, none, last});
  EXPECT_EQ(result.exitCode, 1);
  const std::vector<std::string> lines = linesOf(result.out), errors = linesOf(result.err);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(Json::parse(lines[0])["triangles"], 12);
  EXPECT_EQ(Json::parse(lines[1])["triangles"], 4);
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_THAT(errors[0], HasSubstr("bad.obj"));
  EXPECT_THAT(errors[1], HasSubstr("none.stl"));
}

TEST_F(InfoCommand, FullDiskIsAnError) {
  ProcessOptions full;
  full.stdoutPath = "/dev/full";
  const ProcessResult result = runCli({"info", "--unit", "m", write("box.obj", boxMesh({1, 1, 1}))}, full);
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
}

}  // namespace
}  // namespace nearfit::test::info_command_test
