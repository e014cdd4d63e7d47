#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/scene/scene_file.h"
#include "tests/app/cli/plate_and_cube.h"

namespace nearfit::test::scene_rule_command_test {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

class SceneRuleCommand : public PlateAndCube {
 protected:
  ProcessResult rule(std::vector<std::string> options) {
    std::vector<std::string> arguments{"scene", "rule", scene_};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return runCli(arguments);
  }
  std::vector<PairRule> rules() { return readSceneFile(scene_).pairRules(); }
};

TEST_F(SceneRuleCommand, RulesAreAddedAndListed) {
  const auto none = rule({});
  EXPECT_EQ(none.exitCode, 0) << none.err;
  EXPECT_EQ(none.out, "no rules\n");
  const auto added = rule({"--press-fit", "Plate:Cu*=0.02mm", "--leave-out-groups", "--touching",
                           "Plate:Cube", "--leave-out", "Plate:Plate"});
  EXPECT_EQ(added.exitCode, 0) << added.err;
  EXPECT_EQ(added.err, "");
  EXPECT_EQ(added.out,
            "1: leave out Plate with Plate\n"
            "2: leave out parts of one group\n"
            "3: Plate and Cube are meant to touch\n"
            "4: press fit of Plate with Cu* up to 2e-05 m\n");
  const std::vector<PairRule> wanted{{PairRuleKind::LeaveOut, "Plate", "Plate"},
                                     {PairRuleKind::SameGroup},
                                     {PairRuleKind::Touching, "Plate", "Cube"},
                                     {PairRuleKind::PressFit, "Plate", "Cu*", 2e-5}};
  EXPECT_TRUE(rules() == wanted);
  EXPECT_EQ(rule({}).out, added.out);
  const Json listed = Json::parse(rule({"--json"}).out);
  ASSERT_EQ(listed.size(), 4U);
  EXPECT_EQ(listed[3]["kind"], "pressFit");
  EXPECT_EQ(listed[3]["interference"], 2e-5);
}

TEST_F(SceneRuleCommand, AListedRuleIsFollowedByChecks) {
  ASSERT_EQ(rule({"--leave-out", "Plate:Cube"}).exitCode, 0);
  const auto check = runCli({"clearance", scene_, "--all", "--threshold", "1.5"});
  EXPECT_EQ(check.exitCode, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("0 pairs checked, 1 left out"));
}

TEST_F(SceneRuleCommand, RulesAreRemovedByTheNumbersThatAreListed) {
  ASSERT_EQ(rule({"--leave-out", "A:B", "--leave-out", "C:D", "--leave-out", "E:F"}).exitCode, 0);
  const auto removed = rule({"--remove", "3", "--remove", "1", "--remove", "3", "--touching", "Plate:Cube"});
  EXPECT_EQ(removed.exitCode, 0) << removed.err;
  EXPECT_EQ(removed.out, "1: leave out C with D\n2: Plate and Cube are meant to touch\n");
}

TEST_F(SceneRuleCommand, ARuleIsNotAddedTwiceAndOneForNoPartGetsAWarning) {
  ASSERT_EQ(rule({"--touching", "Plate:Cube"}).exitCode, 0);
  const auto again = rule({"--touching", "Plate:Cube", "--touching", "Plate:Lid"});
  EXPECT_EQ(again.exitCode, 0) << again.err;
  EXPECT_EQ(again.out, "1: Plate and Cube are meant to touch\n2: Plate and Lid are meant to touch\n");
  EXPECT_THAT(again.err, HasSubstr("no parts of the scene have these names: Plate and Lid"));
}

TEST_F(SceneRuleCommand, WrongUsageLeavesTheSceneAsItIs) {
  ASSERT_EQ(rule({"--touching", "Plate:Cube"}).exitCode, 0);
  const std::string before = readBytes(scene_);
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{"--remove", "0"},
                                             {"--remove", "2"},
                                             {"--remove", "x"},
                                             {"--leave-out", "Plate"},
                                             {"--press-fit", "Plate:Cube"},
                                             {"--press-fit", "Plate:Cube=-1mm"},
                                             {"--remove", "1", "--touching", ":Cube"}}) {
    const auto result = rule(options);
    EXPECT_EQ(result.exitCode, 2) << options.back() << result.err;
    EXPECT_EQ(readBytes(scene_), before) << options.back();
  }
  EXPECT_THAT(rule({"--remove", "2"}).err, HasSubstr("give numbers from 1 to 1"));
}

}  // namespace
}  // namespace nearfit::test::scene_rule_command_test
