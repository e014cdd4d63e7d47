#include "core/mesh/idle_features.h"

#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/mesh_generators.h"

namespace nearfit::idle_features_test {
namespace {

struct Counts {
  std::size_t vertices, edges;
};

/// How many are added.
Counts idleOf(const TriangleMesh& mesh) {
  MeshFeatures features = findFeatures(mesh);
  const Counts before{features.vertices.size(), features.edges.size()};
  addIdleFeatures(mesh, features);
  return {features.vertices.size() - before.vertices, features.edges.size() - before.edges};
}

TEST(IdleFeatures, OfABoxAreTheDiagonalsOfItsSides) {
  const Counts idle = idleOf(test::boxMesh(glm::dvec3(1.0)));
  EXPECT_EQ(idle.vertices, 0U);
  EXPECT_EQ(idle.edges, 6U);
}

TEST(IdleFeatures, OfACavityAreAllItsEdgesAndVertices) {
  const Counts idle = idleOf(test::turned(test::boxMesh(glm::dvec3(1.0))));
  EXPECT_EQ(idle.vertices, 8U);
  EXPECT_EQ(idle.edges, 18U);
}

TEST(IdleFeatures, AnOpenSurfaceHasNoneOnItsRim) {
  // Two triangles: the diagonal is flat; the rim and its vertices are kept as they have no side.
  const TriangleMesh square({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
  const Counts idle = idleOf(square);
  EXPECT_EQ(idle.vertices, 0U);
  EXPECT_EQ(idle.edges, 1U);
}

TEST(IdleFeatures, AReflexEdgeHasTheArcBetweenTheNormalsOfItsFaces) {
  MeshFeatures features = findFeatures(test::turned(test::boxMesh(glm::dvec3(1.0))));
  ASSERT_TRUE(features.edges.empty());
  addIdleFeatures(test::turned(test::boxMesh(glm::dvec3(1.0))), features);
  std::size_t reflex = 0;
  for (const EdgeFeature& f : features.edges) {
    // A right angle between two sides, none within one.
    const bool isFlat = f.cone.halfAngle < 1e-6;
    EXPECT_NEAR(f.cone.halfAngle, isFlat ? 0.0 : 0.25 * std::numbers::pi, 1e-9);
    reflex += isFlat ? 0 : 1;
  }
  EXPECT_EQ(reflex, 12U);
  for (const VertexFeature& f : features.vertices) {
    const glm::dvec3 inward = -test::boxMesh(glm::dvec3(1.0)).vertices()[f.vertex];
    EXPECT_GT(glm::dot(f.cone.axis, inward), 0.0);
    // The normal of one of its sides, which points into the cavity.
    const glm::dvec3 normal(inward.x > 0.0 ? 1.0 : -1.0, 0.0, 0.0);
    EXPECT_LE(angleBetween(f.cone.axis, normal), f.cone.halfAngle + 1e-9);
  }
}

}  // namespace
}  // namespace nearfit::idle_features_test
