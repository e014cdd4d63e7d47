#include "core/report/placement_table.h"

#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/random_values.h"

namespace nearfit::placement_table_test {
namespace {

/// Rows of fields, as RFC 4180 reads them.
std::vector<std::vector<std::string>> parseCsv(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool isQuoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (isQuoted) {
      if (c != '"') {
        rows.back().back() += c;
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        rows.back().back() += text[i++];
      } else {
        isQuoted = false;
      }
    } else if (c == '"') {
      isQuoted = true;
    } else if (c == ',') {
      rows.back().emplace_back();
    } else if (c == '\n') {
      rows.push_back({""});
    } else {
      rows.back().back() += c;
    }
  }
  rows.pop_back();
  return rows;
}

TEST(PlacementTable, TheMatrixIsReadBackAsRowsThatMapPointsAsThePoseDoes) {
  const RigidTransform pose = test::RandomValues(3).pose().normalized();
  std::istringstream in(matrixText(pose));
  glm::dmat4 m(0.0);
  for (glm::length_t row = 0; row < 4; ++row) {
    for (glm::length_t column = 0; column < 4; ++column)
      in >> m[column][row];
  }
  ASSERT_TRUE(in);
  const glm::dvec3 point(0.3, -0.2, 0.7);
  EXPECT_LT(glm::distance(glm::dvec3(m * glm::dvec4(point, 1.0)), pose.applyToPoint(point)), 1e-15);
  EXPECT_EQ(matrixText({}), "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_EQ(matrixText({{1, 0, 0, 0}, {1.5, -2, 0.25}}), "1 0 0 1.5\n0 1 0 -2\n0 0 1 0.25\n0 0 0 1\n");
}

TEST(PlacementTable, EachPartIsARowAndItsNumbersReadBackTheSame) {
  Scene scene;
  const RigidTransform first = test::RandomValues(5).pose().normalized();
  scene.add(test::partOf(test::geometryOf(test::tetrahedronMesh()), "Ring, \"large\"", first));
  Part hidden = test::partOf(test::geometryOf(test::tetrahedronMesh()), "Hidden");
  hidden.isVisible = false;
  scene.add(hidden);
  scene.setMovingPart(scene.add(test::partOf(test::geometryOf(test::tetrahedronMesh()), "Peg")));
  const RigidTransform held{{1, 0, 0, 0}, {0.125, 0, -3}};

  const auto rows = parseCsv(placementCsv(scene, held));
  ASSERT_EQ(rows.size(), 4U);
  for (const auto& row : rows)
    ASSERT_EQ(row.size(), 29U);
  EXPECT_EQ(rows[0][0], "part");
  EXPECT_EQ(rows[0][28], "m33");
  EXPECT_EQ(rows[1][0], "Ring, \"large\"");
  EXPECT_EQ(rows[2][4], "0") << "hidden";
  EXPECT_EQ(rows[3][5], "1") << "moving";
  EXPECT_EQ(std::stod(rows[1][6]), first.translation.x);
  EXPECT_EQ(std::stod(rows[1][12]), first.rotation.z);
  EXPECT_EQ(std::stod(rows[1][14]), first.toMatrix()[1][0]) << "m01: row 0, column 1";
  EXPECT_EQ(std::stod(rows[3][16]), 0.125) << "m03, where it is held";
  EXPECT_EQ(std::stod(rows[3][8]), -3.0);
}

}  // namespace
}  // namespace nearfit::placement_table_test
