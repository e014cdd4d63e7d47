#include "core/haptics/mass_metric.h"

#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::mass_metric_test {
namespace {

MassMetric metricOf(const TriangleMesh& mesh) {
  return massMetric(massProperties(mesh), mesh);
}

void expectSafe(const MassMetric& metric) {
  EXPECT_GT(metric.radius, 0.0);
  EXPECT_TRUE(std::isfinite(metric.radius));
  EXPECT_NEAR(glm::length(metric.partFromPrincipal), 1.0, 1e-12);
  for (int i = 0; i < 3; ++i) {
    EXPECT_GE(metric.gyration[i], kMinGyration * metric.radius);
    EXPECT_LE(metric.gyration[i], metric.radius);
  }
}

/// Sorted radii of gyration of a solid box.
glm::dvec3 boxGyration(const glm::dvec3& size) {
  const glm::dvec3 s = size * size;
  return glm::sqrt(glm::dvec3(s.x + s.y, s.x + s.z, s.y + s.z) / 12.0);  // For size.x < size.y < size.z.
}

TEST(MassMetric, BoxHasTheGyrationOfTheTextbookAndTheRadiusOfItsCorners) {
  const glm::dvec3 size(0.1, 0.2, 0.3);
  const MassMetric metric = metricOf(test::boxMesh(size, {4, 5, 6}));
  EXPECT_NEAR(glm::distance(metric.gyration, boxGyration(size)), 0.0, 1e-14);
  EXPECT_NEAR(metric.radius, 0.5 * glm::length(size), 1e-14);
}

TEST(MassMetric, PrincipalAxesOfATurnedBoxAreItsOwn) {
  const glm::dvec3 size(0.1, 0.2, 0.3);
  const RigidTransform motion{glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, -2, 3))), {0.3, -0.2, 0.5}};
  const MassMetric metric = metricOf(test::transformed(test::boxMesh(size), 1.0, motion));
  EXPECT_NEAR(glm::distance(metric.gyration, boxGyration(size)), 0.0, 1e-14);
  // Least inertia is about the longest side (z), most about the shortest (x).
  const glm::dvec3 least = metric.partFromPrincipal * glm::dvec3(1, 0, 0);
  const glm::dvec3 most = metric.partFromPrincipal * glm::dvec3(0, 0, 1);
  EXPECT_NEAR(std::abs(glm::dot(least, motion.rotation * glm::dvec3(0, 0, 1))), 1.0, 1e-12);
  EXPECT_NEAR(std::abs(glm::dot(most, motion.rotation * glm::dvec3(1, 0, 0))), 1.0, 1e-12);
}

TEST(MassMetric, SphereHasItsGyrationAboutEveryAxis) {
  const MassMetric metric = metricOf(test::icosphereMesh(0.02, 4));
  // k = r sqrt(2/5); the polyhedron lies within the sphere, by 1e-3 of the radius at most.
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(metric.gyration[i], 0.02 * std::sqrt(0.4), 4e-5);
  EXPECT_NEAR(metric.radius, 0.02, 1e-14);
}

TEST(MassMetric, NeedleAndPlateKeepAGyrationThatIsWorthItsName) {
  const MassMetric needle = metricOf(test::boxMesh({1e-6, 1e-6, 1.0}));
  expectSafe(needle);
  EXPECT_DOUBLE_EQ(needle.gyration.x, kMinGyration * needle.radius);
  EXPECT_NEAR(needle.gyration.z, 1.0 / std::sqrt(12.0), 1e-9);
  expectSafe(metricOf(test::boxMesh({1e-6, 1.0, 1.0})));
}

TEST(MassMetric, BodiesWithoutVolumeGetASafeMetric) {
  expectSafe(metricOf(test::squareMesh(0.1, 4)));
  expectSafe(metricOf(TriangleMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}})));
  expectSafe(metricOf(TriangleMesh({{0, 0, 0}, {1e-9, 0, 0}, {0.5, 1e-12, 0}}, {{0, 1, 2}})));
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    expectSafe(metricOf(test::jaggedFan(seed, 9, 0.2)));
    expectSafe(metricOf(test::looseTriangles(seed, 5)));
  }
}

TEST(MassMetric, BodyThatIsPartlyInsideOutGetsASafeMetric) {
  // Its sum has a positive volume and, along x, a negative second moment: no body has that.
  const TriangleMesh wrong = test::turned(test::boxMesh({0.5, 0.5, 0.5}, {10.0, 0.0, 0.0}));
  expectSafe(metricOf(test::joined(test::boxMesh({1, 1, 1}), wrong)));
}

TEST(MassMetric, TinyAndLargeBodiesAreScaledCopies) {
  const MassMetric unit = metricOf(test::boxMesh({1, 2, 3}));
  for (const double scale : {1e-6, 1e6}) {
    const MassMetric scaled = metricOf(test::transformed(test::boxMesh({1, 2, 3}), scale));
    EXPECT_NEAR(glm::distance(scaled.gyration / scale, unit.gyration), 0.0, 1e-12);
    EXPECT_NEAR(scaled.radius / scale, unit.radius, 1e-12);
  }
}

TEST(MassMetric, UnusedVerticesDoNotCount) {
  const TriangleMesh box = test::boxMesh({1, 1, 1});
  std::vector<glm::dvec3> vertices(box.vertices().begin(), box.vertices().end());
  vertices.emplace_back(100, 0, 0);
  const TriangleMesh mesh(vertices, {box.triangles().begin(), box.triangles().end()});
  EXPECT_NEAR(massMetric(massProperties(box), mesh).radius, 0.5 * std::sqrt(3.0), 1e-15);
}

TEST(MassMetric, EmptyMeshHasNoRadiusAndStillAMetric) {
  const MassMetric metric = massMetric({}, TriangleMesh());
  EXPECT_EQ(metric.radius, 0.0);
  EXPECT_EQ(metric.gyration, glm::dvec3(1.0));
}

}  // namespace
}  // namespace nearfit::mass_metric_test
