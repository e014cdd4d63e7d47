#include "core/proximity/query/segment_passage.h"

#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/mesh/triangle_mesh.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::segment_passage_test {
namespace {

constexpr double kClearance = 1e-9;

bool isClosedBy(const TriangleMesh& mesh, const glm::dvec3& from, const glm::dvec3& to) {
  const double length = glm::distance(from, to);
  SegmentPassage passage(from, (to - from) / length, kClearance, length - kClearance, kClearance);
  const auto x = mesh.vertices();
  for (const Triangle& t : mesh.triangles())
    passage.add(x[t[0]], x[t[1]], x[t[2]]);
  return passage.isClosed();
}

glm::dvec3 between(const glm::dvec3& a, const glm::dvec3& b, double share) {
  return (1.0 - share) * a + share * b;
}

TEST(SegmentPassage, NoWayOutLeadsThroughAVertexAnEdgeOrAFaceOfAClosedSurface) {
  const TriangleMesh star = test::starMesh(5, 1.0, 3, 0.4);
  const auto x = star.vertices();
  const glm::dvec3 inside(0.01, -0.02, 0.03);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto expectClosed = [&](const glm::dvec3& through) {
    EXPECT_TRUE(isClosedBy(star, inside, inside + 3.0 * (through - inside)));
    EXPECT_TRUE(isClosedBy(star, inside + 3.0 * (through - inside), inside));
  };
  for (const glm::dvec3& v : x)
    expectClosed(v);
  for (const MeshEdge& e : star.edges())
    expectClosed(between(x[e.v0], x[e.v1], share(random)));
  for (const Triangle& t : star.triangles())
    expectClosed(between(between(x[t[0]], x[t[1]], share(random)), x[t[2]], share(random)));
}

TEST(SegmentPassage, LinesAlongTheAxesFindNoGapInAlignedMeshes) {
  // Every quantity that is compared is a round number: ties everywhere.
  const TriangleMesh square = test::squareMesh(2.0, 8);
  for (int i = -7; i <= 7; ++i) {
    for (int j = -7; j <= 7; ++j) {
      const glm::dvec3 at(0.125 * i, 0.125 * j, 0.0);
      EXPECT_TRUE(isClosedBy(square, at + glm::dvec3(0, 0, 1), at - glm::dvec3(0, 0, 1)));
      EXPECT_TRUE(isClosedBy(square, at + glm::dvec3(0.25, 0.5, 1), at - glm::dvec3(0.25, 0.5, 1)));
    }
  }
}

TEST(SegmentPassage, SurfaceThatHoldsAnEndDoesNotCloseIt) {
  const TriangleMesh box = test::boxMesh({2, 2, 2});
  EXPECT_FALSE(isClosedBy(box, {0, 0, 1}, {0, 0, 2}));          // From the middle of a face: its diagonal.
  EXPECT_FALSE(isClosedBy(box, {0.3, 0.2, 2}, {0.3, 0.2, 1}));  // To a face.
  EXPECT_FALSE(isClosedBy(box, {1, 0.2, 1}, {1.5, 0.2, 1.5}));  // From an edge.
  EXPECT_FALSE(isClosedBy(box, {1, 0.2, 1}, {1, 0.2, 2}));      // From an edge, in the plane of a face.
  EXPECT_FALSE(isClosedBy(box, {1, 1, 1}, {2, 2, 2}));
  EXPECT_TRUE(isClosedBy(box, {0, 0, 1}, {0, 0, -2}));  // Into the box: out of the bottom.
  EXPECT_FALSE(isClosedBy(box, {0, 0, 1}, {0, 0, -1}));
}

TEST(SegmentPassage, WhatIsGrazedDoesNotCloseIt) {
  const TriangleMesh box = test::boxMesh({2, 2, 2});
  EXPECT_FALSE(isClosedBy(box, {1, 0.2, 3}, {1, 0.2, -3}));  // Along a face.
  EXPECT_FALSE(isClosedBy(box, {1, 1, 3}, {1, 1, -3}));      // Along an edge.
  EXPECT_FALSE(isClosedBy(box, {2, 0.2, 0}, {0, 0.2, 2}));   // Across an edge, outside.
  EXPECT_FALSE(isClosedBy(box, {3, 1, -1}, {-1, 1, 3}));     // Past a corner, in the plane of a face.
  EXPECT_TRUE(isClosedBy(box, {0.999999, 0.2, 3}, {0.999999, 0.2, -3}));
  EXPECT_FALSE(isClosedBy(box, {1.000001, 0.2, 3}, {1.000001, 0.2, -3}));
}

TEST(SegmentPassage, TwoSurfacesThatLeaveNoGapCloseItTogether) {
  const TriangleMesh walls =
      test::joined(test::boxMesh({1, 1, 1}, {0.5, 0, 0}), test::boxMesh({1, 1, 1}, {-0.5, 0, 0}));
  EXPECT_TRUE(isClosedBy(walls, {0, 0.1, 2}, {0, 0.1, -2}));
  const TriangleMesh apart =
      test::joined(test::boxMesh({1, 1, 1}, {0.500001, 0, 0}), test::boxMesh({1, 1, 1}, {-0.5, 0, 0}));
  EXPECT_FALSE(isClosedBy(apart, {0, 0.1, 2}, {0, 0.1, -2}));
}

}  // namespace
}  // namespace nearfit::segment_passage_test
