#include "core/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::triangle_mesh_test {
namespace {

/// Six times the volume, by tetrahedra to the origin.
double signedVolume6(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles()) {
    sum += glm::dot(mesh.vertices()[t[0]], glm::cross(mesh.vertices()[t[1]], mesh.vertices()[t[2]]));
  }
  return sum;
}

void expectClosedOutward(const TriangleMesh& mesh, std::size_t triangles, int eulerCharacteristic) {
  EXPECT_EQ(mesh.triangles().size(), triangles);
  EXPECT_TRUE(mesh.topology().isClosed());
  EXPECT_TRUE(mesh.topology().isOriented());
  EXPECT_EQ(mesh.topology().components, 1U);
  EXPECT_GT(signedVolume6(mesh), 0.0);
  const auto v = static_cast<int>(mesh.vertices().size());
  const auto e = static_cast<int>(mesh.edges().size());
  const auto f = static_cast<int>(mesh.triangles().size());
  EXPECT_EQ(v - e + f, eulerCharacteristic);
}

TEST(TriangleMesh, GeneratedShapesAreClosedAndFaceOutward) {
  expectClosedOutward(test::tetrahedronMesh(), 4, 2);
  expectClosedOutward(test::boxMesh({1, 2, 3}), 12, 2);
  expectClosedOutward(test::uvSphereMesh(1, 8, 5), 64, 2);
  expectClosedOutward(test::icosphereMesh(1, 2), 320, 2);
  expectClosedOutward(test::torusMesh(2, 0.5, 9, 7), 126, 0);
  expectClosedOutward(test::cylinderMesh(1, 2, 11), 44, 2);
  expectClosedOutward(test::tubeMesh(1, 2, 3, 10), 80, 0);
  expectClosedOutward(test::coneMesh(1, 2, 12), 24, 2);
  expectClosedOutward(test::starMesh(1, 1, 2, 0.4), 320, 2);
}

TEST(TriangleMesh, SameSeedGivesTheSameStarAndAnotherSeedAnother) {
  const TriangleMesh a = test::starMesh(7, 1, 1, 0.3), b = test::starMesh(7, 1, 1, 0.3),
                     c = test::starMesh(8, 1, 1, 0.3);
  EXPECT_TRUE(std::ranges::equal(a.vertices(), b.vertices()));
  EXPECT_FALSE(std::ranges::equal(a.vertices(), c.vertices()));
}

TEST(TriangleMesh, EveryEdgeOfABoxHasTwoFacesThatNameItBack) {
  const TriangleMesh mesh = test::boxMesh({1, 1, 1});
  ASSERT_EQ(mesh.edges().size(), 18U);
  for (std::uint32_t e = 0; e < mesh.edges().size(); ++e) {
    EXPECT_LT(mesh.edges()[e].v0, mesh.edges()[e].v1);
    ASSERT_EQ(mesh.facesOfEdge(e).size(), 2U);
    EXPECT_TRUE(mesh.isEdgeConsistent(e));
    for (const std::uint32_t face : mesh.facesOfEdge(e)) {
      EXPECT_EQ(std::ranges::count(mesh.edgesOfTriangle(face), e), 1);
    }
  }
}

TEST(TriangleMesh, EdgeKOfATriangleJoinsCornersKAndKPlusOne) {
  const TriangleMesh mesh = test::starMesh(3, 1, 1, 0.2);
  for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    const Triangle& corners = mesh.triangles()[t];
    for (std::uint32_t k = 0; k < 3; ++k) {
      const MeshEdge& edge = mesh.edges()[mesh.edgesOfTriangle(t)[k]];
      EXPECT_EQ(std::minmax(corners[k], corners[(k + 1) % 3]), std::minmax(edge.v0, edge.v1));
    }
  }
}

