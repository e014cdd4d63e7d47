#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/servo/motion_recording.h"
#include "tests/app/cli/plate_and_cube.h"

namespace nearfit::test::path_command_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A recording in which the cube sinks from 2 m to 1.1 m, 0.1 m above the plate, and goes 1 m along x there.
class PathCommand : public PlateAndCube {
 protected:
  PathCommand() {
    MotionWriter writer(path("felt.csv"));
    for (int i = 0; i <= 100; ++i) {
      MotionRow row;
      row.time = 0.01 * i;
      row.proxy.translation =
          i <= 50 ? glm::dvec3(0.0, 0.0, 2.0 - 0.018 * i) : glm::dvec3(0.02 * (i - 50), 0.0, 1.1);
      row.handle = row.proxy;
      writer.write(row);
    }
    writer.finish();
  }

  /// Makes in.nfpath of the recording.
  void makePath(const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"path", path("felt.csv"), scene_, "-o", path("in.nfpath")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = runCli(arguments);
    ASSERT_EQ(result.exitCode, 0) << result.err;
  }
  ProcessResult certify(const std::string& separation) {
    return runCli({"certify", path("in.nfpath"), scene_, "-o", path("in.nfcert"), "--separation", separation,
                   "--json"});
  }
  ProcessResult verify(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"verify", path("in.nfcert"), scene_});
    return runCli(more);
  }
  /// Replaces the first occurrence of a text in a file.
  void change(const std::string& file, const std::string& from, const std::string& to) {
    std::string text = readBytes(file);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    std::ofstream(file, std::ios::binary) << text.replace(at, from.size(), to);
  }
};

TEST_F(PathCommand, ARecordingIsTrimmedThinnedAndCertified) {
  makePath({"--from", "0.1", "--to", "0.9", "--thin", "0.001", "--csv", path("poses.csv"), "--gltf",
            path("in.glb"), "--clearance", path("near.csv"), "--within", "2", "--swept", path("swept.ply"),
            "--resolution", "0.2"});
  EXPECT_THAT(readBytes(path("swept.ply")), StartsWith("ply"));
  const auto poses = linesOf(readBytes(path("poses.csv")));
  ASSERT_GE(poses.size(), 4U);
  EXPECT_LT(poses.size(), 20U) << "two straight motions";
  EXPECT_THAT(poses[1], StartsWith("0.1,"));
  EXPECT_THAT(poses.back(), StartsWith("0.9,"));
  EXPECT_THAT(readBytes(path("in.glb")), StartsWith("glTF"));
  const auto near = linesOf(readBytes(path("near.csv")));
  EXPECT_EQ(near.at(0), "t_s,Plate [m]");
  EXPECT_EQ(near.size(), poses.size());
  const auto certified = certify("0.09");
  ASSERT_EQ(certified.exitCode, 0) << certified.out << certified.err;
  EXPECT_TRUE(nlohmann::json::parse(certified.out).at("free").get<bool>());
  EXPECT_EQ(verify().exitCode, 0);
  const auto verified = verify({path("in.nfpath"), "--json"});
  EXPECT_EQ(verified.exitCode, 0) << verified.out << verified.err;
  EXPECT_TRUE(nlohmann::json::parse(verified.out).at("verified").get<bool>());
}

TEST_F(PathCommand, APathThatComesTooNearEndsWithThreeAndWritesNoCertificate) {
  makePath();
  const auto result = certify("0.105");
  EXPECT_EQ(result.exitCode, 3) << result.err;
  EXPECT_EQ(result.err, "");
  const auto verdict = nlohmann::json::parse(result.out);
  EXPECT_FALSE(verdict.at("free").get<bool>());
  EXPECT_EQ(verdict.at("part"), "Cube");
  EXPECT_EQ(verdict.at("other"), "Plate");
  EXPECT_LE(verdict.at("distance").get<double>(), 0.105 * 17 / 16);
  EXPECT_GE(verdict.at("distance").get<double>(), 0.1 - 1e-9);
  EXPECT_FALSE(std::filesystem::exists(path("in.nfcert")));
}

