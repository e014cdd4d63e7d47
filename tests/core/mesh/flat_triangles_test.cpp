#include "core/mesh/flat_triangles.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/mesh/mass_properties.h"
#include "core/mesh/mesh_builder.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::flat_triangles_test {
namespace {

using Points = std::vector<glm::dvec3>;

double leastHeightOf(const TriangleMesh& mesh) {
  double least = 1e300;
  for (const Triangle& t : mesh.triangles())
    least = std::min(least, leastHeight(mesh.vertices(), t));
  return least;
}

TEST(FlatTriangles, LeastHeightIsTheOneOverTheLongestEdge) {
  const Points points{{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {2, 0, 0}};
  EXPECT_NEAR(leastHeight(points, {0, 1, 2}), 12.0 / 5.0, 1e-15);
  EXPECT_EQ(leastHeight(points, {0, 1, 3}), 0.0);
  EXPECT_EQ(leastHeight(points, {0, 0, 0}), 0.0);
}

TEST(FlatTriangles, LineIsSwappedWithTheFaceBehindItsLongestEdge) {
  // b lies on the edge between a and c; below it are two faces, above it one, and a line closes the gap.
  const Points points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, -1, 0}};
  std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}, {1, 0, 4}, {2, 1, 4}};
  EXPECT_EQ(swapFlatTriangles(points, triangles, 0.0), 1U);
  const TriangleMesh mesh(points, triangles);
  EXPECT_EQ(mesh.topology().openEdges, 4U);
  EXPECT_EQ(mesh.topology().inconsistentEdges, 0U);
  EXPECT_NEAR(leastHeightOf(mesh), std::sqrt(0.5), 1e-15);
}

TEST(FlatTriangles, RowOfLinesIsSwappedOneAfterTheOther) {
  // The fan of lines 0-1-2, 0-2-3, ... 0-(n-1)-n lies between a row of vertices and one long edge 0-n.
  for (const std::uint32_t n : {2U, 3U, 10U, 200U}) {
    Points points;
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i <= n; ++i)
      points.emplace_back(i, 0, 0);
    points.emplace_back(0.4 * n, 3, 0);
    for (std::uint32_t i = 1; i < n; ++i)
      triangles.push_back({0, i, i + 1});
    triangles.push_back({0, n, n + 1});
    EXPECT_EQ(swapFlatTriangles(points, triangles, 1e-9), n - 1) << n;
    const TriangleMesh mesh(points, triangles);
    EXPECT_EQ(mesh.topology().openEdges, n + 2) << n;
    // A base of 1 and a height of 3, over a longest edge of less than 0.6 n + 3.
    EXPECT_GT(leastHeightOf(mesh), 3.0 / (0.6 * n + 3.0)) << n;
  }
}

TEST(FlatTriangles, TwoLinesBackToBackAreSwappedApart) {
  // Between the faces above and below the line 0-3, two lines share that edge, each with one of the points 1
  // and 2.
  const Points points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 1, 0}, {1, -1, 0}};
  std::vector<Triangle> triangles{{0, 1, 3}, {0, 3, 2}, {3, 1, 4}, {1, 0, 4}, {0, 2, 5}, {2, 3, 5}};
  ASSERT_EQ(TriangleMesh(points, triangles).topology().openEdges, 4U);
  EXPECT_GE(swapFlatTriangles(points, triangles, 0.0), 1U);
  const TriangleMesh mesh(points, triangles);
  EXPECT_EQ(mesh.topology().openEdges, 4U);
  EXPECT_EQ(mesh.topology().inconsistentEdges, 0U);
  EXPECT_GT(leastHeightOf(mesh), 0.1);
}