TEST(TriangleMesh, EdgesOfAVertexAreThoseThatEndInIt) {
  const TriangleMesh mesh = test::starMesh(4, 1, 1, 0.2);
  for (std::uint32_t v = 0; v < mesh.vertices().size(); ++v) {
    std::set<std::uint32_t> expected;
    for (std::uint32_t e = 0; e < mesh.edges().size(); ++e) {
      if (mesh.edges()[e].v0 == v || mesh.edges()[e].v1 == v) expected.insert(e);
    }
    const auto edges = mesh.edgesOfVertex(v);
    EXPECT_EQ(std::set<std::uint32_t>(edges.begin(), edges.end()), expected);
    EXPECT_EQ(edges.size(), expected.size());
  }
}

TEST(TriangleMesh, SingleTriangleHasThreeOpenEdges) {
  const TriangleMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  EXPECT_EQ(mesh.topology().openEdges, 3U);
  EXPECT_EQ(mesh.topology().components, 1U);
  EXPECT_FALSE(mesh.topology().isClosed());
  EXPECT_FALSE(mesh.isEdgeConsistent(0));
}

TEST(TriangleMesh, ThreeFacesOnAnEdgeAreNonManifold) {
  const TriangleMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                          {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  EXPECT_EQ(mesh.topology().nonManifoldEdges, 1U);
  EXPECT_EQ(mesh.topology().openEdges, 6U);
  EXPECT_EQ(mesh.topology().inconsistentEdges, 0U);
  EXPECT_EQ(mesh.topology().components, 1U);
}

TEST(TriangleMesh, TurnedNeighbourMakesItsEdgeInconsistent) {
  const TriangleMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 2, 3}});
  EXPECT_EQ(mesh.topology().inconsistentEdges, 1U);
  EXPECT_FALSE(mesh.topology().isOriented());
}

TEST(TriangleMesh, TwoBoxesAreTwoComponentsEvenWhereTheyShareAVertexOnly) {
  const TriangleMesh apart = test::joined(test::boxMesh({1, 1, 1}), test::boxMesh({1, 1, 1}, {5, 0, 0}));
  EXPECT_EQ(apart.topology().components, 2U);
  const TriangleMesh bowTie({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                            {{0, 1, 2}, {0, 3, 4}});
  EXPECT_EQ(bowTie.topology().components, 2U);
}

TEST(TriangleMesh, BoundsLeaveOutUnusedVertices) {
  const TriangleMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {99, 99, 99}}, {{0, 1, 2}});
  EXPECT_EQ(mesh.bounds().lower, glm::dvec3(0, 0, 0));
  EXPECT_EQ(mesh.bounds().upper, glm::dvec3(1, 2, 0));
  EXPECT_TRUE(mesh.edgesOfVertex(3).empty());
}

TEST(TriangleMesh, EmptyMeshIsEmpty) {
  const TriangleMesh mesh({}, {});
  EXPECT_TRUE(mesh.triangles().empty());
  EXPECT_TRUE(mesh.bounds().isEmpty());
  EXPECT_EQ(mesh.topology().components, 0U);
}

TEST(TriangleMesh, NonFiniteVertexBadIndexAndRepeatedCornerAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_THROW(TriangleMesh({{0, 0, 0}, {1, 0, 0}, {0, nan, 0}}, {{0, 1, 2}}), Error);
  EXPECT_THROW(TriangleMesh({{0, 0, 0}, {1, 0, -inf}, {0, 1, 0}}, {{0, 1, 2}}), Error);
  EXPECT_THROW(TriangleMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}), Error);
  EXPECT_THROW(TriangleMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 1}}), Error);
  EXPECT_THROW(TriangleMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{2, 1, 2}}), Error);
}

TEST(TriangleMesh, ByteSizeCountsAtLeastTheArrays) {
  const TriangleMesh mesh = test::boxMesh({1, 1, 1});
  EXPECT_GE(mesh.byteSize(), 8 * sizeof(glm::dvec3) + 12 * sizeof(Triangle) + 18 * sizeof(MeshEdge));
  EXPECT_LT(mesh.byteSize(), 4096U);
}

}  // namespace
}  // namespace nearfit::triangle_mesh_test
