#include "core/exact/hole_triangulation.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace nearfit::hole_triangulation_test {
namespace {

/// A regular polygon about z, anticlockwise, with its corners in turn above and below.
std::vector<glm::dvec3> polygon(std::size_t corners, double wave) {
  std::vector<glm::dvec3> points;
  for (std::size_t i = 0; i < corners; ++i) {
    const double turn = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
    points.emplace_back(std::cos(turn), std::sin(turn), i % 2 == 0 ? wave : -wave);
  }
  return points;
}

TEST(HoleTriangulation, FillsAPolygonInItsDirection) {
  for (const std::size_t corners : {3U, 4U, 5U, 48U, 300U}) {
    for (const double wave : {0.0, 0.01}) {
      const std::vector<glm::dvec3> points = polygon(corners, wave);
      const auto triangles = triangulateHole(points);
      ASSERT_EQ(triangles.size(), corners - 2) << corners << " corners, wave " << wave;
      glm::dvec3 doubleArea(0.0);
      for (const auto& t : triangles)
        doubleArea += glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
      // The z component of the sum is that of the rim, however it is filled.
      const double n = static_cast<double>(corners);
      EXPECT_NEAR(doubleArea.z, n * std::sin(2.0 * std::numbers::pi / n), 1e-9);
    }
  }
}

TEST(HoleTriangulation, RefusesWhatIsNoPolygonOrTooLarge) {
  EXPECT_TRUE(triangulateHole({}).empty());
  EXPECT_TRUE(triangulateHole(polygon(2, 0.0)).empty());
  EXPECT_TRUE(triangulateHole(polygon(kMaxHoleCorners + 1, 0.0)).empty());
}

}  // namespace
}  // namespace nearfit::hole_triangulation_test
