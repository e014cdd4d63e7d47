#include "tests/support/idle_features.h"

#include <numbers>
#include <random>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/trial_share.h"

namespace nearfit::idle_features_test {
namespace {

struct Counts {
  std::size_t vertices, edges;
};

/// How many are added.
Counts idleOf(const TriangleMesh& mesh) {
  MeshFeatures features = findFeatures(mesh);
  const Counts before{features.vertices.size(), features.edges.size()};
  test::addIdleFeatures(mesh, features);
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
  test::addIdleFeatures(test::turned(test::boxMesh(glm::dvec3(1.0))), features);
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

/// Each minimum, feature by feature, to the last bit.
void expectSame(std::span<const Lmd> a, std::span<const Lmd> b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].distance, b[i].distance);
    EXPECT_EQ(a[i].scenePoint, b[i].scenePoint);
    EXPECT_EQ(a[i].partPoint, b[i].partPoint);
    EXPECT_EQ(a[i].sceneFeature, b[i].sceneFeature);
    EXPECT_EQ(a[i].sceneIndex, b[i].sceneIndex);
    EXPECT_EQ(a[i].isRegion, b[i].isRegion);
  }
}

TEST(IdleFeatures, ChangeNoAnswer) {
  const test::BodyPair pairs[] = {
      {"bore", test::tubeMesh(0.5, 1.0, 0.4, 16), test::cylinderMesh(0.4, 0.6, 12)},
      {"boxes", test::subdivided(test::boxMesh({1.0, 2.0, 3.0}), 2),
       test::subdivided(test::boxMesh(glm::dvec3(0.5)), 2)},
      {"stars", test::starMesh(1, 1.0, 2, 0.3), test::starMesh(2, 1.0, 2, 0.3)},
  };
  std::mt19937_64 random(5);
  LmdScratch scratch;
  std::vector<Lmd> out(LmdScratch::kDefaultCapacity);
  for (const test::BodyPair& pair : pairs) {
    const NormalConeTree scene(pair.scene), part(pair.part);
    const test::FullHierarchy fullScene(pair.scene), fullPart(pair.part);
    EXPECT_GT(fullScene.tree().keptFeatures().total(), scene.keptFeatures().total()) << pair.name;
    std::size_t minima = 0;
    for (std::size_t i = 0; i < 200 / test::kTrialShare; ++i) {
      const RigidTransform pose = test::poseNearContact(pair, 0.2, random);
      const std::vector<Lmd> expected = test::allLmds(scene, part, pose, 0.2);
      const LmdResult result = test::findLmds(fullScene, fullPart, pose, 0.2, scratch, out);
      EXPECT_EQ(result.status, QueryStatus::Complete);
      expectSame(std::span<const Lmd>(out).first(result.count), expected);
      minima += expected.size();
    }
    EXPECT_GT(minima, 20U / test::kTrialShare) << pair.name;
  }
}

std::uint32_t leafOf(FeatureKind kind, std::uint32_t index) {
  return NormalConeTree::kLeafBit | static_cast<std::uint32_t>(kind) << 29 | index;
}

TEST(IdleFeatures, AreKnownByTheirPlace) {
  const test::FullHierarchy full(test::boxMesh(glm::dvec3(1.0)));
  const NormalConeTree& box = full.tree();
  ASSERT_EQ(box.edges().size(), 18U);
  std::size_t idle = 0;
  for (std::uint32_t i = 0; i < 18; ++i) {
    const NormalConeTree::EdgeLeaf& edge = box.edges()[i];
    // The sides of the cube are as long as it is, the diagonals are not.
    const bool isDiagonal = glm::distance(box.positions()[edge.v0], box.positions()[edge.v1]) > 1.2;
    EXPECT_EQ(full.isIdle(leafOf(FeatureKind::Edge, i)), isDiagonal);
    idle += isDiagonal ? 1 : 0;
  }
  EXPECT_EQ(idle, 6U);
  EXPECT_FALSE(full.isIdle(leafOf(FeatureKind::Vertex, 7)));
  EXPECT_FALSE(full.isIdle(leafOf(FeatureKind::Face, 11)));
}

}  // namespace
}  // namespace nearfit::idle_features_test
