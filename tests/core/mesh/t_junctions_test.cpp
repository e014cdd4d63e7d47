#include "core/mesh/t_junctions.h"

#include <algorithm>
#include <random>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/import/mesh_import.h"
#include "core/mesh/mass_properties.h"
#include "core/mesh/mesh_builder.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::t_junctions_test {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A box of which one face is a grid of squares and the others are two triangles each: each rim of the grid
/// has `divisions` - 1 vertices on an edge of its neighbour.
PolygonSoup boxWithAGrid(std::uint32_t divisions, const glm::dvec3& size) {
  PolygonSoup soup;
  const auto polygon = [&](const std::vector<glm::dvec3>& corners) {
    for (const glm::dvec3& p : corners) {
      soup.corners.push_back(static_cast<std::uint32_t>(soup.vertices.size()));
      soup.vertices.push_back(p * size);
    }
    soup.closePolygon();
  };
  for (std::uint32_t i = 0; i < divisions; ++i) {
    for (std::uint32_t j = 0; j < divisions; ++j) {
      const double x0 = double(i) / divisions, x1 = double(i + 1) / divisions;
      const double y0 = double(j) / divisions, y1 = double(j + 1) / divisions;
      polygon({{x0, y0, 1}, {x1, y0, 1}, {x1, y1, 1}, {x0, y1, 1}});
    }
  }
  polygon({{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}});
  polygon({{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}});
  polygon({{0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0}});
  polygon({{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0}});
  polygon({{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}});
  return soup;
}

TEST(TJunctions, BoxWithOneFineFaceIsClosed) {
  for (const std::uint32_t n : {2U, 3U, 10U}) {
    MeshBuildReport report;
    const TriangleMesh mesh = buildMesh(boxWithAGrid(n, {1, 2, 3}), {}, report);
    EXPECT_TRUE(mesh.topology().isClosed() && mesh.topology().isOriented()) << n;
    EXPECT_EQ(mesh.triangles().size(), 2 * n * n + 10 + 4 * (n - 1));
    // Four long edges and n short ones on each.
    EXPECT_EQ(report.stitchedEdges, 4 * (n + 1));
    EXPECT_THAT(report.warnings, Contains(HasSubstr(std::to_string(4 * (n + 1)) + " edges were cracked")));
    const MassProperties mass = massProperties(mesh);
    EXPECT_EQ(mass.basis, MassBasis::VolumeIntegrals);
    EXPECT_NEAR(mass.volume, 6.0, 1e-12);
    EXPECT_FALSE(report.turnedInsideOut);
  }
}

TEST(TJunctions, TurnedAndRoundedToSinglePrecisionItIsClosedToo) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20; ++i) {
    const glm::dquat turn =
        glm::normalize(glm::dquat{normal(random), normal(random), normal(random), normal(random)});
    PolygonSoup soup = boxWithAGrid(5, {1, 0.2, 3});
    for (glm::dvec3& p : soup.vertices)
      p = test::inSinglePrecision(turn * p + glm::dvec3(1, 2, 3));
    MeshBuildReport report;
    const TriangleMesh mesh = buildMesh(soup, {}, report);
    EXPECT_TRUE(mesh.topology().isClosed() && mesh.topology().isOriented());
    EXPECT_NEAR(massProperties(mesh).volume, 0.6, 1e-5);
  }
}

TEST(TJunctions, RowsOfVerticesThatInterlaceOnBothSidesAreStitched) {
  // A square in two halves; one has its middle edge cut at 1/3, the other at 1/2 and 2/3.
  const std::vector<glm::dvec3> v{{0, 0, 0}, {0, 6, 0}, {-3, 3, 0}, {3, 3, 0},
                                  {0, 2, 0}, {0, 3, 0}, {0, 4, 0}};
  const TriangleMesh mesh(v, {{0, 4, 2}, {4, 1, 2}, {5, 0, 3}, {6, 5, 3}, {1, 6, 3}});
  const std::vector<Triangle> stitched = stitchTJunctions(mesh);
  const TriangleMesh whole(v, stitched);
  EXPECT_EQ(stitched.size(), 8U);
  EXPECT_EQ(whole.topology().openEdges, 4U);
  EXPECT_EQ(whole.topology().nonManifoldEdges, 0U);
  EXPECT_TRUE(whole.topology().isOriented());
}

