#include "core/mesh/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mesh/mass_properties.h"
#include "tests/support/mesh_files.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::mesh_builder_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::SizeIs;

PolygonSoup soupOf(std::vector<glm::dvec3> vertices,
                   const std::vector<std::vector<std::uint32_t>>& polygons) {
  PolygonSoup soup;
  soup.vertices = std::move(vertices);
  for (const auto& polygon : polygons) {
    soup.corners.insert(soup.corners.end(), polygon.begin(), polygon.end());
    soup.closePolygon();
  }
  return soup;
}

/// Every triangle with three vertices of its own, as STL has them.
PolygonSoup shatteredSoup(const TriangleMesh& mesh) {
  PolygonSoup soup;
  for (const Triangle& t : mesh.triangles()) {
    for (const std::uint32_t v : t) {
      soup.corners.push_back(static_cast<std::uint32_t>(soup.vertices.size()));
      soup.vertices.push_back(mesh.vertices()[v]);
    }
    soup.closePolygon();
  }
  return soup;
}

TriangleMesh build(const PolygonSoup& soup, const MeshBuildOptions& options = {}) {
  MeshBuildReport report;
  return buildMesh(soup, options, report);
}

const std::vector<glm::dvec3> kSquare{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

TEST(MeshBuilder, ShatteredBoxIsWeldedToEightVertices) {
  MeshBuildReport report;
  const TriangleMesh mesh = buildMesh(shatteredSoup(test::boxMesh({1, 2, 3})), {}, report);
  EXPECT_EQ(mesh.vertices().size(), 8U);
  EXPECT_TRUE(mesh.topology().isClosed());
  EXPECT_EQ(report.weldedVertices, 36U - 8U);
  EXPECT_THAT(report.warnings, SizeIs(0));
}

TEST(MeshBuilder, EachTriangleKnowsThePolygonThatItCameFrom) {
  // A face without area, a square, a face that is not finite, a triangle whose edge is cracked by the square, so that it
  // is cut in two, one that repeats it, and another one.
  const double nan = std::nan("");
  const PolygonSoup soup =
      soupOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {nan, 0, 0}, {2, 0, 0}, {0, -1, 0}},
             {{0, 0, 1}, {0, 1, 2, 3}, {0, 1, 4}, {5, 0, 6}, {0, 6, 5}, {1, 5, 2}});
  MeshBuildReport report;
  std::vector<std::uint32_t> polygonOf;
  const TriangleMesh mesh = buildMesh(soup, {}, report, {}, &polygonOf);
  ASSERT_EQ(polygonOf.size(), mesh.triangles().size());
  EXPECT_EQ(report.stitchedEdges, 3U);
  // By where its middle is: the square, the triangle below the axis and the one to the right.
  std::vector<int> counts(6, 0);
  for (std::size_t i = 0; i < polygonOf.size(); ++i) {
    const Triangle& t = mesh.triangles()[i];
    const glm::dvec3 middle = (mesh.vertices()[t[0]] + mesh.vertices()[t[1]] + mesh.vertices()[t[2]]) / 3.0;
    const std::uint32_t expected = middle.y < 0.0 ? 3U : middle.x < 1.0 ? 1U : 5U;
    EXPECT_EQ(polygonOf[i], expected) << i;
    ++counts[polygonOf[i]];
  }
  EXPECT_EQ(counts[1], 2);
  EXPECT_EQ(counts[3], 2);
  EXPECT_EQ(counts[5], 1);
}

TEST(MeshBuilder, TrianglesOfASwapCountToTheFaceThatTheyCover) {
  // A line along the diagonal of a square, between its two halves.
  const PolygonSoup soup = soupOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}},
                                  {{0, 1, 2}, {0, 4, 3}, {4, 2, 3}, {0, 2, 4}});
  MeshBuildReport report;
  std::vector<std::uint32_t> polygonOf;
  const TriangleMesh mesh = buildMesh(soup, {}, report, {}, &polygonOf);
  EXPECT_EQ(report.swappedFaces, 1U);
  ASSERT_EQ(mesh.triangles().size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const Triangle& t = mesh.triangles()[i];
    const glm::dvec3 middle = (mesh.vertices()[t[0]] + mesh.vertices()[t[1]] + mesh.vertices()[t[2]]) / 3.0;
    EXPECT_EQ(polygonOf[i] == 0U, middle.x > middle.y) << i;
  }
}