TEST_F(PathCommand, VerifyRefusesWhicheverFileChangesByAByte) {
  makePath();
  ASSERT_EQ(certify("0.05").exitCode, 0);
  const auto refusedAfter = [&](const std::string& file, const std::string& from, const std::string& to) {
    const std::string before = readBytes(file);
    change(file, from, to);
    const auto result = verify({path("in.nfpath")});
    std::ofstream(file, std::ios::binary) << before;
    EXPECT_EQ(result.exitCode, 3) << file << ": " << result.out << result.err;
    return result.out;
  };
  EXPECT_THAT(refusedAfter(path("in.nfcert"), "Cube", "Cubf"), HasSubstr("was changed after it was written"));
  EXPECT_THAT(refusedAfter(path("in.nfcert"), "  ", " \t"), HasSubstr("refused"));
  EXPECT_THAT(refusedAfter(path("in.nfpath"), "[0.01,", "[0.02,"), HasSubstr("refused"));
  EXPECT_THAT(refusedAfter(path("in.nfpath"), "{", "["), HasSubstr("refused"));
  EXPECT_THAT(refusedAfter(scene_, "1000", "1001"), HasSubstr("the scene file is not the one"));
  EXPECT_THAT(refusedAfter(path("plate.obj"), "v ", "v  "), HasSubstr("was changed"));
  EXPECT_EQ(verify({path("in.nfpath")}).exitCode, 0) << "all is as it was";
}

TEST_F(PathCommand, WhatMakesNoSenseIsWrongUsage) {
  makePath();
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"path", path("felt.csv"), scene_},
           {"path", path("felt.csv"), scene_, "-o", path("x"), "--thin", "0"},
           {"path", path("felt.csv"), scene_, "-o", path("x"), "--thin", "nan"},
           {"path", path("felt.csv"), scene_, "-o", path("x"), "--separation", "0.1"},
           {"path", path("felt.csv"), scene_, "-o", path("x"), "--within", "0.1"},
           {"path", path("felt.csv"), scene_, "-o", path("x"), "--csv", path("x")},
           {"path", path("felt.csv"), scene_, "-o", path("x"), "--resolution", "0.1"},
           {"path", path("felt.csv"), scene_, "-o", path("x"), "--swept", path("swept.txt")},
           {"path", path("felt.csv"), scene_, "-o", path("x"), "--swept", path("swept.stl"), "--unit",
            "parsec"},
           {"path", path("felt.csv"), scene_, "-o", path("felt.csv")},
           {"path", path("felt.csv"), scene_, "-o", path("plate.obj")},
           {"path", path("felt.csv"), scene_, "-o", path("x"), "--from", "3"},
           {"path", path("felt.csv"), scene_, "-o", path("x"), "--part", "Peg"},
           {"path", path("felt.csv"), scene_, "-o", path("x"), "--group", "Peg"},
           {"path", path("in.nfpath"), scene_, "-o", path("x"), "--part", "Cube"},
           {"certify", path("in.nfpath"), scene_},
           {"certify", path("in.nfpath"), scene_, "-o", path("in.nfpath")},
           {"certify", path("in.nfpath"), scene_, "-o", path("x"), "--separation", "-1"},
           {"certify", path("in.nfpath"), scene_, "-o", path("x"), "--separation", "1e-15"},
           {"verify", path("in.nfcert")}}) {
    const auto result = runCli(arguments);
    EXPECT_EQ(result.exitCode, 2) << arguments.back() << ": " << result.out << result.err;
    EXPECT_FALSE(std::filesystem::exists(path("x"))) << arguments.back();
  }
}

TEST_F(PathCommand, FilesThatAreNotThereAreFailures) {
  makePath();
  EXPECT_EQ(runCli({"path", path("none.csv"), scene_, "-o", path("x")}).exitCode, 1);
  EXPECT_EQ(runCli({"certify", path("none"), scene_, "-o", path("x")}).exitCode, 1);
  EXPECT_EQ(runCli({"certify", path("felt.csv"), scene_, "-o", path("x")}).exitCode, 1) << "not a path file";
  EXPECT_EQ(verify().exitCode, 1) << "no certificate yet";
}

}  // namespace
}  // namespace nearfit::test::path_command_test
