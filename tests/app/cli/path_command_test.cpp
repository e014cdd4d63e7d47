#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/files/sha256.h"
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
  /// Makes in.nfcert by its own words: anything in it may be changed, and its hash is right again.
  void reseal(const std::function<void(std::string&)>& edit) {
    constexpr std::size_t kHashDigits = 64, kAfterHash = 4;
    std::string text = readBytes(path("in.nfcert"));
    edit(text);
    const std::string hash = sha256OfBytes({text.data(), text.rfind(",\n  \"sha256\"")});
    text.replace(text.size() - kHashDigits - kAfterHash, kHashDigits, hash);
    std::ofstream(path("in.nfcert"), std::ios::binary) << text;
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

TEST_F(PathCommand, TheCertificateAloneIsProvenAnewByTheFilesThatItNames) {
  makePath();
  ASSERT_EQ(certify("0.05").exitCode, 0);
  const auto verifyAlone = [&](std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"verify", path("in.nfcert")});
    return runCli(more);
  };
  const auto verified = verifyAlone({"--json"});
  ASSERT_EQ(verified.exitCode, 0) << verified.out << verified.err;
  const auto verdict = nlohmann::json::parse(verified.out);
  EXPECT_TRUE(verdict.at("verified").get<bool>());
  EXPECT_TRUE(verdict.at("scene_file_hashed").get<bool>());
  EXPECT_TRUE(verdict.at("path_file_checked").get<bool>());
  const auto refusedAfter = [&](const std::string& file, const std::string& from, const std::string& to) {
    const std::string before = readBytes(file);
    change(file, from, to);
    const auto result = verifyAlone();
    std::ofstream(file, std::ios::binary) << before;
    EXPECT_EQ(result.exitCode, 3) << file << ": " << result.out << result.err;
    return result.out;
  };
  EXPECT_THAT(refusedAfter(path("in.nfcert"), "in.nfpath", "in.nfpati"), HasSubstr("was changed after"));
  EXPECT_THAT(refusedAfter(scene_, "  ", " \t"), HasSubstr("the scene file is not the one"));
  EXPECT_THAT(refusedAfter(path("in.nfpath"), "  ", " \t"), HasSubstr("the path file is not the one"));
  EXPECT_THAT(refusedAfter(path("plate.obj"), "v ", "v  "), HasSubstr("was changed"));
  EXPECT_EQ(verifyAlone().exitCode, 0) << "all is as it was";
}

TEST_F(PathCommand, AFolderThatMovesKeepsItsCertificateAndAMissingFileIsTold) {
  makePath();
  ASSERT_EQ(certify("0.05").exitCode, 0);
  const std::filesystem::path moved = folder_.path() / "moved";
  std::filesystem::create_directory(moved);
  for (const char* name : {"plate.obj", "cube.obj", "fit.nearfit", "in.nfpath", "in.nfcert"})
    std::filesystem::rename(path(name), moved / name);
  const std::string certificate = (moved / "in.nfcert").string(), scene = (moved / "fit.nearfit").string();
  EXPECT_EQ(runCli({"verify", certificate}).exitCode, 0);
  std::filesystem::rename(moved / "in.nfpath", moved / "other.nfpath");
  const auto withoutPath = runCli({"verify", certificate});
  EXPECT_EQ(withoutPath.exitCode, 1) << withoutPath.out;
  EXPECT_THAT(withoutPath.err, HasSubstr("in.nfpath: the certificate names this file"));
  EXPECT_THAT(withoutPath.err, HasSubstr("verify CERT SCENE PATH"));
  EXPECT_EQ(runCli({"verify", certificate, scene, (moved / "other.nfpath").string()}).exitCode, 0);
  const auto unchecked = runCli({"verify", certificate, "--no-path", "--json"});
  ASSERT_EQ(unchecked.exitCode, 0) << unchecked.out << unchecked.err;
  EXPECT_FALSE(nlohmann::json::parse(unchecked.out).at("path_file_checked").get<bool>());
  // A folder in the place of the scene is no scene.
  std::filesystem::rename(scene, moved / "other.nearfit");
  std::filesystem::create_directory(scene);
  const auto folder = runCli({"verify", certificate, "--no-path"});
  EXPECT_EQ(folder.exitCode, 1) << folder.out;
  EXPECT_THAT(folder.err, HasSubstr("it is a folder"));
  EXPECT_THAT(folder.err, HasSubstr("verify CERT SCENE"));
  EXPECT_EQ(runCli({"verify", certificate, (moved / "other.nearfit").string(), "--no-path"}).exitCode, 0);
}

