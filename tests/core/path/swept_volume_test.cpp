#include "core/path/swept_volume.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/import/mesh_import.h"
#include "core/mesh/mass_properties.h"
#include "tests/exact/exact_meeting.h"
#include "tests/support/path_scenes.h"
#include "tests/support/random_values.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::swept_volume_test {
namespace {

/// Distance of a point from the outside of a box that fills |x| <= half.x and so on [m].
double distanceToBox(const glm::dvec3& p, const glm::dvec3& half) {
  return glm::length(glm::max(glm::abs(p) - half, glm::dvec3(0.0)));
}

TEST(SweptVolume, OfAStraightMotionHoldsTheLongBoxAndIsWithinTheResolutionOfIt) {
  test::PathScene made;
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({0.2, 0.3, 0.4})), "Cube"));
  made.path = test::pathThrough("Cube", {test::at(-0.5, 0, 0), test::at(0.5, 0, 0)});
  const glm::dvec3 half(0.6, 0.15, 0.2);
  for (const double resolution : {0.1, 0.04}) {
    const TriangleMesh mesh = sweptVolume(made.scene, made.path, resolution);
    EXPECT_TRUE(mesh.topology().isClosed());
    EXPECT_TRUE(mesh.topology().isOriented());
    for (const glm::dvec3& vertex : mesh.vertices()) {
      const double beyond = distanceToBox(vertex, half);
      ASSERT_GT(beyond, 0.0) << "the box is inside";
      ASSERT_LE(beyond, resolution);
    }
    const double volume = massProperties(mesh).volume;
    EXPECT_GT(volume, 8.0 * half.x * half.y * half.z);
    EXPECT_LT(volume, 8.0 * (half.x + resolution) * (half.y + resolution) * (half.z + resolution));
  }
}

TEST(SweptVolume, OfATurningBarHoldsItBetweenPosesToo) {
  const double radius = 0.5, resolution = 0.05;
  const test::PathScene made = test::barInRing(radius);
  const TriangleMesh mesh = sweptVolume(made.scene, made.path, resolution);
  EXPECT_TRUE(mesh.topology().isClosed());
  EXPECT_TRUE(mesh.topology().isOriented());
  // The bar sweeps a disc of that radius, 0.4 m high.
  for (const glm::dvec3& v : mesh.vertices()) {
    const double aside = std::max(0.0, std::hypot(v.x, v.y) - radius),
                 above = std::max(0.0, std::abs(v.z) - 0.2);
    ASSERT_GT(std::hypot(aside, above), 0.0);
    ASSERT_LE(std::hypot(aside, above), resolution);
  }
  test::RandomValues random(3);
  const TriangleMesh& bar = made.part("Bar").geometry->mesh;
  for (int i = 0; i < 20; ++i) {
    const RigidTransform pose = poseAt(made.path, random.in(0.0, made.path.end()));
    for (const glm::dvec3& corner : bar.vertices())
      EXPECT_NEAR(test::windingNumber(mesh, pose.applyToPoint(corner)), 1.0, 1e-6);
  }
}

TEST(SweptVolume, WhatCannotBeReachedIsFilledAndWhatCanIsNot) {
  // A ring that rests: its bore is open, the material within its wall is not.
  test::PathScene made;
  made.scene.add(test::partOf(test::geometryOf(test::tubeMesh(0.5, 0.8, 0.4, 32)), "Ring"));
  made.path = test::pathThrough("Ring", {test::at(0, 0, 0), test::at(0, 0, 0)});
  const TriangleMesh mesh = sweptVolume(made.scene, made.path, 0.06);
  EXPECT_NEAR(test::windingNumber(mesh, {0.0, 0.0, 0.0}), 0.0, 1e-6);
  EXPECT_NEAR(test::windingNumber(mesh, {0.65, 0.0, 0.0}), 1.0, 1e-6);
  EXPECT_EQ(mesh.topology().components, 1U) << "no walls inside";
}

TEST(SweptVolume, AllMovingPartsCount) {
  test::PathScene made = test::cubePastCube(0.5);
  made.scene.add(
      test::partOf(test::geometryOf(test::boxMesh({0.5, 0.5, 0.5})), "Second", test::at(-3.0, 4.5, 0.0)));
  made.path.parts = {"Cube", "Second"};
  const TriangleMesh mesh = sweptVolume(made.scene, made.path, 0.3);
  EXPECT_EQ(mesh.topology().components, 2U);
  EXPECT_NEAR(test::windingNumber(mesh, {0.0, 4.5, 0.0}), 1.0, 1e-6);
  EXPECT_NEAR(test::windingNumber(mesh, {0.0, 1.5, 0.0}), 1.0, 1e-6);
  EXPECT_NEAR(test::windingNumber(mesh, {0.0, 0.0, 0.0}), 0.0, 1e-6) << "the post does not move";
}

TEST(SweptVolume, IsWrittenInTheFormatOfTheSuffixAndInTheUnit) {
  test::PathScene made;
  made.scene.add(test::partOf(test::geometryOf(test::boxMesh({0.2, 0.3, 0.4})), "Cube"));
  made.path = test::pathThrough("Cube", {test::at(-0.5, 0, 0), test::at(0.5, 0, 0)});
  const test::TemporaryFolder folder;
  const std::size_t triangles = sweptVolume(made.scene, made.path, 0.1).triangles().size();
  for (const char* name : {"swept.stl", "swept.OBJ", "swept.ply"}) {
    const auto file = folder.path() / name;
    EXPECT_EQ(writeSweptVolume(made.scene, made.path, 0.1, 1e-3, file), triangles);
    // Around the box that it passes, 1.2 m x 0.3 m x 0.4 m, in millimetres; STL has single precision.
    const TriangleMesh read = importMesh(file, {.metresPerUnit = 1.0}).mesh;
    EXPECT_EQ(read.triangles().size(), triangles) << name;
    const glm::dvec3 size = read.bounds().upper - read.bounds().lower;
    EXPECT_GE(size.x, 1200.0 - 1e-3) << name;
    EXPECT_LE(size.x, 1400.0 + 1e-3) << name;
    EXPECT_GE(size.y, 300.0 - 1e-3) << name;
    EXPECT_LE(size.y, 500.0 + 1e-3) << name;
  }
  EXPECT_THROW(writeSweptVolume(made.scene, made.path, 0.1, 1e-3, folder.path() / "swept.step"), UsageError);
}

TEST(SweptVolume, ResolutionsThatCannotBeMadeAreRefused) {
  const test::PathScene made = test::cubePastCube(0.5);
  for (const double resolution : {0.0, -1.0, 1e-6, std::nan(""), static_cast<double>(INFINITY)})
    EXPECT_THROW(sweptVolume(made.scene, made.path, resolution), UsageError) << resolution;
  EXPECT_THROW(sweptVolume(made.scene, made.path, 0.2, [](double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace nearfit::swept_volume_test
