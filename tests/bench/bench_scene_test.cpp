#include "tests/bench/bench_scene.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/bench/bench_shapes.h"

namespace nearfit::bench::bench_scene_test {
namespace {

double signedVolume(const TriangleMesh& mesh) {
  double six = 0.0;
  for (const Triangle& t : mesh.triangles()) {
    const auto p = mesh.vertices();
    six += glm::dot(p[t[0]], glm::cross(p[t[1]], p[t[2]]));
  }
  return six / 6.0;
}

void expectSolid(const TriangleMesh& mesh, std::size_t triangles, std::uint32_t components) {
  EXPECT_EQ(mesh.triangles().size(), triangles);
  EXPECT_TRUE(mesh.topology().isClosed());
  EXPECT_TRUE(mesh.topology().isOriented());
  EXPECT_EQ(mesh.topology().components, components);
  EXPECT_GT(signedVolume(mesh), 0.0);
}

TEST(BenchShapes, AreClosedOrientedOutwardAndOfTheCountsTheySay) {
  expectSolid(gearMesh(25), 6300, 1);
  expectSolid(springMesh(980, 12), 23544, 1);
  expectSolid(teapotMesh(), 5632, 3);
  expectSolid(crankshaftMesh(63), 12852, 1);
  expectSolid(organicMesh(59, 1), 69620, 1);
}

TEST(BenchShapes, GearHasItsBore) {
  double least = 10.0, greatest = 0.0;
  const TriangleMesh gear = gearMesh(25);
  for (const glm::dvec3& p : gear.vertices()) {
    least = std::min(least, std::hypot(p.x, p.y));
    greatest = std::max(greatest, std::hypot(p.x, p.y));
  }
  EXPECT_NEAR(least, kGearBoreRadius, 1e-12);
  EXPECT_NEAR(greatest, 2.0, 1e-12);
}

TEST(BenchShapes, SameSeedGivesTheSameBody) {
  const TriangleMesh a = organicMesh(10, 5), b = organicMesh(10, 5), c = organicMesh(10, 6);
  EXPECT_TRUE(std::equal(a.vertices().begin(), a.vertices().end(), b.vertices().begin()));
  EXPECT_FALSE(std::equal(a.vertices().begin(), a.vertices().end(), c.vertices().begin()));
}

TEST(BenchScenes, LargerBodyHasUnitDiagonal) {
  for (const SceneEntry& entry : generatedScenes()) {
    if (entry.name == "organic-1m") continue;
    EXPECT_NEAR(entry.make().size(), 1.0, 1e-12) << entry.name;
  }
}

}  // namespace
}  // namespace nearfit::bench::bench_scene_test
