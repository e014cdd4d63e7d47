#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/cli/plate_and_cube.h"

namespace nearfit::test::suggest_command_test {
namespace {

using ::testing::HasSubstr;

/// The cube is 1 m above the plate, whose top is at 0.5 m; both were drawn at the origin, where they meet.
class SuggestCommand : public PlateAndCube {
 protected:
  ProcessResult suggest(std::vector<std::string> more) {
    more.insert(more.begin(), {"suggest", scene_, "-o", path("in.nfpath"), "--json"});
    return runCli(more);
  }
};

TEST_F(SuggestCommand, APathIsFoundThatCertifies) {
  const auto result = suggest({"--to", "0,0,1.1,1,0,0,0", "--separation", "0.05"});
  ASSERT_EQ(result.exitCode, 0) << result.out << result.err;
  EXPECT_TRUE(nlohmann::json::parse(result.out).at("found").get<bool>());
  const auto certified =
      runCli({"certify", path("in.nfpath"), scene_, "-o", path("in.nfcert"), "--separation", "0.05"});
  EXPECT_EQ(certified.exitCode, 0) << certified.out << certified.err;
}

TEST_F(SuggestCommand, ItsCertificateIsVerified) {
  const auto result =
      suggest({"--to", "0,0,-1.2,1,0,0,0", "--separation", "0.05", "--certificate", path("in.nfcert")});
  ASSERT_EQ(result.exitCode, 0) << result.out << result.err;
  const auto verified = runCli({"verify", path("in.nfcert"), scene_, path("in.nfpath"), "--json"});
  EXPECT_EQ(verified.exitCode, 0) << verified.out << verified.err;
  EXPECT_EQ(nlohmann::json::parse(verified.out).at("separation"), 0.05);
  // It names the scene file: one with other bytes is refused.
  std::ofstream(scene_, std::ios::app) << '\n';
  EXPECT_EQ(runCli({"verify", path("in.nfcert"), scene_}).exitCode, 3);
}

TEST_F(SuggestCommand, WhereNothingIsFoundThereIsNoCertificate) {
  EXPECT_EQ(suggest({"--to-drawn", "--certificate", path("in.nfcert")}).exitCode, 3);
  EXPECT_FALSE(std::filesystem::exists(path("in.nfcert")));
}

TEST_F(SuggestCommand, LeadsRoundThePlateToItsOtherSide) {
  const auto result = suggest({"--to", "0,0,-1.2,1,0,0,0", "--separation", "0.05"});
  ASSERT_EQ(result.exitCode, 0) << result.out << result.err;
  EXPECT_GT(nlohmann::json::parse(result.out).at("poses").get<int>(), 2)
      << "the plate is in the straight way";
  const auto certified =
      runCli({"certify", path("in.nfpath"), scene_, "-o", path("in.nfcert"), "--separation", "0.05"});
  EXPECT_EQ(certified.exitCode, 0) << certified.out << certified.err;
}

TEST_F(SuggestCommand, AGoalThatIsNotFreeEndsWithThreeAndWritesNothing) {
  const auto result = suggest({"--to-drawn"});
  EXPECT_EQ(result.exitCode, 3) << result.err;
  const auto verdict = nlohmann::json::parse(result.out);
  EXPECT_FALSE(verdict.at("found").get<bool>());
  EXPECT_EQ(verdict.at("blocked_at"), "goal");
  EXPECT_EQ(verdict.at("other"), "Plate");
  EXPECT_FALSE(std::filesystem::exists(path("in.nfpath")));
  const auto sentence = runCli({"suggest", scene_, "-o", path("in.nfpath"), "--to-drawn"});
  EXPECT_EQ(sentence.exitCode, 3);
  EXPECT_THAT(sentence.out, HasSubstr("at the goal"));
}

TEST_F(SuggestCommand, WhatMakesNoSenseIsWrongUsage) {
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"suggest", scene_, "--out"},
           {"suggest", scene_, "-o", path("x")},
           {"suggest", scene_, "-o", path("x"), "--out", "--to-drawn"},
           {"suggest", scene_, "-o", path("x"), "--to", "0,0"},
           {"suggest", scene_, "-o", path("x"), "--out", "--seconds", "0"},
           {"suggest", scene_, "-o", path("x"), "--out", "--separation", "-1"},
           {"suggest", scene_, "-o", path("x"), "--out", "--part", "Peg"},
           {"suggest", scene_, "-o", path("x"), "--out", "--part", "Cube", "--group", "G"},
           {"suggest", scene_, "-o", path("x"), "--to", "0,0,2,1,0,0,0"},
           {"suggest", scene_, "-o", path("x"), "--out"},
           {"suggest", scene_, "-o", path("plate.obj"), "--out"},
           {"suggest", scene_, "-o", path("x"), "--to", "0,0,1.1,1,0,0,0", "--certificate", path("x")},
           {"suggest", scene_, "-o", path("x"), "--to", "0,0,1.1,1,0,0,0", "--certificate", scene_},
           {"suggest", scene_, "-o", path("x"), "--to", "0,0,1.1,1,0,0,0", "--certificate",
            path("cube.obj")}}) {
    const auto result = runCli(arguments);
    EXPECT_EQ(result.exitCode, 2) << arguments.back() << ": " << result.out << result.err;
    EXPECT_FALSE(std::filesystem::exists(path("x"))) << arguments.back();
  }
}

}  // namespace
}  // namespace nearfit::test::suggest_command_test
