#include "core/path/path_file.h"

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "tests/support/path_scenes.h"
#include "tests/support/random_values.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::path_file_test {
namespace {

using testing::HasSubstr;

class PathFile : public ::testing::Test {
 protected:
  /// The message of the error that reading gives.
  std::string refusal(const std::string& text) const {
    try {
      readPathFile(folder_.write("a.nfpath", text));
    } catch (const FileError& e) {
      return e.what();
    }
    return "no error";
  }
  /// A valid file in which some text holds something else.
  std::string with(const std::string& from, const std::string& to) const {
    std::string text =
        R"({"path": 1, "program": "x", "parts": ["Peg"], "centre": [0, 0, 0], "poses": [[0, 1, 2, 3, 1, 0, 0, 0], [5, 6, 7, 8, 1, 0, 0, 0]]})";
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }

  test::TemporaryFolder folder_;
};

TEST_F(PathFile, WhatIsWrittenReadsBackTheSameToTheBit) {
  test::RandomValues random(3);
  AssemblyPath path;
  path.parts = {"Peg", "Jaw \"2\", ö"};
  path.centre = random.vector(1.0);
  RigidTransform pose = random.pose().normalized();
  for (int i = 0; i < 500; ++i) {
    path.poses.push_back({1e-3 * i + random.in(0.0, 5e-4), pose});
    pose = RigidTransform{rotationOf(random.vector(0.2)) * pose.rotation, random.vector(10.0)}.normalized();
  }
  writePathFile(path, folder_.path() / "p.nfpath");
  EXPECT_TRUE(isSamePath(readPathFile(folder_.path() / "p.nfpath"), path));
}

TEST_F(PathFile, NothingInItIsTrusted) {
  EXPECT_EQ(refusal(with("Peg", "Peg")), "no error");
  EXPECT_THAT(refusal(with("\"path\": 1", "\"path\": 2")), HasSubstr("version"));
  EXPECT_THAT(refusal(with("\"parts\": [\"Peg\"]", "\"parts\": []")), HasSubstr("names no part"));
  EXPECT_THAT(refusal(with("[\"Peg\"]", "\"Peg\"")), HasSubstr("parts"));
  EXPECT_THAT(refusal(with("Peg", "P\\ng")), HasSubstr("path"));
  EXPECT_THAT(refusal(with("\"centre\": [0, 0, 0]", "\"centre\": [0, 0]")), HasSubstr("centre"));
  EXPECT_THAT(refusal(with("[5, 6, 7, 8, 1, 0, 0, 0]", "[5, 6, 7, 8, 1, 0, 0]")), HasSubstr("poses[1]"));
  EXPECT_THAT(refusal(with("8, 1, 0, 0, 0", "8, 1.0005, 0, 0, 0")), HasSubstr("not of unit length"));
  EXPECT_THAT(refusal(with("8, 1, 0, 0, 0", "8, 0, 0, 0, 0")), HasSubstr("pose 1"));
  EXPECT_THAT(refusal(with("[5, 6", "[-5, 6")), HasSubstr("no later"));
  EXPECT_THAT(refusal(with("[5, 6", "[5, 1e999")), HasSubstr("JSON"));
  EXPECT_THAT(refusal(with("[5, 6", "[5, null")), HasSubstr("poses[1][1]"));
  EXPECT_THAT(refusal(with("[5, 6", "[5, 1e300")), HasSubstr("pose 1"));
  EXPECT_THAT(refusal(with("[[0, 1, 2, 3, 1, 0, 0, 0], ", "[")), HasSubstr("less than two poses"));
  EXPECT_THAT(refusal("{"), HasSubstr("JSON"));
}

TEST_F(PathFile, JsonIsToldFromARecording) {
  EXPECT_TRUE(isJsonFile(folder_.write("p", " \n\t{\"path\": 1}")));
  EXPECT_FALSE(isJsonFile(folder_.write("p", "t_s,handle_tx\n")));
  EXPECT_FALSE(isJsonFile(folder_.write("p", "")));
  EXPECT_THROW(isJsonFile(folder_.path() / "missing"), FileError);
}

TEST(PathCsv, HasARowForEachPose) {
  const AssemblyPath path = test::pathThrough("Peg", {test::at(0, 0, 0), test::at(0.1, -2, 1e-7)});
  EXPECT_EQ(pathCsv(path), "t_s,tx,ty,tz,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0.1,-2,1e-07,1,0,0,0\n");
}

}  // namespace
}  // namespace nearfit::path_file_test
