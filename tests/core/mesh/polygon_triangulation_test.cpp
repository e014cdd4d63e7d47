#include "core/mesh/polygon_triangulation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace nearfit::polygon_triangulation_test {
namespace {

using Points = std::vector<glm::dvec3>;
using Indices = std::vector<std::uint32_t>;

Indices allOf(const Points& points) {
  Indices indices(points.size());
  std::iota(indices.begin(), indices.end(), 0U);
  return indices;
}

glm::dvec3 areaVector(const Points& p, const Triangle& t) {
  return 0.5 * glm::cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
}

/// The right answer for a flat, simple polygon: n - 2 triangles, none turned or flat, areas that add up to
/// the polygon's. (Triangles that overlapped or left the polygon would have too large a sum.)
void expectTiled(const Points& points, const Indices& polygon, const glm::dvec3& area) {
  std::vector<Triangle> triangles;
  EXPECT_EQ(PolygonTriangulator().triangulate(points, polygon, triangles), polygon.size() - 2);
  ASSERT_EQ(triangles.size(), polygon.size() - 2);
  double sum = 0.0;
  for (const Triangle& t : triangles) {
    EXPECT_GT(glm::dot(areaVector(points, t), area), 0.0);
    sum += glm::length(areaVector(points, t));
  }
  EXPECT_NEAR(sum, glm::length(area), 1e-12 * glm::length(area));
}

TEST(PolygonTriangulation, ConvexAndConcaveQuadsAreTiled) {
  expectTiled({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 3}, {0, 0, 1});
  const Points arrow{{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    expectTiled(arrow, {i, (i + 1) % 4, (i + 2) % 4, (i + 3) % 4}, {0, 0, 1});
  }
}

TEST(PolygonTriangulation, QuadWithThreeCornersInALineHasNoFlatTriangle) {
  const Points points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    expectTiled(points, {i, (i + 1) % 4, (i + 2) % 4, (i + 3) % 4}, {0, 0, 1});
  }
}

TEST(PolygonTriangulation, CornersInALineMakeNoFlatTriangles) {
  // A triangle with three more corners on each side.
  const Points corner{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  Points points;
  for (int side = 0; side < 3; ++side) {
    for (int k = 0; k < 4; ++k)
      points.push_back(corner[side] + 0.25 * k * (corner[(side + 1) % 3] - corner[side]));
  }
  expectTiled(points, allOf(points), {0, 0, 8});
}

/// A star of 2n corners in a plane through the origin with that normal.
Points star(int n, double inner, const glm::dquat& rotation) {
  Points points;
  for (int i = 0; i < 2 * n; ++i) {
    const double r = i % 2 == 0 ? 1.0 : inner, angle = std::numbers::pi * i / n;
    points.push_back(rotation * glm::dvec3(r * std::cos(angle), r * std::sin(angle), 0.0));
  }
  return points;
}

TEST(PolygonTriangulation, StarsAreTiledHoweverTheyLie) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 50; ++i) {
    const glm::dquat q =
        glm::normalize(glm::dquat{normal(random), normal(random), normal(random), normal(random)});
    const int n = 3 + i;
    const double inner = 0.3;
    const double area = n * inner * std::sin(std::numbers::pi / n);
    const Points points = star(n, inner, q);
    expectTiled(points, allOf(points), area * (q * glm::dvec3(0, 0, 1)));
  }
}

TEST(PolygonTriangulation, CombOfManyTeethIsTiled) {
  Points points;
  const int teeth = 500;
  for (int i = 0; i < teeth; ++i) {
    points.emplace_back(2.0 * i, 0.0, 0.0);
    points.emplace_back(2.0 * i + 1.0, 10.0, 0.0);
  }
  points.emplace_back(2.0 * teeth, 0.0, 0.0);
  points.emplace_back(2.0 * teeth, -1.0, 0.0);
  points.emplace_back(0.0, -1.0, 0.0);
  expectTiled(points, allOf(points), {0, 0, -10.0 * teeth - 2.0 * teeth});  // Clockwise.
}

TEST(PolygonTriangulation, HoleJoinedByABridgeStaysOpen) {
  const Points points{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}};
  // Rim anticlockwise, in over the bridge 0-4, the hole clockwise, and out again.
  expectTiled(points, {0, 1, 2, 3, 0, 4, 5, 6, 7, 4}, {0, 0, 12});
}

TEST(PolygonTriangulation, TwoHolesOnBridgesFromOneCornerStayOpen) {
  const Points points{{0, 0, 0}, {9, 0, 0}, {9, 4, 0}, {0, 4, 0}, {1, 1, 0}, {1, 3, 0},
                      {3, 3, 0}, {3, 1, 0}, {5, 1, 0}, {5, 3, 0}, {8, 3, 0}, {8, 1, 0}};
  expectTiled(points, {0, 1, 2, 3, 0, 4, 5, 6, 7, 8, 9, 10, 11, 8, 7, 4}, {0, 0, 36 - 4 - 6});
}

TEST(PolygonTriangulation, TriangulationUsesThePolygonsOwnEdges) {
  const Points points = star(9, 0.4, glm::dquat(1, 0, 0, 0));
  std::vector<Triangle> triangles;
  PolygonTriangulator().triangulate(points, allOf(points), triangles);
  const TriangleMesh mesh(points, triangles);
  EXPECT_EQ(mesh.topology().openEdges, points.size());
  EXPECT_EQ(mesh.topology().nonManifoldEdges, 0U);
  EXPECT_EQ(mesh.topology().inconsistentEdges, 0U);
}

TEST(PolygonTriangulation, PolygonsThatCrossOrFoldOntoThemselvesGiveTrianglesOfTheirCornersAndEnd) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 300; ++round) {
    const std::size_t n = 3 + random() % 20;
    Points points;
    Indices polygon;
    for (std::uint32_t i = 0; i < n; ++i) {
      // A coarse grid brings coinciding, collinear and overlapping corners.
      points.emplace_back(random() % 4, random() % 4, random() % 2);
      polygon.push_back(i);
    }
    std::vector<Triangle> triangles;
    EXPECT_LE(PolygonTriangulator().triangulate(points, polygon, triangles), n - 2);
    for (const Triangle& t : triangles) {
      EXPECT_TRUE(t[0] < n && t[1] < n && t[2] < n);
      EXPECT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
    }
  }
}

TEST(PolygonTriangulation, SpikeThatFoldsOntoItselfGivesNothing) {
  const Points points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  std::vector<Triangle> triangles;
  EXPECT_EQ(PolygonTriangulator().triangulate(points, Indices{0, 1, 2, 1}, triangles), 0U);
  EXPECT_TRUE(triangles.empty());
}

TEST(PolygonTriangulation, ResultsFollowEachOther) {
  const Points points = star(5, 0.4, glm::dquat(1, 0, 0, 0));
  PolygonTriangulator triangulator;
  std::vector<Triangle> triangles;
  EXPECT_EQ(triangulator.triangulate(points, allOf(points), triangles), 8U);
  EXPECT_EQ(triangulator.triangulate(points, Indices{0, 1, 2}, triangles), 1U);
  EXPECT_EQ(triangulator.triangulate(points, allOf(points), triangles), 8U);
  EXPECT_EQ(triangles.size(), 17U);
  EXPECT_EQ(triangles[8], (Triangle{0, 1, 2}));
}

}  // namespace
}  // namespace nearfit::polygon_triangulation_test