TEST(MeshBuilder, UnitScalesToMetres) {
  const TriangleMesh mesh = build(test::soupOf(test::boxMesh({10, 20, 30})), {.metresPerUnit = 1e-3});
  EXPECT_NEAR(mesh.bounds().upper.z, 0.015, 1e-17);
  EXPECT_NEAR(mesh.bounds().diagonal(), 1e-3 * std::sqrt(1400.0), 1e-16);
}

TEST(MeshBuilder, UnitThatIsNotFiniteAndPositiveIsRefused) {
  const PolygonSoup soup = test::soupOf(test::boxMesh({1, 1, 1}));
  for (const double unit : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(build(soup, {.metresPerUnit = unit}), UsageError) << unit;
  }
  for (const double tolerance : {-1e-9, std::nan(""), 0.5}) {
    EXPECT_THROW(build(soup, {.weldTolerance = tolerance}), UsageError) << tolerance;
  }
}

TEST(MeshBuilder, VerticesWithinTheToleranceAreWeldedAndNoOthers) {
  // The diagonal is 5, so that a tolerance of 0.01 is 0.05.
  const std::vector<glm::dvec3> vertices{{0, 0, 0},     {3, 0, 0}, {3, 4, 0},
                                         {0, 0.049, 0}, {3, 4, 0}, {0, 4, 0}};
  MeshBuildReport report;
  const TriangleMesh joined =
      buildMesh(soupOf(vertices, {{0, 1, 2}, {3, 4, 5}}), {.weldTolerance = 0.01}, report);
  EXPECT_EQ(joined.vertices().size(), 4U);
  EXPECT_EQ(report.weldedVertices, 2U);
  const TriangleMesh apart =
      buildMesh(soupOf(vertices, {{0, 1, 2}, {3, 4, 5}}), {.weldTolerance = 0.0097}, report);
  EXPECT_EQ(apart.vertices().size(), 5U);
}

TEST(MeshBuilder, WeldingFollowsTheUnitAndTheOffset) {
  for (const double scale : {1e-6, 1.0, 1e3}) {
    for (const double offset : {0.0, 1e4}) {
      const RigidTransform motion{{1, 0, 0, 0}, glm::dvec3(offset * scale)};
      PolygonSoup soup = shatteredSoup(test::transformed(test::starMesh(5, 1, 2, 0.2), scale, motion));
      double shift = 1e-10 * scale;
      for (glm::dvec3& p : soup.vertices)
        p.x += (shift = -shift);
      const TriangleMesh mesh = build(soup);
      EXPECT_EQ(mesh.vertices().size(), 162U) << scale << " " << offset;
      EXPECT_TRUE(mesh.topology().isClosed());
    }
  }
}

TEST(MeshBuilder, ChainOfCloseVerticesDoesNotCollapse) {
  // Each of the points on the chain is within the tolerance of the next, not of the one after that.
  std::vector<glm::dvec3> vertices{{0, 0, 0}, {0, 10, 0}};
  std::vector<std::vector<std::uint32_t>> polygons;
  for (std::uint32_t i = 0; i < 10; ++i) {
    vertices.emplace_back(0.08 * (i + 1), 0, 0);
    if (i > 0) polygons.push_back({i + 1, i + 2, 1});
  }
  const TriangleMesh mesh = build(soupOf(vertices, polygons), {.weldTolerance = 0.01});
  EXPECT_NEAR(mesh.bounds().upper.x, 0.8, 0.101);
  EXPECT_EQ(mesh.vertices().size(), 6U);  // Every second one stays, and the tip.
}

TEST(MeshBuilder, ToleranceOfZeroWeldsEqualVerticesOnly) {
  PolygonSoup soup = shatteredSoup(test::boxMesh({1, 1, 1}));
  EXPECT_EQ(build(soup, {.weldTolerance = 0.0}).vertices().size(), 8U);
  soup.vertices[0].x = std::nextafter(soup.vertices[0].x, 9.0);
  EXPECT_EQ(build(soup, {.weldTolerance = 0.0}).vertices().size(), 9U);
}

TEST(MeshBuilder, NegativeZeroIsZero) {
  const PolygonSoup soup =
      soupOf({{0.0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, 0}, {-1, 0, 0}}, {{0, 1, 2}, {3, 2, 4}});
  EXPECT_EQ(build(soup, {.weldTolerance = 0.0}).vertices().size(), 4U);
}

TEST(MeshBuilder, InsideOutCubeIsTurned) {
  MeshBuildReport report;
  const TriangleMesh mesh = buildMesh(test::soupOf(test::turned(test::boxMesh({1, 1, 1}))), {}, report);
  EXPECT_TRUE(report.turnedInsideOut);
  EXPECT_THAT(report.warnings, Contains(HasSubstr("inside out")));
  EXPECT_NEAR(massProperties(mesh).volume, 1.0, 1e-15);
}

