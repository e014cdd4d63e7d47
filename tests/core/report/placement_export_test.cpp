#include "core/report/placement_export.h"

#include <cmath>
#include <ctime>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::placement_export_test {
namespace {

using Json = nlohmann::json;

void expectPoint(const Json& json, const glm::dvec3& expected) {
  ASSERT_EQ(json.size(), 3U);
  for (glm::length_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(json[static_cast<std::size_t>(i)].get<double>(), expected[i], 1e-12);
  }
}

/// A block 1 thick along its z, which a quarter turn about y lays along the world's x: its top face is at
/// x = 10.5. A cube of side 1 faces it. A hidden part is in between, another one is far away.
class PlacementExport : public ::testing::Test {
 protected:
  PlacementExport() {
    Part part;
    part.geometry = load("block.obj", test::boxMesh({2, 2, 1}));
    part.name = "Block";
    part.worldFromPart = {glm::dquat{std::sqrt(0.5), 0, std::sqrt(0.5), 0}, {10, 0, 0}};
    scene_.add(part);
    part.geometry = load("cube.obj", test::boxMesh({1, 1, 1}));
    part.name = "Cube";
    part.worldFromPart = {};
    scene_.setMovingPart(scene_.add(part));
    part.name = "Hidden";
    part.worldFromPart.translation = {10.6, 0, 2};
    part.isVisible = false;
    scene_.add(part);
    part.name = "Far";
    part.worldFromPart.translation = {100, 0, 0};
    part.isVisible = true;
    scene_.add(part);
    HapticSettings haptics;
    haptics.springs.cutoff = 0.5;
    scene_.setHaptics(haptics);
  }
  PartGeometryPtr load(const std::string& name, const TriangleMesh& mesh) {
    return loadPartGeometry(folder_.write(name, test::objText(mesh)), 1.0);
  }
  static RigidTransform at(double x) { return {{1, 0, 0, 0}, {x, 0, 0}}; }

  test::TemporaryFolder folder_;
  Scene scene_;
};

TEST_F(PlacementExport, SaysWhatItIsAndWhenItWasMade) {
  const std::time_t before = std::time(nullptr);
  const Json json = Json::parse(placementJson(scene_, at(11.25)));
  const std::time_t after = std::time(nullptr);
  EXPECT_EQ(json["placement"], 1);
  EXPECT_THAT(json["program"].get<std::string>(), ::testing::StartsWith("Nearfit "));
  EXPECT_EQ(json["units"]["length"], "m");
  EXPECT_EQ(json["moving"], "Cube");
  std::tm date{};
  const std::string text = json["date"].get<std::string>();
  const char* const end = ::strptime(text.c_str(), "%Y-%m-%dT%H:%M:%SZ", &date);
  ASSERT_TRUE(end != nullptr && *end == '\0') << text;
  EXPECT_GE(::timegm(&date), before);
  EXPECT_LE(::timegm(&date), after);
}

TEST_F(PlacementExport, PosesAreGivenAsMatrixAndAsPositionWithQuaternion) {
  const Json block = Json::parse(placementJson(scene_, at(11.25)))["parts"][0];
  EXPECT_EQ(block["name"], "Block");
  EXPECT_EQ(block["mesh"], std::filesystem::canonical(folder_.path() / "block.obj").string());
  EXPECT_EQ(block["sha256"], scene_.parts()[0]->geometry->sha256);
  EXPECT_EQ(block["metresPerUnit"], 1.0);
  const double expected[4][4] = {{0, 0, 1, 10}, {0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 0, 1}};
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      EXPECT_NEAR(block["matrix"][row][column].get<double>(), expected[row][column], 1e-15)
          << row << "," << column;
    }
  }
  expectPoint(block["position"], {10, 0, 0});
  EXPECT_EQ(block["quaternion"], Json({std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0}));
}

TEST_F(PlacementExport, MovingPartIsWhereTheHandHasIt) {
  const Json cube = Json::parse(placementJson(scene_, at(11.25)))["parts"][1];
  expectPoint(cube["position"], {11.25, 0, 0});
  EXPECT_EQ(cube["matrix"][0][3], 11.25);
}

TEST_F(PlacementExport, ClearanceToEachVisiblePartIsInTheWorldFrame) {
  const Json clearance = Json::parse(placementJson(scene_, at(11.25)))["clearance"];
  EXPECT_EQ(clearance["cutoff"], 0.5);
  EXPECT_NEAR(clearance["distance"].get<double>(), 0.25, 1e-12);
  EXPECT_EQ(clearance["mass"]["basis"], "volume integrals");
  EXPECT_NEAR(clearance["mass"]["volume"].get<double>(), 1.0, 1e-12);
  expectPoint(clearance["mass"]["centre"], {11.25, 0, 0});

  ASSERT_EQ(clearance["to"].size(), 2U);
  const Json& block = clearance["to"][0];
  EXPECT_EQ(block["part"], "Block");
  EXPECT_EQ(block["complete"], true);
  ASSERT_EQ(block["lmds"].size(), 1U);
  const Json& lmd = block["lmds"][0];
  EXPECT_NEAR(lmd["distance"].get<double>(), 0.25, 1e-12);
  expectPoint(lmd["other"], {10.5, 0, 0});
  expectPoint(lmd["moving"], {10.75, 0, 0});
  EXPECT_EQ(lmd["region"], true);
  EXPECT_EQ(lmd["extent"]["dimension"], 2);
  EXPECT_NEAR(lmd["extent"]["measure"].get<double>(), 1.0, 1e-12);
  EXPECT_NEAR(lmd["extent"]["axis"][0].get<double>(), 0.0, 1e-12);  // Square to the world's x.
  EXPECT_NEAR(lmd["extent"]["half"][1].get<double>(), 0.5, 1e-12);
  EXPECT_EQ(lmd["blocked"], false);
  EXPECT_EQ(lmd["marginal"], false);
  EXPECT_EQ(lmd["features"].size(), 2U);

  const Json& far = clearance["to"][1];
  EXPECT_EQ(far["part"], "Far");
  EXPECT_TRUE(far["distance"].is_null());
  EXPECT_TRUE(far["lmds"].empty());
}

