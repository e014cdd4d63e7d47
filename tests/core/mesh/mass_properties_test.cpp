#include "core/mesh/mass_properties.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "tests/support/mesh_generators.h"

namespace nearfit::mass_properties_test {
namespace {

using std::numbers::pi;

/// @param tolerance  Relative to the largest entry expected.
void expectNear(const glm::dmat3& actual, const glm::dmat3& expected, double tolerance) {
  double scale = 0.0;
  for (int i = 0; i < 3; ++i)
    scale = std::max(scale, glm::length(expected[i]));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(actual[i][j], expected[i][j], tolerance * scale) << i << " " << j;
  }
}

glm::dmat3 diagonal(double x, double y, double z) {
  return {{x, 0, 0}, {0, y, 0}, {0, 0, z}};
}

/// Of a solid box of density 1.
glm::dmat3 boxInertia(const glm::dvec3& size) {
  const double m = size.x * size.y * size.z;
  const glm::dvec3 s = size * size;
  return m / 12.0 * diagonal(s.y + s.z, s.z + s.x, s.x + s.y);
}

const RigidTransform kMotion{glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, -2, 3))), {0.3, -0.2, 0.5}};

TEST(MassProperties, BoxIsThatOfTheTextbook) {
  const MassProperties mass = massProperties(test::boxMesh({1, 2, 3}, {4, 5, 6}));
  EXPECT_EQ(mass.basis, MassBasis::VolumeIntegrals);
  EXPECT_NEAR(mass.volume, 6.0, 1e-14);
  EXPECT_NEAR(glm::distance(mass.centre, {4, 5, 6}), 0.0, 1e-14);
  expectNear(mass.inertia, boxInertia({1, 2, 3}), 1e-14);
}

TEST(MassProperties, TurnedBoxHasTurnedInertia) {
  const MassProperties mass = massProperties(test::transformed(test::boxMesh({1, 2, 3}), 0.1, kMotion));
  const glm::dmat3 r = glm::mat3_cast(kMotion.rotation);
  EXPECT_NEAR(glm::distance(mass.centre, kMotion.translation), 0.0, 1e-15);
  expectNear(mass.inertia, r * boxInertia({0.1, 0.2, 0.3}) * glm::transpose(r), 1e-13);
}

TEST(MassProperties, RegularTetrahedronIsThatOfTheTextbook) {
  const double edge = std::sqrt(8.0 / 3.0);  // Inscribed in the unit sphere.
  const double volume = edge * edge * edge / (6.0 * std::sqrt(2.0));
  const MassProperties mass = massProperties(test::tetrahedronMesh(1.0));
  EXPECT_NEAR(mass.volume, volume, 1e-15);
  EXPECT_NEAR(glm::length(mass.centre), 0.0, 1e-15);
  expectNear(mass.inertia, glm::dmat3(volume * edge * edge / 20.0), 1e-14);
}

TEST(MassProperties, FineSphereComesNearTheRoundOne) {
  const double r = 0.02;
  const MassProperties mass = massProperties(test::icosphereMesh(r, 6));
  const double volume = 4.0 / 3.0 * pi * r * r * r;
  EXPECT_NEAR(mass.volume / volume, 1.0, 1e-3);
  expectNear(mass.inertia, glm::dmat3(0.4 * volume * r * r), 2e-3);
}

TEST(MassProperties, FineTorusComesNearTheRoundOne) {
  const double major = 2.0, minor = 0.5;
  const double volume = 2.0 * pi * pi * major * minor * minor;
  const MassProperties mass = massProperties(test::torusMesh(major, minor, 400, 200));
  EXPECT_NEAR(mass.volume / volume, 1.0, 1e-3);
  const double across = volume * (4.0 * major * major + 5.0 * minor * minor) / 8.0;
  const double along = volume * (4.0 * major * major + 3.0 * minor * minor) / 4.0;
  expectNear(mass.inertia, diagonal(across, across, along), 1e-3);
}

TEST(MassProperties, CavityIsTakenOff) {
  const TriangleMesh hollow = test::joined(test::boxMesh({2, 2, 2}), test::turned(test::boxMesh({1, 1, 1})));
  const MassProperties mass = massProperties(hollow);
  EXPECT_NEAR(mass.volume, 7.0, 1e-14);
  expectNear(mass.inertia, boxInertia({2, 2, 2}) - boxInertia({1, 1, 1}), 1e-14);
}

TEST(MassProperties, FarFromTheOriginNoDigitIsLostThatTheCoordinatesHave) {
  // Coordinates at 1e6 are spaced by 1e-10; so much may the shape change, and no more.
  const TriangleMesh near = test::boxMesh({0.1, 0.2, 0.3});
  const MassProperties mass = massProperties(test::transformed(near, 1.0, {{1, 0, 0, 0}, {1e6, -1e6, 1e6}}));
  EXPECT_EQ(mass.basis, MassBasis::VolumeIntegrals);
  EXPECT_NEAR(mass.volume, 0.006, 0.006 * 1e-8);
  EXPECT_NEAR(glm::distance(mass.centre, {1e6, -1e6, 1e6}), 0.0, 3e-10);
  expectNear(mass.inertia, boxInertia({0.1, 0.2, 0.3}), 1e-8);
}