TEST(TJunctions, TriangleOpenOnAllSidesIsSplitOnAll) {
  // The roof of a tetrahedron's base, the other faces halved along their edges with it.
  const glm::dvec3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0), d(0, 0, 4);
  const std::vector<glm::dvec3> v{a, b, c, d, 0.5 * (a + b), 0.5 * (b + c), 0.25 * (c + 3.0 * a)};
  const TriangleMesh mesh(v, {{0, 2, 1}, {0, 4, 3}, {4, 1, 3}, {1, 5, 3}, {5, 2, 3}, {2, 6, 3}, {6, 0, 3}});
  ASSERT_EQ(mesh.topology().openEdges, 9U);
  const std::vector<Triangle> stitched = stitchTJunctions(mesh);
  const TriangleMesh whole(v, stitched);
  EXPECT_TRUE(whole.topology().isClosed() && whole.topology().isOriented());
  EXPECT_NEAR(massProperties(whole).volume, 64.0 / 6.0, 1e-12);
  // The others keep their numbers; four pieces are left of the first, one of them in its place.
  EXPECT_TRUE(std::equal(stitched.begin() + 1, stitched.begin() + 7, mesh.triangles().begin() + 1));
  EXPECT_EQ(stitched.size(), 10U);
}

TEST(TJunctions, WhatHasNoneIsLeftAlone) {
  EXPECT_TRUE(stitchTJunctions(test::boxMesh({1, 2, 3})).empty());
  EXPECT_TRUE(stitchTJunctions(test::squareMesh(1.0, 5)).empty());
  EXPECT_TRUE(stitchTJunctions(TriangleMesh()).empty());
  // Two sheets that touch along an edge with vertices on it, but from the same side: nothing would close.
  const std::vector<glm::dvec3> v{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0, 0}, {0.5, -1, 0}};
  EXPECT_TRUE(stitchTJunctions(TriangleMesh(v, {{0, 1, 2}, {0, 3, 4}})).empty());
  // A vertex a little off the edge.
  std::vector<glm::dvec3> off{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, -1e-4, 0}, {1, -1, 0}};
  EXPECT_TRUE(stitchTJunctions(TriangleMesh(off, {{0, 1, 2}, {3, 0, 4}, {1, 3, 4}})).empty());
  off[3].y = -1e-7;
  EXPECT_EQ(stitchTJunctions(TriangleMesh(off, {{0, 1, 2}, {3, 0, 4}, {1, 3, 4}})).size(), 4U);
}

TEST(TJunctions, EdgeOfWhichAPieceWouldStayOpenIsLeftWhole) {
  // Only half of the long edge has a face behind it.
  const std::vector<glm::dvec3> v{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0, 0}, {0.5, -1, 0}};
  EXPECT_TRUE(stitchTJunctions(TriangleMesh(v, {{0, 1, 2}, {3, 0, 4}})).empty());
}

TEST(TJunctions, NoEdgeIsMadeThatIsThereAlready) {
  // The way from the vertex on the edge to the corner over it is an edge of other faces.
  const std::vector<glm::dvec3> v{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0, 0}, {1, -1, 0}, {1, 1, 5}};
  const TriangleMesh mesh(v, {{0, 1, 2}, {3, 0, 4}, {1, 3, 4}, {2, 3, 5}});
  EXPECT_TRUE(stitchTJunctions(mesh).empty());
}

TEST(TJunctions, LooseTrianglesTakeNoTimeToSpeakOf) {
  // A hundred thousand, across each other: each open edge has all others' vertices about it.
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  std::vector<glm::dvec3> v;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    for (int k = 0; k < 3; ++k)
      v.emplace_back(coordinate(random), coordinate(random), coordinate(random));
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  EXPECT_TRUE(stitchTJunctions(TriangleMesh(v, triangles)).empty());
}

TEST(TJunctions, StitchedMeshReadsBackTheSame) {
  MeshBuildReport report;
  const TriangleMesh mesh = buildMesh(boxWithAGrid(4, {1, 2, 3}), {}, report);
  const test::TemporaryFolder folder;
  const ImportedMesh again = importMesh(folder.write("box.ply", test::plyBinary(mesh)), {});
  EXPECT_EQ(again.report.stitchedEdges, 0U);
  EXPECT_TRUE(std::ranges::equal(again.mesh.triangles(), mesh.triangles()));
  EXPECT_TRUE(again.report.warnings.empty());
}

}  // namespace
}  // namespace nearfit::t_junctions_test