// A region 140,000 sizes from the origin had the wrong dimension and measure, and nothing told of it.
TEST_F(PlacementExport, ARegionFarFromTheOriginOfTheWorldIsMarked) {
  // The diagonals of block and cube are 3 and 1.73: 10,000 sizes are 47,321.
  for (const auto& [away, isFar] : {std::pair{32'768.0, false}, std::pair{65'536.0, true}}) {
    Part block = *scene_.parts()[0];
    block.worldFromPart.translation.x = away;
    scene_.replace(block);
    const Json json = Json::parse(placementJson(scene_, at(away + 1.25)));
    const Json& lmds = json["clearance"]["to"][0]["lmds"];
    ASSERT_EQ(lmds.size(), 1U) << away;
    EXPECT_EQ(lmds[0]["region"], true) << away;
    EXPECT_EQ(lmds[0]["marginal"], isFar) << away;
  }
}

TEST_F(PlacementExport, FeaturesAreTheMovingPartsFirst) {
  // The cube stands on a corner: its diagonal lies along x.
  const double diagonal = std::sqrt(3.0), angle = std::acos(1.0 / diagonal);
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.0, 1.0, -1.0));
  const glm::dquat q = glm::angleAxis(angle, axis);
  ASSERT_NEAR((q * glm::dvec3(1.0)).x, diagonal, 1e-12);
  const RigidTransform pose{q, {10.5 + 0.1 + 0.5 * diagonal, 0, 0}};
  const Json lmd = Json::parse(placementJson(scene_, pose))["clearance"]["to"][0]["lmds"][0];
  EXPECT_EQ(lmd["features"], Json({"vertex", "face"}));
  EXPECT_EQ(lmd["region"], false);
  EXPECT_NEAR(lmd["distance"].get<double>(), 0.1, 1e-12);
}

TEST_F(PlacementExport, MinimumThroughAnotherPartOfTheMeshIsBlocked) {
  // Two plates in one mesh, facing the cube one behind the other.
  Part plates;
  plates.geometry = load("plates.obj", test::joined(test::boxMesh({0.1, 2, 2}, {0.05, 0, 0}),
                                                    test::boxMesh({0.1, 2, 2}, {-0.15, 0, 0})));
  plates.name = "Plates";
  plates.worldFromPart = {{1, 0, 0, 0}, {20, 0, 0}};
  scene_.add(plates);
  const Json json = Json::parse(placementJson(scene_, at(20.1 + 0.05 + 0.5)));
  const Json& lmds = json["clearance"]["to"].back()["lmds"];
  ASSERT_EQ(lmds.size(), 2U);
  EXPECT_NEAR(lmds[0]["distance"].get<double>(), 0.05, 1e-12);
  EXPECT_EQ(lmds[0]["blocked"], false);
  EXPECT_NEAR(lmds[1]["distance"].get<double>(), 0.25, 1e-12);
  EXPECT_EQ(lmds[1]["blocked"], true);
}

TEST_F(PlacementExport, NothingWithinTheCutoffIsNull) {
  const Json clearance = Json::parse(placementJson(scene_, at(50)))["clearance"];
  EXPECT_TRUE(clearance["distance"].is_null());
}

TEST_F(PlacementExport, SceneWithoutMovingPartHasNoClearance) {
  scene_.setMovingPart(std::nullopt);
  const Json json = Json::parse(placementJson(scene_, {}));
  EXPECT_TRUE(json["moving"].is_null());
  EXPECT_TRUE(json["clearance"].is_null());
  EXPECT_EQ(json["parts"].size(), 4U);
}

TEST_F(PlacementExport, SameSceneGivesTheSameTextButForTheDate) {
  Json a = Json::parse(placementJson(scene_, at(11.25))), b = Json::parse(placementJson(scene_, at(11.25)));
  a.erase("date");
  b.erase("date");
  EXPECT_EQ(a.dump(), b.dump());
}

TEST_F(PlacementExport, PoseThatIsNoneIsRefused) {
  EXPECT_THROW(placementJson(scene_, at(std::nan(""))), UsageError);
}

TEST_F(PlacementExport, FileIsWrittenWholeOrNotAtAll) {
  const std::filesystem::path file = folder_.path() / "placement.json";
  exportPlacement(scene_, at(11.25), file);
  EXPECT_EQ(Json::parse(test::readBytes(file))["moving"], "Cube");
  EXPECT_THROW(exportPlacement(scene_, at(11.25), folder_.path() / "none/placement.json"), FileError);
}

}  // namespace
}  // namespace nearfit::placement_export_test
