#include "core/report/scene_check_export.h"

#include <array>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/parallel/parallel_for.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/random_values.h"

namespace nearfit::scene_check_export_test {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

RigidTransform at(const glm::dvec3& place) {
  return {glm::dquat(1, 0, 0, 0), place};
}

/// A box, one that clashes with it by 0.1, and one that is 0.2 away.
Scene boxes() {
  Scene scene;
  scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "=Box"));
  scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "Lid, upper", at({0, 0, 0.9})));
  scene.add(test::partOf(test::geometryOf(test::boxMesh(glm::dvec3(1.0))), "Side", at({1.2, 0, 0})));
  return scene;
}

TEST(SceneCheckExport, JsonSaysVerdictsMeasuresAndCounts) {
  Scene scene = boxes();
  scene.setPairRules({{PairRuleKind::LeaveOut, "Lid*", "Side"}});
  const SceneCheck check = checkScene(sceneCheckRequest(scene, 0.25));
  const Json json = Json::parse(sceneCheckJson(scene, check, compareFindings(check, {})));
  EXPECT_EQ(json["threshold"], 0.25);
  EXPECT_EQ(json["counts"]["pairs"], 2);
  EXPECT_EQ(json["counts"]["leftOut"], 1);
  EXPECT_EQ(json["counts"]["clash"], 1);
  EXPECT_EQ(json["counts"]["near"], 1);
  EXPECT_EQ(json["counts"]["forbidden"], 1);
  ASSERT_EQ(json["findings"].size(), 2U);
  const Json &clash = json["findings"][0], &near = json["findings"][1];
  EXPECT_EQ(clash["verdict"], "clash");
  EXPECT_EQ(clash["part"], "=Box");
  EXPECT_EQ(clash["allowed"], false);
  EXPECT_NEAR(clash["clash"]["volume"].get<double>(), 0.1, 1e-12);
  EXPECT_NEAR(clash["clash"]["depth"]["length"].get<double>(), 0.1, 1e-12);
  EXPECT_EQ(clash["clash"]["depth"]["exact"], true);
  EXPECT_FALSE(clash["clash"]["curves"].empty());
  EXPECT_EQ(clash["clash"]["interference"], nullptr);
  EXPECT_EQ(near["verdict"], "near");
  EXPECT_NEAR(near["distance"].get<double>(), 0.2, 1e-12);
  EXPECT_NEAR(near["points"]["part"][0].get<double>(), 0.5, 1e-12);
  ASSERT_EQ(near["minima"].size(), 1U);
  EXPECT_EQ(near["clash"], nullptr);
  EXPECT_EQ(json["leftOut"][0]["rule"], 0);
}

TEST(SceneCheckExport, CsvHasHarmlessCellsAndARowForEachFinding) {
  const Scene scene = boxes();
  const SceneCheck check = checkScene(sceneCheckRequest(scene, 0.25));
  const std::string csv = sceneCheckCsv(scene, check, compareFindings(check, {}));
  EXPECT_THAT(csv, HasSubstr("\"'=Box\",\"Lid, upper\",clash,0,,new,new,,0,"));
  EXPECT_THAT(csv, HasSubstr("\"'=Box\",Side,near,1,,new,new,,0."));
  const auto columns = [](const std::string& line) {
    bool isQuoted = false;
    std::size_t count = 1;
    for (const char c : line) {
      if (c == '"') isQuoted = !isQuoted;
      if (c == ',' && !isQuoted) ++count;
    }
    return count;
  };
  std::size_t lines = 0;
  for (std::size_t begin = 0; begin < csv.size(); ++lines) {
    const std::size_t end = csv.find('\n', begin);
    EXPECT_EQ(columns(csv.substr(begin, end - begin)), 29U);
    begin = end + 1;
  }
  EXPECT_EQ(lines, 1 + check.findings.size());
}

