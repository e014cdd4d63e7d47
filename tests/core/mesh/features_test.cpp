#include "core/mesh/features.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::features_test {
namespace {

/// Random unit directions, the same each time.
std::vector<glm::dvec3> randomDirections(std::size_t count) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::vector<glm::dvec3> out;
  while (out.size() < count)
    out.push_back(glm::normalize(glm::dvec3{normal(random), normal(random), normal(random)}));
  return out;
}

TEST(Features, BoxKeepsItsCornersAndSidesButNoDiagonal) {
  const MeshFeatures f = findFeatures(test::boxMesh({1, 2, 3}));
  EXPECT_EQ(f.vertices.size(), 8U);
  EXPECT_EQ(f.edges.size(), 12U);
  EXPECT_EQ(f.faces.size(), 12U);
}

TEST(Features, BoxTurnedInsideOutIsACavityWithFacesOnly) {
  const MeshFeatures f = findFeatures(test::turned(test::boxMesh({1, 2, 3})));
  EXPECT_TRUE(f.vertices.empty());
  EXPECT_TRUE(f.edges.empty());
  EXPECT_EQ(f.faces.size(), 12U);
}

TEST(Features, FlatSquareKeepsOnlyItsRim) {
  const MeshFeatures f = findFeatures(test::squareMesh(1.0, 4));
  EXPECT_EQ(f.vertices.size(), 4U);
  EXPECT_EQ(f.edges.size(), 16U);
  for (const EdgeFeature& e : f.edges) {
    EXPECT_NEAR(e.cone.halfAngle, std::numbers::pi / 2, 1e-12);  // Half a turn: a rim has no side.
    EXPECT_NEAR(e.cone.axis.z, 0.0, 1e-12);
  }
}

TEST(Features, BoreOfATubeCarriesNoVertex) {
  constexpr std::uint32_t kSegments = 32;
  const MeshFeatures f = findFeatures(test::tubeMesh(0.5, 1.0, 0.4, kSegments));
  // Outside: two rims of vertices, two rims and the uprights of edges. In the bore: the two rims of edges
  // only.
  EXPECT_EQ(f.vertices.size(), 2 * kSegments);
  EXPECT_EQ(f.edges.size(), 5 * kSegments);
}

TEST(Features, ApexOfAThousandFacesKeepsEveryEdgeAsABoundOfItsPolarCone) {
  constexpr std::uint32_t kSegments = 1000;
  const MeshFeatures f = findFeatures(test::coneMesh(1.0, 1.0, kSegments));
  const auto apex = std::max_element(f.vertices.begin(), f.vertices.end(),
                                     [](auto& a, auto& b) { return a.neighbourCount < b.neighbourCount; });
  EXPECT_EQ(apex->neighbourCount, kSegments);
  EXPECT_NEAR(apex->cone.halfAngle, std::numbers::pi / 4, 1e-4);  // Normals of a cone as high as its radius.
  EXPECT_NEAR(apex->cone.axis.z, 1.0, 1e-9);
}

TEST(Features, PolarConesHoldExactlyTheDirectionsThatTheDefinitionAllows) {
  const auto directions = randomDirections(500);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const TriangleMesh mesh = test::starMesh(seed, 1.0, 2, 0.5);
    const MeshFeatures f = findFeatures(mesh);
    const auto x = mesh.vertices();
    std::size_t allowed = 0;
    for (const VertexFeature& v : f.vertices) {
      for (const glm::dvec3& d : directions) {
        bool byAll = true, byKept = true;
        for (const std::uint32_t e : mesh.edgesOfVertex(v.vertex)) {
          const std::uint32_t other =
              mesh.edges()[e].v0 == v.vertex ? mesh.edges()[e].v1 : mesh.edges()[e].v0;
          byAll = byAll && glm::dot(d, x[other] - x[v.vertex]) <= 0.0;
        }
        for (std::uint32_t i = 0; i < v.neighbourCount; ++i) {
          byKept = byKept && glm::dot(d, x[f.neighbours[v.firstNeighbour + i]] - x[v.vertex]) <= 0.0;
        }
        EXPECT_EQ(byAll, byKept);
        if (byAll) {
          EXPECT_LE(angleBetween(d, v.cone.axis), v.cone.halfAngle + 1e-9);
        }
        allowed += byAll ? 1 : 0;
      }
    }
    EXPECT_GT(allowed, 100U);
  }
}

TEST(Features, DroppedVerticesOfARandomMeshHaveNoOutwardPolarDirection) {
  const auto directions = randomDirections(2000);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const TriangleMesh mesh = test::starMesh(seed, 1.0, 2, 0.5);
    std::vector<bool> isKept(mesh.vertices().size(), false);
    for (const VertexFeature& v : findFeatures(mesh).vertices)
      isKept[v.vertex] = true;
    const auto x = mesh.vertices();
    for (std::uint32_t v = 0; v < x.size(); ++v) {
      if (isKept[v]) continue;
      for (const glm::dvec3& d : directions) {
        bool allowed = true;
        for (const std::uint32_t e : mesh.edgesOfVertex(v)) {
          const std::uint32_t other = mesh.edges()[e].v0 == v ? mesh.edges()[e].v1 : mesh.edges()[e].v0;
          allowed = allowed && glm::dot(d, x[other] - x[v]) < 0.0;
        }
        // Star-shaped about the origin: outward is away from it, as far as the polar cone goes.
        EXPECT_FALSE(allowed && glm::dot(d, x[v]) > 0.0);
      }
    }
  }
}

TEST(Features, ApexWhoseFacesCrossIsKeptWhereItsPseudonormalLooksOut) {
  // Angles times unit normals, along z: 0.33 of the far face, -1.30 of either that crosses, -0.87 of the near
  // one; though in the plane below it the far lobe is the larger.
  constexpr std::uint32_t kApex = 4;
  const auto isKept = [](const TriangleMesh& mesh) {
    const MeshFeatures f = findFeatures(mesh);
    return std::ranges::any_of(f.vertices, [](const VertexFeature& v) { return v.vertex == kApex; });
  };
  EXPECT_FALSE(isKept(test::crossedApexMesh()));
  EXPECT_TRUE(isKept(test::turned(test::crossedApexMesh())));
}

TEST(Features, NonManifoldEdgeKeepsTheArcThatAllItsFacesAllow) {
  // Three fins from one edge along z, at 0, 40 and 80 degrees: the polar arc is half a turn less 80 degrees.
  std::vector<glm::dvec3> x{{0, 0, 0}, {0, 0, 1}};
  std::vector<Triangle> t;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const double angle = i * 40.0 * std::numbers::pi / 180.0;
    x.push_back({std::cos(angle), std::sin(angle), 0.5});
    t.push_back({0, 1, 2 + i});
  }
  const MeshFeatures f = findFeatures(TriangleMesh(x, t));
  const auto shared =
      std::find_if(f.edges.begin(), f.edges.end(), [](auto& e) { return e.opposite[0] != e.opposite[1]; });
  ASSERT_NE(shared, f.edges.end());
  EXPECT_NEAR(shared->cone.halfAngle, 50.0 * std::numbers::pi / 180.0, 1e-12);
  const double middle = 40.0 * std::numbers::pi / 180.0;
  EXPECT_NEAR(glm::dot(shared->cone.axis, glm::dvec3(-std::cos(middle), -std::sin(middle), 0.0)), 1.0, 1e-12);
}

TEST(Features, FacesWithoutAreaCarryNothing) {
  const TriangleMesh mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}});
  EXPECT_TRUE(findFeatures(mesh).faces.empty());
}

}  // namespace
}  // namespace nearfit::features_test