TEST(MassProperties, TinyAndHugeBoxesScaleExactly) {
  for (const double scale : {1e-6, 1e6}) {
    const MassProperties mass = massProperties(test::transformed(test::boxMesh({1, 2, 3}), scale));
    EXPECT_EQ(mass.basis, MassBasis::VolumeIntegrals);
    EXPECT_NEAR(mass.volume / std::pow(scale, 3), 6.0, 1e-13);
    expectNear(mass.inertia / std::pow(scale, 5), boxInertia({1, 2, 3}), 1e-13);
  }
}

/// A box without the two triangles of its top.
TriangleMesh openBox(const glm::dvec3& size) {
  const TriangleMesh box = test::boxMesh(size);
  std::vector<Triangle> triangles;
  for (const Triangle& t : box.triangles()) {
    const bool isTop =
        box.vertices()[t[0]].z + box.vertices()[t[1]].z + box.vertices()[t[2]].z > 1.4 * size.z;
    if (!isTop) triangles.push_back(t);
  }
  return {{box.vertices().begin(), box.vertices().end()}, triangles};
}

TEST(MassProperties, OpenBoxIsStoodInForByTheWholeBoxHoweverItLies) {
  ASSERT_EQ(openBox({1, 2, 3}).triangles().size(), 10U);
  const MassProperties mass = massProperties(test::transformed(openBox({1, 2, 3}), 1.0, kMotion));
  const glm::dmat3 r = glm::mat3_cast(kMotion.rotation);
  EXPECT_EQ(mass.basis, MassBasis::OrientedBox);
  EXPECT_NEAR(mass.volume, 6.0, 1e-12);
  EXPECT_NEAR(glm::distance(mass.centre, kMotion.translation), 0.0, 1e-12);
  expectNear(mass.inertia, r * boxInertia({1, 2, 3}) * glm::transpose(r), 1e-12);
}

TEST(MassProperties, OpenCubeIsStoodInForByTheCubeThoughItsPrincipalAxesAreAnywhere) {
  const MassProperties mass = massProperties(test::transformed(openBox({1, 1, 1}), 1.0, kMotion));
  EXPECT_NEAR(mass.volume, 1.0, 1e-12);
}

TEST(MassProperties, FlatSheetAndSingleTriangleHaveInertia) {
  const TriangleMesh triangle({{0, 0, 0}, {4, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  for (const TriangleMesh& mesh : {test::squareMesh(2.0, 4), test::transformed(triangle, 0.5, kMotion)}) {
    const MassProperties mass = massProperties(mesh);
    EXPECT_EQ(mass.basis, MassBasis::OrientedBox);
    EXPECT_GT(mass.volume, 0.0);
    EXPECT_GT(glm::determinant(mass.inertia), 0.0);
    for (const glm::dvec3 axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0.6, 0, 0.8)}) {
      EXPECT_GT(glm::dot(axis, mass.inertia * axis), 0.0);
    }
  }
}

TEST(MassProperties, SquareSheetIsPaddedToAThousandthOfItsLength) {
  const MassProperties mass = massProperties(test::squareMesh(2.0, 4));
  EXPECT_NEAR(mass.volume, 2.0 * 2.0 * 2e-3, 1e-15);
  expectNear(mass.inertia, boxInertia({2, 2, 2e-3}), 1e-12);
}

TEST(MassProperties, ClosedSheetWithoutVolumeIsStoodInForByItsBox) {
  const TriangleMesh sheet = test::squareMesh(1.0, 1);
  std::vector<Triangle> both(sheet.triangles().begin(), sheet.triangles().end());
  for (const Triangle& t : sheet.triangles())
    both.push_back({t[0], t[2], t[1]});
  const TriangleMesh closed({sheet.vertices().begin(), sheet.vertices().end()}, {both[0], both[2]});
  ASSERT_TRUE(closed.topology().isClosed());
  EXPECT_EQ(massProperties(closed).basis, MassBasis::OrientedBox);
}

TEST(MassProperties, ThinWireIsStillASolid) {
  const MassProperties mass = massProperties(test::cylinderMesh(1e-5, 1.0, 64));
  EXPECT_EQ(mass.basis, MassBasis::VolumeIntegrals);
  EXPECT_NEAR(mass.volume / (pi * 1e-10), 1.0, 2e-3);
}

TEST(MassProperties, MeshWithoutTrianglesHasNone) {
  EXPECT_EQ(massProperties(TriangleMesh()).volume, 0.0);
}

TEST(MassProperties, BasesHaveTheNamesOfTheReports) {
  EXPECT_STREQ(nameOf(MassBasis::VolumeIntegrals), "volume integrals");
  EXPECT_STREQ(nameOf(MassBasis::OrientedBox), "oriented box");
}

}  // namespace
}  // namespace nearfit::mass_properties_test