TEST(SceneCheckExport, TheTableBeginsWithTheWorstAndTellsWhatIsGone) {
  const Scene scene = boxes();
  const SceneCheck check = checkScene(sceneCheckRequest(scene, 0.25));
  const SceneCheck nothing = checkScene(sceneCheckRequest(scene, 0.01));
  const std::vector<PairRecord> before = recordsOf(compareFindings(check, {}));
  const std::string table = sceneCheckTable(scene, check, compareFindings(check, before));
  EXPECT_LT(table.find("clash "), table.find("near "));
  EXPECT_THAT(table, HasSubstr("=Box | Lid, upper"));
  EXPECT_THAT(sceneCheckTable(scene, nothing, compareFindings(nothing, before)), HasSubstr("gone"));
  EXPECT_EQ(sceneCheckSummary(check, compareFindings(check, {})),
            "3 pairs checked, 0 left out: 0 clear, 2 near, 0 touching, 1 clashes, 0 contained; "
            "1 not allowed\n");
  std::vector<PairRecord> accepted = before;
  accepted[0].state = FindingState::Accepted;
  accepted[0].reason = "glued";
  const std::vector<ComparedFinding> compared = compareFindings(check, accepted);
  EXPECT_THAT(sceneCheckSummary(check, compared), HasSubstr("; 1 not allowed, 1 of them accepted\n"));
  EXPECT_EQ(Json::parse(sceneCheckJson(scene, check, compared))["counts"]["accepted"], 1);
}

TEST(SceneCheckExport, EachFormSaysWhatTheLastCheckFound) {
  Scene scene = boxes();
  const SceneCheck first = checkScene(sceneCheckRequest(scene, 0.25));
  EXPECT_EQ(sceneCheckChanges(compareFindings(first, {})), "") << "nothing was checked before";
  std::vector<PairRecord> before = recordsOf(compareFindings(first, {}));
  // The clash was accepted, and then was deeper than it is; the other one is where it was.
  ASSERT_EQ(before.size(), 3U);
  before[0].state = FindingState::Accepted;
  before[0].reason = "glued";
  before[0].depth = 0.05;
  const std::vector<ComparedFinding> compared = compareFindings(first, before);
  const Json json = Json::parse(sceneCheckJson(scene, first, compared));
  const Json &clash = json["findings"][0], &near = json["findings"][1];
  EXPECT_EQ(clash["state"], "changed");
  EXPECT_EQ(clash["change"], "worse");
  EXPECT_EQ(clash["before"]["verdict"], "clash");
  EXPECT_EQ(clash["before"]["depth"], 0.05);
  EXPECT_EQ(near["change"], "same");
  EXPECT_EQ(near["before"]["depth"], nullptr);
  EXPECT_NEAR(near["before"]["distance"].get<double>(), 0.2, 1e-12);
  const std::string csv = sceneCheckCsv(scene, first, compared);
  EXPECT_THAT(csv, HasSubstr(",clash,0,,changed,worse,glued,"));
  EXPECT_THAT(csv, HasSubstr(",clash,0,0.05\n"));
  EXPECT_THAT(sceneCheckTable(scene, first, compared), HasSubstr("changed    worse"));
  EXPECT_EQ(sceneCheckChanges(compared), "since the last check: 0 new, 1 worse, 0 better, 0 gone\n");
}

TEST(SceneCheckExport, TheResultDoesNotDependOnTheNumberOfThreads) {
  Scene scene;
  test::RandomValues random(4);
  const PartGeometryPtr rock = test::geometryOf(test::starMesh(1, 0.5, 1, 0.4)),
                        other = test::geometryOf(test::starMesh(2, 0.4, 1, 0.3));
  for (int i = 0; i < 16; ++i) {
    RigidTransform pose = random.pose().normalized();
    pose.translation *= 2.5;
    scene.add(test::partOf(i % 2 == 0 ? rock : other, fmt::format("{}", i).c_str(), pose));
  }
  const SceneCheckRequest request = sceneCheckRequest(scene, 0.2);
  const auto run = [&] {
    const SceneCheck check = checkScene(request);
    return sceneCheckJson(scene, check, compareFindings(check, {}));
  };
  const std::string expected = run();
  // While others run, a check gets fewer helpers, or none.
  std::array<std::string, 6> results;
  parallelFor(results.size(), [&](std::size_t i) { results[i] = run(); });
  for (const std::string& result : results)
    EXPECT_EQ(result, expected);
}

}  // namespace
}  // namespace nearfit::scene_check_export_test