TEST_F(PathCommand, ACertificateOfVersionOneNeedsItsSceneNamed) {
  makePath();
  ASSERT_EQ(certify("0.05").exitCode, 0);
  reseal([](std::string& text) {
    std::string old;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("  \"certificate\"")) line = "  \"certificate\": 1,";
      if (!line.starts_with("  \"sceneFile\"") && !line.starts_with("  \"pathFile")) old += line + "\n";
    }
    text = old;
  });
  const auto alone = runCli({"verify", path("in.nfcert")});
  EXPECT_EQ(alone.exitCode, 2) << alone.out;
  EXPECT_THAT(alone.err, HasSubstr("it does not name its scene file"));
  EXPECT_THAT(alone.err, HasSubstr("verify CERT SCENE"));
  EXPECT_EQ(verify().exitCode, 0);
  EXPECT_EQ(verify({path("in.nfpath")}).exitCode, 0);
}

TEST_F(PathCommand, ACertificateOfAnUnsavedSceneIsProvenByItsMeshesAndSaysSo) {
  makePath();
  ASSERT_EQ(certify("0.05").exitCode, 0);
  const auto clear = [](std::string& text, const std::string& member) {
    const std::size_t at = text.find("\"" + member + "\": \"") + member.size() + 5;
    text.erase(at, text.find('"', at) - at);
  };
  reseal([&](std::string& text) {
    clear(text, "scene");
    clear(text, "sceneFile");
  });
  const auto alone = runCli({"verify", path("in.nfcert")});
  EXPECT_EQ(alone.exitCode, 2) << alone.out;
  EXPECT_THAT(alone.err, HasSubstr("it holds no hash of a scene file"));
  const auto given = verify();
  EXPECT_EQ(given.exitCode, 0) << given.out << given.err;
  EXPECT_THAT(given.out, HasSubstr("holds no hash of a scene file, but of all meshes"));
  // A part of another name is another scene, whatever the file's hash.
  change(scene_, "\"Plate\"", "\"Plates\"");
  EXPECT_EQ(verify().exitCode, 3);
}

TEST_F(PathCommand, NamesInACertificateAreNotTrusted) {
  makePath();
  ASSERT_EQ(certify("0.05").exitCode, 0);
  const auto renamed = [&](const std::string& from, const std::string& to) {
    const std::string before = readBytes(path("in.nfcert"));
    reseal([&](std::string& text) { text.replace(text.find(from), from.size(), to); });
    const auto result = runCli({"verify", path("in.nfcert")});
    std::ofstream(path("in.nfcert"), std::ios::binary) << before;
    return result;
  };
  const auto device = renamed("\"fit.nearfit\"", "\"/dev/zero\"");
  EXPECT_EQ(device.exitCode, 1) << device.out;
  EXPECT_THAT(device.err, HasSubstr("it is not a regular file"));
  EXPECT_EQ(renamed("\"fit.nearfit\"", "\"plate.obj\"").exitCode, 3) << "its hash is another";
  EXPECT_EQ(renamed("\"in.nfpath\"", "\"plate.obj\"").exitCode, 3);
  EXPECT_EQ(runCli({"verify", path("in.nfcert")}).exitCode, 0);
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
           {"verify"},
           {"verify", path("in.nfcert"), scene_, path("in.nfpath"), "--no-path"}}) {
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
