#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/scene/scene_file.h"
#include "tests/app/cli/plate_and_cube.h"

namespace nearfit::test::scene_finding_command_test {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

/// The plate and the cube above it, and the finding that they are near.
class SceneFindingCommand : public PlateAndCube {
 protected:
  SceneFindingCommand() { save(scene_); }
  static void save(const std::string& scene) {
    const auto checked = runCli({"clearance", scene, "--all", "--threshold", "1.5", "--save"});
    EXPECT_EQ(checked.exitCode, 0) << checked.err;
  }
  static ProcessResult findingOf(const std::string& scene, const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"scene", "finding", scene};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return runCli(arguments);
  }
  ProcessResult finding(const std::vector<std::string>& options) { return findingOf(scene_, options); }
  PairRecord record() { return readSceneFile(scene_).pairRecords().at(0); }
};

TEST_F(SceneFindingCommand, FindingsAreListedAndTheSceneStaysAsItIs) {
  const std::string before = readBytes(scene_);
  const auto listed = finding({});
  EXPECT_EQ(listed.exitCode, 0) << listed.err;
  EXPECT_EQ(listed.out, "Plate and Cube: near, distance 1 m; new\n");
  const Json json = Json::parse(finding({"--json"}).out);
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0]["part"], "Plate");
  EXPECT_EQ(json[0]["other"], "Cube");
  EXPECT_EQ(json[0]["verdict"], "near");
  EXPECT_NEAR(json[0]["distance"].get<double>(), 1.0, 1e-12);
  EXPECT_TRUE(json[0]["depth"].is_null());
  EXPECT_EQ(json[0]["state"], "new");
  EXPECT_EQ(finding({"--reopen", "Plate:Cube"}).exitCode, 0) << "it is new already";
  EXPECT_EQ(readBytes(scene_), before);
}

TEST_F(SceneFindingCommand, AFindingIsAcceptedFixedAndReopened) {
  const auto accepted = finding({"--accept", "Cube:Plate= gap = 1 m: as drawn "});
  EXPECT_EQ(accepted.exitCode, 0) << accepted.err;
  EXPECT_EQ(accepted.out, "Plate and Cube: near, distance 1 m; accepted: gap = 1 m: as drawn\n");
  EXPECT_EQ(record().state, FindingState::Accepted);
  EXPECT_EQ(record().reason, "gap = 1 m: as drawn");
  const auto checked = runCli({"clearance", scene_, "--all", "--threshold", "1.5", "--json", "-"});
  EXPECT_EQ(Json::parse(checked.out)["findings"][0]["state"], "accepted") << "the next check knows it";
  EXPECT_EQ(finding({"--fixed", "Pl*:*"}).out, "Plate and Cube: near, distance 1 m; fixed\n");
  EXPECT_EQ(record().state, FindingState::Fixed);
  EXPECT_EQ(finding({"--reopen", "Plate:Cube"}).out, "Plate and Cube: near, distance 1 m; new\n");
  EXPECT_EQ(record().state, FindingState::New);
  EXPECT_EQ(record().reason, "");
}

TEST_F(SceneFindingCommand, NamesWithColonsAndEqualsSignsWorkAsForRules) {
  const std::string scene = path("odd.nearfit");
  Scene odd = readSceneFile(scene_);
  const auto rename = [&odd](const char* from, const char* to) {
    Part part = *odd.findByName(from);
    part.name = to;
    odd.replace(part);
  };
  rename("Plate", "P:1=a");
  rename("Cube", "C=2:b");
  writeSceneFile(odd, scene);
  ASSERT_EQ(runCli({"scene", "rule", scene, "--press-fit", "P\\:1=a:C=2:b=1mm"}).err, "");
  const auto accepted = findingOf(scene, {"--accept", "P\\:1=a:C=2:b=so=be=it"});
  EXPECT_EQ(accepted.exitCode, 0) << accepted.err;
  EXPECT_THAT(accepted.out, HasSubstr("accepted: so=be=it"));
  const auto other = findingOf(scene, {"--accept", "C\\=2\\:b:P:1\\=a=the other way"});
  EXPECT_EQ(other.exitCode, 0) << other.err;
  EXPECT_THAT(other.out, HasSubstr("accepted: the other way"));
  EXPECT_EQ(findingOf(scene, {"--fixed", "P\\:1=a:C=2:b"}).exitCode, 0);
}

TEST_F(SceneFindingCommand, WrongUsageLeavesTheSceneAsItIs) {
  const std::string before = readBytes(scene_), tooLong(kMaxReasonBytes + 1, 'x');
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{"--accept", "Plate:Cube"},
                                             {"--accept", "Plate:Cube="},
                                             {"--accept", "Plate:Cube=  "},
                                             {"--accept", "Plate:Cube=" + tooLong},
                                             {"--accept", "Plate:Cube=a\nb"},
                                             {"--accept", "Plate=why"},
                                             {"--accept", "Plate:Lid=why"},
                                             {"--fixed", "Plate"},
                                             {"--fixed", "Plate:"},
                                             {"--fixed", "Lid:Cube"},
                                             {"--reopen", "Plate:Plate"},
                                             {"--accept", "Plate:Cube=why", "--fixed", "Cube:Plate"}}) {
    const auto result = finding(options);
    EXPECT_EQ(result.exitCode, 2) << options.back() << result.err;
    EXPECT_EQ(readBytes(scene_), before) << options.back();
  }
  EXPECT_THAT(finding({"--fixed", "Plate:Lid"}).err, HasSubstr("there is no part \"Lid\""));
  EXPECT_THAT(finding({"--fixed", "Plate:Plate"}).err,
              HasSubstr("keeps no finding of \"Plate\" and \"Plate\""));
  EXPECT_THAT(finding({"--accept", "Plate:Cube="}).err, HasSubstr("no reason is given for \"Plate:Cube\""));
  EXPECT_THAT(finding({"--accept", "Plate:Cube=" + tooLong}).err, HasSubstr("201 bytes"));
  EXPECT_EQ(finding({"--accept", "Plate:Cube=" + tooLong.substr(1)}).exitCode, 0) << "as long as is allowed";
}

TEST_F(SceneFindingCommand, ACertificateThatNamesTheFormerSceneIsRefused) {
  ASSERT_EQ(runCli({"suggest", scene_, "-o", path("in.nfpath"), "--to", "0,0,1.5,1,0,0,0"}).exitCode, 0);
  ASSERT_EQ(runCli({"certify", path("in.nfpath"), scene_, "-o", path("in.nfcert")}).exitCode, 0);
  ASSERT_EQ(runCli({"verify", path("in.nfcert"), scene_}).exitCode, 0);
  ASSERT_EQ(finding({"--accept", "Plate:Cube=why"}).exitCode, 0);
  EXPECT_EQ(runCli({"verify", path("in.nfcert"), scene_}).exitCode, 3);
}

}  // namespace
}  // namespace nearfit::test::scene_finding_command_test