TEST(FlatTriangles, LineAtAnOpenEdgeOrBesideItsTwinIsLeftAlone) {
  const Points points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  std::vector<Triangle> alone{{0, 1, 2}}, both{{0, 1, 2}, {0, 2, 1}};
  EXPECT_EQ(swapFlatTriangles(points, alone, 1e-9), 0U);
  EXPECT_EQ(swapFlatTriangles(points, both, 1e-9), 0U);
  EXPECT_EQ(both, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 1}}));
}

/// A box whose front upper edge is split below by `n` vertices that the top does not know, closed by lines.
TriangleMesh boxWithTJunctions(std::uint32_t n) {
  Points points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  std::vector<Triangle> triangles{{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {1, 2, 6}, {1, 6, 5},
                                  {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}, {0, 1, 5}};
  std::uint32_t previous = 5;
  for (std::uint32_t i = 1; i <= n; ++i) {
    points.emplace_back(1.0 - static_cast<double>(i) / (n + 1), 0, 1);
    const auto added = static_cast<std::uint32_t>(points.size() - 1);
    triangles.push_back({0, previous, added});
    triangles.push_back({4, added, previous});  // The line.
    previous = added;
  }
  triangles.push_back({0, previous, 4});
  return {points, triangles};
}

TEST(FlatTriangles, ClosedBoxWithTJunctionsStaysClosedAndKeepsItsVolume) {
  for (const std::uint32_t n : {1U, 2U, 7U, 100U}) {
    const TriangleMesh box = boxWithTJunctions(n);
    ASSERT_TRUE(box.topology().isClosed() && box.topology().isOriented());
    MeshBuildReport report;
    const TriangleMesh mesh = buildMesh(test::soupOf(box), {}, report);
    EXPECT_EQ(report.swappedFaces, n);
    EXPECT_EQ(report.degenerateFaces, 0U);
    EXPECT_TRUE(mesh.topology().isClosed() && mesh.topology().isOriented());
    EXPECT_GT(leastHeightOf(mesh), 1e-3);
    EXPECT_NEAR(massProperties(mesh).volume, 1.0, 1e-14);
    EXPECT_TRUE(report.warnings.empty());
  }
}

TEST(FlatTriangles, SwapThatWouldDoubleAnEdgeIsLeftAlone) {
  // b and d are joined already, by two faces around the outside: a tetrahedron with b moved onto the edge
  // a-c.
  const Points points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}};
  std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {2, 1, 3}};
  EXPECT_EQ(swapFlatTriangles(points, triangles, 1e-9), 0U);
  EXPECT_EQ(TriangleMesh(points, triangles).topology().nonManifoldEdges, 0U);
}

// A damaged file with one vertex very far off: the tolerance was larger than all triangles but a few, and
// swapping went round in circles for ever.
TEST(FlatTriangles, ToleranceLargerThanTheTrianglesEnds) {
  const TriangleMesh mesh = test::starMesh(1, 1.0, 0, 0.3);
  for (std::size_t far = 0; far < mesh.vertices().size(); ++far) {
    Points points(mesh.vertices().begin(), mesh.vertices().end());
    points[far].z = 999999990.0;
    for (const double tolerance : {0.1, 1.0, 1e9}) {
      std::vector<Triangle> triangles(mesh.triangles().begin(), mesh.triangles().end());
      swapFlatTriangles(points, triangles, tolerance);
      EXPECT_TRUE(TriangleMesh(points, triangles).topology().isClosed());
    }
  }
}

TEST(FlatTriangles, ManyLinesThroughOneVertexTakeLittleTime) {
  Points points{{0, 0, 0}};
  std::vector<Triangle> triangles;
  constexpr std::uint32_t kCount = 200'000;
  for (std::uint32_t i = 1; i <= kCount; ++i) {
    points.emplace_back(i % 2 == 0 ? i : -static_cast<double>(i), 0, 0);
    if (i > 1) triangles.push_back({0, i - 1, i});
  }
  EXPECT_EQ(swapFlatTriangles(points, triangles, 1e-9), 0U);
}

}  // namespace
}  // namespace nearfit::flat_triangles_test
