#include "core/mesh/ray_tree.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/random_values.h"

namespace nearfit::ray_tree_test {
namespace {

struct Expected {
  double fraction = std::numeric_limits<double>::infinity();
  std::uint32_t triangle = 0;
};

/// Source: T. Moeller and B. Trumbore, Fast, minimum storage ray-triangle intersection, 1997.
Expected byAllTriangles(const TriangleMesh& mesh, const glm::dvec3& from, const glm::dvec3& to) {
  Expected first;
  const glm::dvec3 along = to - from;
  for (std::uint32_t i = 0; i < mesh.triangles().size(); ++i) {
    const Triangle& t = mesh.triangles()[i];
    const glm::dvec3 a = mesh.vertices()[t[0]], b = mesh.vertices()[t[1]] - a, c = mesh.vertices()[t[2]] - a;
    const glm::dvec3 p = glm::cross(along, c), q = glm::cross(from - a, b);
    const double scale = glm::dot(b, p);
    const double u = glm::dot(from - a, p) / scale, v = glm::dot(along, q) / scale;
    const double fraction = glm::dot(c, q) / scale;
    const bool isMet = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && fraction >= 0.0 && fraction <= 1.0;
    if (isMet && fraction < first.fraction) first = {fraction, i};
  }
  return first;
}

void expectAsByAllTriangles(const TriangleMesh& mesh, unsigned seed) {
  const RayTree rays(mesh);
  test::RandomValues random(seed);
  const double size = mesh.bounds().diagonal();
  int met = 0;
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 from = mesh.bounds().centre() + random.vector(size);
    const glm::dvec3 to = mesh.bounds().centre() + random.vector(0.5 * size);
    const Expected expected = byAllTriangles(mesh, from, to);
    const std::optional<RayHit> hit = rays.firstHit(from, to);
    ASSERT_EQ(hit.has_value(), expected.fraction <= 1.0);
    if (!hit) continue;
    ++met;
    EXPECT_EQ(hit->triangle, expected.triangle);
    EXPECT_NEAR(hit->fraction, expected.fraction, 1e-9);
    EXPECT_LT(glm::distance(hit->point, from + expected.fraction * (to - from)), 1e-9 * size);
  }
  EXPECT_GT(met, 50);
}

TEST(RayTree, TheFirstTriangleOnARayIsFound) {
  expectAsByAllTriangles(test::torusMesh(2.0, 0.5, 40, 24), 1);
  expectAsByAllTriangles(test::starMesh(3, 1.0, 3, 0.4), 2);
  expectAsByAllTriangles(test::looseTriangles(4, 300), 3);
  expectAsByAllTriangles(test::cylinderMesh(1.0, 1e-3, 200), 4);
}

TEST(RayTree, NoRaySlipsBetweenNeighbours) {
  const TriangleMesh mesh = test::transformed(test::icosphereMesh(1.0, 3), 1e-4, {{1, 0, 0, 0}, {3, -7, 11}});
  const RayTree rays(mesh);
  const glm::dvec3 middle(3, -7, 11);
  for (const MeshEdge& e : mesh.edges()) {
    const glm::dvec3 a = mesh.vertices()[e.v0], b = mesh.vertices()[e.v1];
    for (const glm::dvec3& aim : {a, b, 0.5 * (a + b), 0.3 * a + 0.7 * b}) {
      const auto hit = rays.firstHit(middle + 3.0 * (aim - middle), middle);
      ASSERT_TRUE(hit);
      EXPECT_LT(glm::distance(hit->point, aim), 1e-6);
    }
  }
}

TEST(RayTree, BothSidesAreSeenAndNothingBeyondTheEnds) {
  const RayTree rays(test::squareMesh(2.0, 4));
  for (const double side : {1.0, -1.0}) {
    const auto hit = rays.firstHit({0.3, 0.2, side}, {0.3, 0.2, -side});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->fraction, 0.5);
    EXPECT_FALSE(rays.firstHit({0.3, 0.2, side}, {0.3, 0.2, 0.5 * side}));
  }
  EXPECT_FALSE(rays.firstHit({-5, 0.2, 0}, {5, 0.2, 0})) << "in its plane";
  EXPECT_FALSE(rays.firstHit({1.1, 0, 1}, {1.1, 0, -1}));
}

TEST(RayTree, NothingIsMetWithoutTrianglesOrByARayThatIsNone) {
  EXPECT_FALSE(RayTree().firstHit({0, 0, 1}, {0, 0, -1}));
  EXPECT_FALSE(RayTree(TriangleMesh()).firstHit({0, 0, 1}, {0, 0, -1}));
  const RayTree rays(test::boxMesh({1, 1, 1}));
  EXPECT_FALSE(rays.firstHit({NAN, 0, 1}, {0, 0, -1}));
  EXPECT_FALSE(rays.firstHit({0, 0, 1}, {0, 0, INFINITY}));
  EXPECT_FALSE(rays.firstHit({0, 0, 0.1}, {0, 0, 0.1})) << "of no length";
}

// A grid of cells took gigabytes for these: the slivers were in thousands of cells each, and its tolerance of a
// millimetre put each triangle of a small mesh into all of them.
TEST(RayTree, MemoryDependsOnTheNumberOfTrianglesAlone) {
  const auto isBounded = [](const TriangleMesh& mesh) {
    return RayTree(mesh).byteSize() <= RayTree::kMaxBytesPerTriangle * mesh.triangles().size();
  };
  EXPECT_TRUE(isBounded(test::cylinderMesh(1.0, 1000.0, 50'000)));
  EXPECT_TRUE(isBounded(test::jaggedFan(5, 200'000, 1e-3)));
  EXPECT_TRUE(isBounded(test::looseTriangles(6, 100'000)));
  EXPECT_TRUE(isBounded(test::finsMesh(7, 100'000, 6.0)));
  const double tiny = 1.0 / 8192.0;  // A power of two, so that all roundings are the same.
  EXPECT_EQ(RayTree(test::icosphereMesh(1.0, 6)).byteSize(),
            RayTree(test::icosphereMesh(tiny, 6)).byteSize());
}

}  // namespace
}  // namespace nearfit::ray_tree_test
