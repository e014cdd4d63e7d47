// Exact surfaces and tessellation of a block with a bore, its countersink, a dimple and a ring, whose sizes are those
// that make_models.py gives them.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/app/import/import_fixture.h"

namespace nearfit::import_surfaces_test {
namespace {

using test::imported;
using test::importModel;

constexpr double kMm = 1e-3;
/// Of what a STEP file says of a surface: it holds sixteen digits.
constexpr double kExact = 1e-12;

const CadShape& bracket() {
  static const CadDocument document = imported(importModel("bracket.step"));
  return document.shapes.at(0);
}

std::vector<ExactSurface> surfacesOf(SurfaceKind kind) {
  std::vector<ExactSurface> found;
  std::ranges::copy_if(bracket().surfaces.faces, std::back_inserter(found),
                       [&](const ExactSurface& s) { return s.kind == kind; });
  return found;
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LE(glm::distance(a, b), kExact) << a.x << " " << a.y << " " << a.z;
}

TEST(ImportSurfaces, ABoreIsACylinderWithItsAxisAndRadius) {
  const std::vector<ExactSurface> cylinders = surfacesOf(SurfaceKind::Cylinder);
  ASSERT_EQ(cylinders.size(), 1U);
  const ExactSurface& bore = cylinders[0];
  EXPECT_NEAR(bore.radius, 4 * kMm, kExact);
  EXPECT_NEAR(std::abs(bore.direction.z), 1.0, kExact);
  EXPECT_NEAR(bore.point.x, 15 * kMm, kExact);
  EXPECT_NEAR(bore.point.y, 0.0, kExact);
  EXPECT_TRUE(bore.isHollow);
}

TEST(ImportSurfaces, ACountersinkIsAConeThatOpensUpwards) {
  const std::vector<ExactSurface> cones = surfacesOf(SurfaceKind::Cone);
  ASSERT_EQ(cones.size(), 1U);
  // From radius 4 at z 14 to 11 at 21: its tip is at z 10.
  expectNear(cones[0].point, glm::dvec3(15, 0, 10) * kMm);
  expectNear(cones[0].direction, {0, 0, 1});
  EXPECT_NEAR(cones[0].halfAngle, std::numbers::pi / 4, kExact);
  EXPECT_TRUE(cones[0].isHollow);
}

TEST(ImportSurfaces, ADimpleIsASphere) {
  const std::vector<ExactSurface> spheres = surfacesOf(SurfaceKind::Sphere);
  ASSERT_EQ(spheres.size(), 1U);
  expectNear(spheres[0].point, glm::dvec3(-18, 0, 20) * kMm);
  EXPECT_NEAR(spheres[0].radius, 6 * kMm, kExact);
  EXPECT_TRUE(spheres[0].isHollow);
}

TEST(ImportSurfaces, ARingIsATorusOfMaterial) {
  const std::vector<ExactSurface> tori = surfacesOf(SurfaceKind::Torus);
  ASSERT_EQ(tori.size(), 1U);
  expectNear(tori[0].point, glm::dvec3(-10, 0, 0) * kMm);
  EXPECT_NEAR(std::abs(tori[0].direction.z), 1.0, kExact);
  EXPECT_NEAR(tori[0].radius, 8 * kMm, kExact);
  EXPECT_NEAR(tori[0].minorRadius, 2 * kMm, kExact);
  EXPECT_FALSE(tori[0].isHollow);
}

TEST(ImportSurfaces, PlanesLookOutward) {
  const std::vector<ExactSurface> planes = surfacesOf(SurfaceKind::Plane);
  // Six sides; the bottom one is in two pieces, within the ring and around it.
  ASSERT_EQ(planes.size(), 7U);
  const glm::dvec3 middle = glm::dvec3(0, 0, 10) * kMm;
  for (const ExactSurface& plane : planes)
    EXPECT_GT(glm::dot(plane.direction, plane.point - middle), 0.0);
}

double distanceTo(const ExactSurface& s, const glm::dvec3& p) {
  const glm::dvec3 d = p - s.point;
  const double along = glm::dot(d, s.direction), across = glm::length(d - along * s.direction);
  switch (s.kind) {
    case SurfaceKind::Plane:
      return std::abs(along);
    case SurfaceKind::Cylinder:
      return std::abs(across - s.radius);
    case SurfaceKind::Cone:
      return std::abs(across * std::cos(s.halfAngle) - along * std::sin(s.halfAngle));
    case SurfaceKind::Sphere:
      return std::abs(glm::length(d) - s.radius);
    case SurfaceKind::Torus:
      return std::abs(std::hypot(across - s.radius, along) - s.minorRadius);
    case SurfaceKind::Other:
      break;
  }
  return 0.0;
}

TEST(ImportSurfaces, TrianglesLieOnTheSurfaceThatTheyAreSaidToStandFor) {
  const CadShape& shape = bracket();
  for (std::size_t i = 0; i < shape.triangles.size(); ++i) {
    const ExactSurface& surface = shape.surfaces.faces[shape.surfaces.faceOfTriangle[i]];
    glm::dvec3 centre(0.0);
    for (const std::uint32_t v : shape.triangles[i]) {
      // Corners on edges are as exact as the edges of the file.
      EXPECT_LE(distanceTo(surface, shape.vertices[v]), 1e-9) << i;
      centre += shape.vertices[v] / 3.0;
    }
    EXPECT_LE(distanceTo(surface, centre), shape.tessellation.chord * 1.001) << i;
  }
}

TEST(ImportSurfaces, TheVolumeIsThatOfTheSolid) {
  constexpr double kPi = std::numbers::pi;
  const double volume = 48000 - kPi * 16 * 14 - kPi * 2 * (100 + 40 + 16) - kPi * 144 + kPi * kPi * 32;
  EXPECT_NEAR(bracket().exactVolume, volume * 1e-9, 1e-6 * volume * 1e-9);
}

TEST(ImportSurfaces, TheDefaultChordFollowsTheSizeOfTheShape) {
  // The diagonal of its box, which OpenCASCADE computes somewhat too large.
  const double diagonal = glm::length(glm::dvec3(60, 40, 22)) * kMm;
  EXPECT_TRUE(bracket().isExact);
  EXPECT_GE(bracket().tessellation.chord, 0.999 * diagonal / 2000);
  EXPECT_LE(bracket().tessellation.chord, 1.2 * diagonal / 2000);
  EXPECT_NEAR(bracket().tessellation.angle, 12 * std::numbers::pi / 180, 1e-12);
}

TEST(ImportSurfaces, FinerTriangulationsAreMoreAndNearerAndClosed) {
  const std::string file = importModel("bracket.step").string();
  const CadShape coarse = imported(file, {{1e-4, 0.5}, {}}).shapes.at(0);
  const CadShape fine = imported(file, {{5e-6, 0.05}, {}}).shapes.at(0);
  EXPECT_EQ(coarse.tessellation, (Tessellation{1e-4, 0.5}));
  EXPECT_GT(fine.triangles.size(), 4 * coarse.triangles.size());
  for (const CadShape* shape : {&coarse, &fine}) {
    EXPECT_EQ(test::unmatchedEdges(*shape), 0U);
    EXPECT_EQ(shape->key, bracket().key);
    EXPECT_NEAR(test::volumeOf(*shape), shape->exactVolume, test::areaOf(*shape) * shape->tessellation.chord);
  }
  EXPECT_LT(std::abs(test::volumeOf(fine) - fine.exactVolume),
            std::abs(test::volumeOf(coarse) - coarse.exactVolume));
}

TEST(ImportSurfaces, OneShapeOfAnAssemblyComesAloneWithItsInstances) {
  const std::string file = importModel("assembly_inch.step").string();
  const CadDocument document = imported(file, {{}, {"Bolzen"}});
  ASSERT_EQ(document.shapes.size(), 1U);
  EXPECT_EQ(document.shapes[0].key, "Bolzen");
  // The top, two carriers, and two bolts in each.
  EXPECT_EQ(document.nodes.size(), 7U);
}

TEST(ImportSurfaces, AShapeThatTheFileNoLongerHoldsIsSaid) {
  try {
    imported(importModel("bracket.step"), {{}, {"nut"}});
    ADD_FAILURE() << "was imported";
  } catch (const FileError& error) {
    EXPECT_NE(error.problem().find("does not hold the shapes"), std::string::npos);
  }
}

TEST(ImportSurfaces, ATessellationThatIsNoNumberIsRefused) {
  EXPECT_THROW(imported(importModel("bracket.step"), {{-1.0, 0.0}, {}}), UsageError);
  EXPECT_THROW(imported(importModel("bracket.step"), {{0.0, std::nan("")}, {}}), UsageError);
}

}  // namespace
}  // namespace nearfit::import_surfaces_test
