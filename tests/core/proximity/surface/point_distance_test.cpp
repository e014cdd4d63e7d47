#include "core/proximity/surface/point_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/allocation_hook.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/point_oracle.h"
#include "tests/support/random_values.h"

namespace nearfit::point_distance_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Body {
  explicit Body(const TriangleMesh& mesh) : tree(mesh), placed(tree, nullptr), distance(placed) {}

  NormalConeTree tree;
  PlacedMesh placed;
  PointDistance distance;
};

/// Points in and around a mesh, from far away to on its surface.
void expectBruteForceDistances(const TriangleMesh& mesh, unsigned seed, int points, double tolerance) {
  const Body body(mesh);
  test::RandomValues random(seed);
  const glm::dvec3 middle = mesh.bounds().centre();
  const double size = mesh.bounds().diagonal();
  std::uint32_t start = NearestPoint::kNone;
  for (int i = 0; i < points; ++i) {
    glm::dvec3 point = middle + random.vector(size * std::pow(10.0, random.in(-2.0, 1.0)));
    if (i % 3 == 0) {
      const Triangle& t = mesh.triangles()[static_cast<std::size_t>(
          random.in(0.0, static_cast<double>(mesh.triangles().size()) - 1e-9))];
      const double u = random.in(0.0, 1.0), v = random.in(0.0, 1.0 - u);
      point = mesh.vertices()[t[0]] + u * (mesh.vertices()[t[1]] - mesh.vertices()[t[0]]) +
              v * (mesh.vertices()[t[2]] - mesh.vertices()[t[0]]) +
              random.vector(size * std::pow(10.0, random.in(-9.0, -2.0)));
    }
    const double expected = test::distanceToMesh(mesh, point);
    const double slack = tolerance * (size + glm::length(point - middle));
    const NearestPoint found = body.distance.nearest(point, kInfinity, start);
    ASSERT_TRUE(found.isFound());
    EXPECT_NEAR(found.distance, expected, slack);
    EXPECT_NEAR(glm::distance(found.point, point), expected, slack);
    EXPECT_NEAR(test::distanceToMesh(mesh, found.point), 0.0, slack);
    // Bounds that just hold it and just do not.
    EXPECT_TRUE(body.distance.nearest(point, expected + slack + 1e-300).isFound());
    EXPECT_FALSE(body.distance.nearest(point, std::max(0.0, expected - slack)).isFound());
    start = found.triangle;
  }
}

TEST(PointDistance, IsThatOfBruteForce) {
  expectBruteForceDistances(test::starMesh(1, 1.0, 3, 0.4), 1, 400, 1e-14);
  expectBruteForceDistances(test::boxMesh({1.0, 0.2, 0.05}), 2, 400, 1e-14);
  expectBruteForceDistances(test::tubeMesh(0.4, 0.5, 1.0, 48), 3, 400, 1e-14);
  expectBruteForceDistances(test::looseTriangles(4, 500), 4, 400, 1e-14);
  expectBruteForceDistances(test::finsMesh(5, 9, 1.0), 5, 300, 1e-14);
  expectBruteForceDistances(test::squareMesh(1.0, 7), 6, 300, 1e-14);
}

TEST(PointDistance, DegenerateTrianglesCountAndHaveTheirDistance) {
  for (const double aspect : {1e3, 1e6, 1e9}) {
    expectBruteForceDistances(test::withSlivers(test::icosphereMesh(1.0, 1), aspect, 0.1), 7, 200, 1e-12);
    expectBruteForceDistances(test::withNeedles(test::icosphereMesh(1.0, 1), aspect, 0.1), 8, 200, 1e-12);
  }
  expectBruteForceDistances(test::withDuplicates(test::starMesh(3, 1.0, 1, 0.3)), 9, 200, 1e-14);
  expectBruteForceDistances(test::withFacesWithoutArea(test::starMesh(4, 1.0, 1, 0.3)), 10, 200, 1e-12);
  // Alone, without an area: a segment.
  const TriangleMesh segment({{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}}, {{0, 1, 2}});
  const NearestPoint found = Body(segment).distance.nearest({0.25, 3.0, 4.0}, kInfinity);
  EXPECT_DOUBLE_EQ(found.distance, 5.0);
  EXPECT_DOUBLE_EQ(found.point.x, 0.25);
}

TEST(PointDistance, SmallAndLargeMeshesFarFromTheOriginHaveTheirDistance) {
  const TriangleMesh star = test::starMesh(6, 1.0, 2, 0.4);
  expectBruteForceDistances(test::transformed(star, 1e-5), 11, 200, 1e-14);
  expectBruteForceDistances(test::transformed(star, 1e4), 12, 200, 1e-14);
  // Coordinates out there have steps of 2e-12.
  const RigidTransform away{{1, 0, 0, 0}, {1e4, -2e4, 1.5e4}};
  expectBruteForceDistances(test::transformed(star, 1.0, away), 13, 200, 1e-11);
}

TEST(PointDistance, AnyStartGivesTheSameDistance) {
  const TriangleMesh mesh = test::starMesh(7, 1.0, 2, 0.4);
  const Body body(mesh);
  test::RandomValues random(14);
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 point = random.vector(2.0);
    const double expected = body.distance.nearest(point, kInfinity).distance;
    for (std::uint32_t start = 0; start < mesh.triangles().size(); start += 17)
      EXPECT_NEAR(body.distance.nearest(point, kInfinity, start).distance, expected, 1e-14);
  }
}

TEST(PointDistance, NothingIsFoundInAnEmptyMeshOrWithoutReach) {
  const Body empty{TriangleMesh()}, box(test::boxMesh(glm::dvec3(1.0)));
  EXPECT_FALSE(empty.distance.nearest(glm::dvec3(0.0), kInfinity).isFound());
  EXPECT_FALSE(box.distance.nearest({2.0, 0.0, 0.0}, 1.5).isFound()) << "it is just as far as that";
  EXPECT_TRUE(box.distance.nearest({2.0, 0.0, 0.0}, std::nextafter(1.5, 2.0)).isFound());
  const double nan = std::nan("");
  EXPECT_FALSE(box.distance.nearest({nan, 0.0, 0.0}, 1.0).isFound());
}

TEST(PointDistance, AllocatesNothing) {
  const Body body(test::starMesh(8, 1.0, 3, 0.3));
  test::resetAllocationCount();
  test::startCountingAllocations();
  for (const double x : {0.0, 0.9, 1.5, 9.0})
    (void)body.distance.nearest({x, 0.1, 0.2}, kInfinity);
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
}

}  // namespace
}  // namespace nearfit::point_distance_test
