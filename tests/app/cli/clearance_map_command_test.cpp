#include <cmath>
#include <map>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/cli/plate_and_cube.h"
#include "tests/support/ply_values.h"

namespace nearfit::test::clearance_map_command_test {
namespace {

using ::testing::HasSubstr;

class ClearanceMapCommand : public PlateAndCube {
 protected:
  /// Numbers of the summary by their names.
  static std::map<std::string, double> numbersOf(const std::string& text) {
    std::map<std::string, double> numbers;
    for (const std::string& line : linesOf(text)) {
      std::istringstream words(line);
      std::string name, value;
      words >> name >> value;
      numbers[name] = std::stod(value);
    }
    return numbers;
  }
};

TEST_F(ClearanceMapCommand, MapHistogramAndSummaryAgree) {
  const auto result = runCli({"clearance-map", scene_, "--range", "1.5", "-o", path("map.ply"), "--histogram",
                              path("h.csv"), "--threshold", "1.25", "--unit", "m"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto numbers = numbersOf(result.out);
  EXPECT_EQ(numbers.at("range"), 1.5);
  EXPECT_NEAR(numbers.at("area"), 6.0, 1e-9);
  EXPECT_NEAR(numbers.at("min"), 1.0, 1e-12);
  EXPECT_EQ(numbers.at("area_contact"), 0.0);
  EXPECT_EQ(numbers.at("area_overlap"), 0.0);
  // The lower face and a quarter of each side, to a row of samples.
  EXPECT_NEAR(numbers.at("area_below"), 1.0 + 4.0 * 0.25, 4.0 * 1.5 / 8.0);
  const PlyValues map = readPlyValues(path("map.ply"));
  EXPECT_LT(static_cast<double>(map.vertex.at("distance").size()), numbers.at("samples"))
      << "the upper half and the top are beyond the range";
  for (std::size_t i = 0; i < map.vertex.at("distance").size(); ++i) {
    const double height = map.vertex.at("z")[i] - 0.5, distance = map.vertex.at("distance")[i];
    EXPECT_TRUE(height > 1.5 ? std::isnan(distance) : std::abs(distance - height) < 1e-12);
  }
  double total = 0.0;
  const std::vector<std::string> lines = linesOf(readBytes(path("h.csv")));
  EXPECT_EQ(lines.at(0), "from [m],to [m],area [m^2],share");
  for (std::size_t i = 1; i < lines.size(); ++i) {
    std::istringstream cells(lines[i]);
    std::string from, to, area;
    std::getline(cells, from, ',');
    std::getline(cells, to, ',');
    std::getline(cells, area, ',');
    total += std::stod(area);
  }
  EXPECT_NEAR(total, 6.0, 1e-9);
}

TEST_F(ClearanceMapCommand, APartIsNamedAndNearPartsAreAdded) {
  const auto result =
      runCli({"clearance-map", scene_, "--part", "Plate", "--range", "1.5", "--near", "-o", path("map.ply")});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const PlyValues map = readPlyValues(path("map.ply"));
  ASSERT_GE(map.comments.size(), 3U);
  EXPECT_EQ(map.comments[1], "part Plate");
  EXPECT_EQ(map.comments[2], "part Cube");
  EXPECT_THAT(map.vertex.at("z"), ::testing::Contains(::testing::DoubleNear(1500.0, 1e-9)))
      << "the lower face of the cube, in millimetres";
  EXPECT_THAT(map.vertex.at("distance"), ::testing::Contains(::testing::DoubleNear(1000.0, 1e-9)))
      << "the gap of 1 m, in millimetres too";
  EXPECT_THAT(map.comments, ::testing::Contains("distance in mm, nan beyond 1500"));
}

TEST_F(ClearanceMapCommand, WithoutARangeItFindsOne) {
  const auto result = runCli({"clearance-map", scene_, "--histogram", path("h.csv")});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(numbersOf(result.out).at("range"), 2.0) << "one and a half times 1 m, rounded up";
}

TEST_F(ClearanceMapCommand, WhatMakesNoSenseIsWrongUsageAndWritesNothing) {
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"clearance-map", scene_},
           {"clearance-map", scene_, "-o", path("x.ply"), "--part", "Peg"},
           {"clearance-map", scene_, "-o", path("x.ply"), "--range", "0"},
           {"clearance-map", scene_, "-o", path("x.ply"), "--range", "nan"},
           {"clearance-map", scene_, "-o", path("x.ply"), "--range", "0.5"},
           {"clearance-map", scene_, "-o", path("x.ply"), "--unit", "parsec"},
           {"clearance-map", scene_, "-o", path("x.ply"), "--histogram", path("x.ply")},
           {"clearance-map", scene_, "-o", path("cube.obj")}}) {
    const auto result = runCli(arguments);
    EXPECT_EQ(result.exitCode, 2) << arguments.back() << result.err;
    EXPECT_FALSE(std::filesystem::exists(path("x.ply")));
  }
  EXPECT_THAT(readBytes(path("cube.obj")), HasSubstr("f ")) << "it is not overwritten";
}

}  // namespace
}  // namespace nearfit::test::clearance_map_command_test