TEST(MeshBuilder, CavityIsNotTurned) {
  const TriangleMesh hollow = test::joined(test::boxMesh({2, 2, 2}), test::turned(test::boxMesh({1, 1, 1})));
  MeshBuildReport report;
  const TriangleMesh mesh = buildMesh(test::soupOf(hollow), {}, report);
  EXPECT_FALSE(report.turnedInsideOut);
  EXPECT_NEAR(massProperties(mesh).volume, 7.0, 1e-14);
}

TEST(MeshBuilder, HollowBodyThatIsInsideOutIsTurnedWithItsCavity) {
  const TriangleMesh hollow = test::joined(test::boxMesh({2, 2, 2}), test::turned(test::boxMesh({1, 1, 1})));
  const TriangleMesh mesh = build(test::soupOf(test::turned(hollow)));
  EXPECT_NEAR(massProperties(mesh).volume, 7.0, 1e-14);
}

TEST(MeshBuilder, PieceThatIsInsideOutIsTurnedBesideOthersThatAreNot) {
  const TriangleMesh large = test::boxMesh({2, 2, 2}), small = test::boxMesh({1, 1, 1}, {5, 0, 0});
  for (const TriangleMesh& both :
       {test::joined(large, test::turned(small)), test::joined(test::turned(large), small)}) {
    MeshBuildReport report;
    const TriangleMesh mesh = buildMesh(test::soupOf(both), {}, report);
    EXPECT_NEAR(massProperties(mesh).volume, 9.0, 1e-14);
    EXPECT_THAT(report.warnings, Contains("1 of 2 closed components was inside out and flipped."));
  }
}

TEST(MeshBuilder, ClosedPieceIsTurnedThoughAnotherPieceIsOpen) {
  const TriangleMesh both =
      test::joined(test::squareMesh(9, 1), test::turned(test::boxMesh({1, 1, 1}, {5, 0, 3})));
  MeshBuildReport report;
  const TriangleMesh mesh = buildMesh(test::soupOf(both), {}, report);
  EXPECT_TRUE(report.turnedInsideOut);
  EXPECT_EQ(mesh.triangles()[0], (Triangle{0, 1, 2}));  // The open piece stays as it is.
}

TEST(MeshBuilder, RepeatedCornersAndLinesAreLeftOut) {
  MeshBuildReport report;
  const TriangleMesh mesh = buildMesh(soupOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}},
                                             {{0, 1, 2}, {0, 0, 1}, {0, 1}, {}, {0, 1, 3}, {1, 2, 1}}),
                                      {}, report);
  EXPECT_EQ(mesh.triangles().size(), 1U);
  EXPECT_EQ(mesh.vertices().size(), 3U);
  EXPECT_EQ(report.degenerateFaces, 5U);
  EXPECT_THAT(report.warnings, Contains("5 faces have no area and were left out."));
}

TEST(MeshBuilder, DuplicatesInTheSameSenseAreLeftOutTheOthersStay) {
  MeshBuildReport report;
  const TriangleMesh mesh =
      buildMesh(soupOf(kSquare, {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {0, 2, 3}}), {}, report);
  EXPECT_EQ(mesh.triangles().size(), 3U);
  EXPECT_EQ(report.duplicateFaces, 2U);
  EXPECT_THAT(report.warnings, Contains("2 faces repeat others and were left out."));
}

TEST(MeshBuilder, FacesWithoutFiniteCoordinatesAreLeftOutAndDoNotCountForTheBox) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  MeshBuildReport report;
  const TriangleMesh mesh = buildMesh(soupOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {nan, 0, 0}, {0, inf, 0}},
                                             {{0, 1, 2}, {0, 1, 3}, {0, 4, 1, 2}}),
                                      {}, report);
  EXPECT_EQ(mesh.triangles().size(), 1U);
  EXPECT_EQ(report.nonFiniteFaces, 2U);
  EXPECT_THAT(report.warnings, Contains(HasSubstr("2 faces have coordinates that are not finite")));
}

TEST(MeshBuilder, NothingLeftAndBadIndicesAreRefusedWithARemedy) {
  const double nan = std::nan("");
  const std::vector<PolygonSoup> soups{soupOf({{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}),
                                       soupOf(kSquare, {{0, 1, 1}}), soupOf(kSquare, {}),
                                       soupOf(kSquare, {{0, 1, 7}}),
                                       soupOf({{0, 0, 0}, {1e300, 0, 0}, {0, 1e300, 0}}, {{0, 1, 2}})};
  for (std::size_t i = 0; i < soups.size(); ++i) {
    try {
      build(soups[i]);
      ADD_FAILURE() << i;
    } catch (const Error& error) {
      EXPECT_FALSE(error.remedy().empty()) << i;
    }
  }
}

TEST(MeshBuilder, SoupThatContradictsItselfIsRefused) {
  PolygonSoup soup = test::soupOf(test::boxMesh({1, 1, 1}));
  soup.firstCorner[3] = 1000;
  EXPECT_THROW(build(soup), Error);
  soup.firstCorner.clear();
  EXPECT_THROW(build(soup), Error);
}

TEST(MeshBuilder, EachKindOfEdgeIsWarnedOfWithItsCount) {
  MeshBuildReport report;
  // Three faces meet on 0-1; both faces of 2-0 run from 2 to 0; the other seven edges have one face.
  buildMesh(soupOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                   {{0, 1, 2}, {0, 3, 2}, {0, 1, 4}, {0, 1, 5}}),
            {}, report);
  EXPECT_THAT(report.warnings, Contains(HasSubstr("1 edge is non-manifold")));
  EXPECT_THAT(report.warnings, Contains(HasSubstr("1 edge is inconsistent")));
  EXPECT_THAT(report.warnings, Contains(HasSubstr("7 edges are open")));
}

TEST(MeshBuilder, AMeshIsMendedIfNothingRemainsAndOpenIfAnEdgeIs) {
  const auto conditionFrom = [](const PolygonSoup& soup, const char* ofReader) {
    MeshBuildReport report;
    const TriangleMesh mesh = buildMesh(soup, {}, report);
    if (ofReader != nullptr) report.warnings.insert(report.warnings.begin(), ofReader);
    return conditionOf(mesh, report);
  };
  const PolygonSoup box = test::soupOf(test::boxMesh({1, 1, 1}));
  EXPECT_EQ(conditionFrom(box, nullptr), MeshCondition::Sound);
  EXPECT_EQ(conditionFrom(box, "The file was cut off."), MeshCondition::Doubtful);
  // A face twice, one with a repeated corner, and one that is nowhere.
  PolygonSoup faulty = box;
  faulty.vertices.emplace_back(std::nan(""), 0, 0);
  const auto nowhere = static_cast<std::uint32_t>(faulty.vertices.size() - 1);
  for (const Triangle& t : {Triangle{box.corners[0], box.corners[1], box.corners[2]}, Triangle{0, 0, 1},
                            Triangle{0, 1, nowhere}}) {
    faulty.corners.insert(faulty.corners.end(), t.begin(), t.end());
    faulty.closePolygon();
  }
  EXPECT_EQ(conditionFrom(faulty, nullptr), MeshCondition::Mended);
  EXPECT_EQ(conditionFrom(faulty, "The file was cut off."), MeshCondition::Doubtful);
  EXPECT_EQ(conditionFrom(test::soupOf(test::turned(test::boxMesh({1, 1, 1}))), nullptr),
            MeshCondition::Mended);
  // And the box without a face.
  PolygonSoup open;
  open.vertices = box.vertices;
  open.corners = {box.corners.begin() + 3, box.corners.end()};
  open.firstCorner = {box.firstCorner.begin(), box.firstCorner.end() - 1};
  EXPECT_EQ(conditionFrom(open, nullptr), MeshCondition::Open);
}

TEST(MeshBuilder, SameSoupGivesTheSameMesh) {
  const PolygonSoup soup = shatteredSoup(test::starMesh(9, 1, 3, 0.4));
  const TriangleMesh a = build(soup), b = build(soup);
  EXPECT_TRUE(std::ranges::equal(a.vertices(), b.vertices()));
  EXPECT_TRUE(std::ranges::equal(a.triangles(), b.triangles()));
}

TEST(MeshBuilder, BuildingABuiltMeshChangesNothing) {
  const TriangleMesh a = build(shatteredSoup(test::torusMesh(2, 0.5, 40, 20)));
  const TriangleMesh b = build(test::soupOf(a));
  EXPECT_TRUE(std::ranges::equal(a.vertices(), b.vertices()));
  EXPECT_TRUE(std::ranges::equal(a.triangles(), b.triangles()));
}

}  // namespace
}  // namespace nearfit::mesh_builder_test
