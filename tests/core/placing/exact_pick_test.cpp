#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/placing/feature_pick.h"
#include "core/placing/insert.h"
#include "core/placing/measure.h"
#include "core/placing/surface_pairs.h"
#include "tests/support/exact_solids.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::exact_pick_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kReach = 1e-4;  ///< [m]
constexpr std::uint32_t kSegments = 6;

RigidTransform somePose(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<> in(-1.0, 1.0);
  return {glm::angleAxis(kPi * in(random), glm::normalize(glm::dvec3{in(random), in(random), 1.0})),
          glm::dvec3{0.1 * in(random), 0.1 * in(random), 0.1 * in(random)}};
}

glm::dvec3 cornerOf(const TriangleMesh& mesh, std::uint32_t triangle, int corner) {
  return mesh.vertices()[mesh.triangles()[triangle][static_cast<std::size_t>(corner)]];
}

/// The middle of a triangle.
SurfaceHit middleOf(const TriangleMesh& mesh, std::uint32_t triangle) {
  return {triangle,
          (cornerOf(mesh, triangle, 0) + cornerOf(mesh, triangle, 1) + cornerOf(mesh, triangle, 2)) / 3.0};
}

/// A point of a triangle near the middle of its first side.
SurfaceHit besideFirstSide(const TriangleMesh& mesh, std::uint32_t triangle) {
  const glm::dvec3 side = 0.5 * (cornerOf(mesh, triangle, 0) + cornerOf(mesh, triangle, 1));
  const glm::dvec3 way = cornerOf(mesh, triangle, 2) - side;
  return {triangle, side + 0.3 * kReach * glm::normalize(way)};
}

std::optional<PickedFeature> pickAt(const test::ExactSolid& solid, const SurfaceHit& hit,
                                    FeatureFilter filter = FeatureFilter::Any) {
  return pickFeature(solid.mesh, hit, kReach, filter, &solid.surfaces);
}

void expectSame(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_NEAR(glm::distance(a, b), 0.0, 1e-12);
}

/// Either sense of an axis is right.
void expectAxis(const AlignFeature& feature, const RigidTransform& pose) {
  const glm::dvec3 axis = pose.applyToVector({0, 0, 1});
  EXPECT_NEAR(std::abs(glm::dot(feature.direction, axis)), 1.0, 1e-12);
  EXPECT_NEAR(glm::length(glm::cross(feature.direction, axis)), 0.0, 1e-12);
}

/// A cylinder of radius 10 mm from z = 0 to z = 40 mm, cut into six facets.
test::ExactSolid sixSided() {
  const glm::dvec2 profile[] = {{0.01, 0.0}, {0.01, 0.04}};
  const std::uint32_t faces[] = {0};
  return test::turnedSolid(profile, {test::cylinderAboutZ(0.01)}, faces, kSegments);
}

TEST(ExactPick, FacesThatOnlyTellColoursApartHideNoEdges) {
  const TriangleMesh box = test::boxMesh(glm::dvec3(1.0));
  SurfaceFaces coloured;
  coloured.faces.resize(1);
  coloured.faceOfTriangle.assign(box.triangles().size(), 0);
  std::size_t edges = 0;
  for (std::uint32_t t = 0; t < box.triangles().size(); ++t) {
    const SurfaceHit hit = besideFirstSide(box, t);
    const auto with = pickFeature(box, hit, kReach, FeatureFilter::Any, &coloured),
               without = pickFeature(box, hit, kReach);
    ASSERT_EQ(with.has_value(), without.has_value());
    if (!with) continue;
    EXPECT_EQ(with->feature.shape, without->feature.shape) << t;
    edges += with->feature.shape == FeatureShape::Axis ? 1 : 0;
  }
  EXPECT_GT(edges, 0U) << "sides are edges of the box";
}

TEST(ExactPick, SixFacetsOfACylinderGiveItsOwnAxisAndRadius) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const RigidTransform pose = somePose(seed);
    const test::ExactSolid solid = test::moved(sixSided(), pose);
    for (const std::uint32_t triangle : {0U, 5U, 11U}) {
      const auto picked = pickAt(solid, middleOf(solid.mesh, triangle));
      ASSERT_TRUE(picked);
      EXPECT_EQ(picked->feature.shape, FeatureShape::Axis);
      EXPECT_EQ(picked->feature.surface, SurfaceKind::Cylinder);
      EXPECT_TRUE(picked->feature.isExact);
      EXPECT_NEAR(picked->feature.radius, 0.01, 1e-12);
      expectAxis(picked->feature, pose);
      expectSame(picked->feature.point, pose.applyToPoint({0, 0, 0.02}));
      EXPECT_EQ(picked->triangles.size(), 2U * kSegments);
    }
  }
}

TEST(ExactPick, WithoutSurfacesSixFacetsAreFlatFaces) {
  const test::ExactSolid solid = sixSided();
  const SurfaceHit hit = middleOf(solid.mesh, 0);
  for (const auto& picked : {pickFeature(solid.mesh, hit, kReach),
                             pickFeature(solid.mesh, hit, kReach, FeatureFilter::Any, nullptr)}) {
    ASSERT_TRUE(picked);
    EXPECT_EQ(picked->feature.shape, FeatureShape::Plane);
    EXPECT_FALSE(picked->feature.isExact);
  }
  const SurfaceFaces none;
  EXPECT_EQ(pickFeature(solid.mesh, hit, kReach, FeatureFilter::Any, &none)->feature.shape,
            FeatureShape::Plane);
}

TEST(ExactPick, TwoHalvesOfACylinderArePickedAsOne) {
  test::ExactSolid solid = sixSided();
  // The second half as another file entry has it: its axis the other way, its point elsewhere, digits rounded.
  const auto half = static_cast<std::uint32_t>(solid.surfaces.faces.size());
  solid.surfaces.faces.push_back({SurfaceKind::Cylinder, {1e-11, 0.0, 0.7}, {0.0, 0.0, -1.0}, 0.01 + 1e-11});
  for (std::uint32_t t = kSegments; t < 2 * kSegments; ++t)
    solid.surfaces.faceOfTriangle[t] = half;
  const auto picked = pickAt(solid, middleOf(solid.mesh, 0));
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->triangles.size(), 2U * kSegments);
  // Half of it on a cylinder that is wider by a micrometre, or around a bore: two walls.
  for (const bool isHollow : {false, true}) {
    test::ExactSolid other = solid;
    other.surfaces.faces[half].radius = isHollow ? 0.01 : 0.010001;
    other.surfaces.faces[half].isHollow = isHollow;
    EXPECT_EQ(pickAt(other, middleOf(other.mesh, 0))->triangles.size(), 1U * kSegments);
  }
}

TEST(ExactPick, OneFacetOfACylinderIsEnough) {
  test::ExactSolid solid = sixSided();
  for (std::uint32_t t = 2; t < 2 * kSegments; ++t)
    solid.surfaces.faceOfTriangle[t] = static_cast<std::uint32_t>(solid.surfaces.faces.size());
  solid.surfaces.faces.push_back({});
  const auto picked = pickAt(solid, middleOf(solid.mesh, 0));
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->feature.shape, FeatureShape::Axis);
  EXPECT_NEAR(picked->feature.radius, 0.01, 1e-12);
  expectSame(picked->feature.point, {0, 0, 0.02});
  EXPECT_EQ(picked->triangles.size(), 2U);
  // The facets beside it are on a surface of unknown shape.
  const auto beside = pickAt(solid, middleOf(solid.mesh, 4));
  ASSERT_TRUE(beside);
  EXPECT_EQ(beside->feature.shape, FeatureShape::Plane);
  EXPECT_FALSE(beside->feature.isExact);
}

TEST(ExactPick, AConeHasItsHalfAngleAndTheRadiusHalfwayAlongItsWall) {
  const double angle = 0.2, low = 0.01, high = 0.01 + 0.03 * std::tan(angle);
  const glm::dvec2 profile[] = {{low, 0.0}, {high, 0.03}};
  const std::uint32_t faces[] = {0};
  const RigidTransform pose = somePose(5);
  const test::ExactSolid solid = test::moved(
      test::turnedSolid(profile, {test::coneAboutZ(-low / std::tan(angle), angle)}, faces, kSegments), pose);
  const auto picked = pickAt(solid, middleOf(solid.mesh, 3));
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->feature.shape, FeatureShape::Axis);
  EXPECT_NEAR(picked->feature.halfAngle, angle, 1e-12);
  EXPECT_NEAR(picked->feature.radius, 0.5 * (low + high), 1e-12);
  expectAxis(picked->feature, pose);
  expectSame(picked->feature.point, pose.applyToPoint({0, 0, 0.015}));
}

/// A ball with its poles cut off, about z = 0.
test::ExactSolid ball(double radius) {
  std::vector<glm::dvec2> profile;
  for (int i = -2; i <= 2; ++i)
    profile.emplace_back(radius * std::cos(0.5 * i), radius * std::sin(0.5 * i));
  const std::uint32_t faces[] = {0, 0, 0, 0};
  return test::turnedSolid(profile, {test::sphereAboutZ(0.0, radius)}, faces, kSegments);
}

TEST(ExactPick, ASphereGivesItsCentreAndRadius) {
  const RigidTransform pose = somePose(8);
  const test::ExactSolid solid = test::moved(ball(0.015), pose);
  for (const FeatureFilter filter : {FeatureFilter::Any, FeatureFilter::Points}) {
    const auto picked = pickAt(solid, middleOf(solid.mesh, 14), filter);
    ASSERT_TRUE(picked);
    EXPECT_EQ(picked->feature.shape, FeatureShape::Point);
    EXPECT_EQ(picked->feature.surface, SurfaceKind::Sphere);
    expectSame(picked->feature.point, pose.translation);
    EXPECT_NEAR(picked->feature.radius, 0.015, 1e-12);
    EXPECT_EQ(picked->triangles.size(), 8U * kSegments);
  }
  for (const FeatureFilter filter : {FeatureFilter::Axes, FeatureFilter::Rounds, FeatureFilter::Faces})
    EXPECT_FALSE(pickAt(solid, middleOf(solid.mesh, 14), filter));
}

/// A disc with a round rim: a torus of radius 20 mm whose tube is 5 mm wide.
test::ExactSolid roundRim() {
  std::vector<glm::dvec2> profile;
  for (int i = -2; i <= 2; ++i)
    profile.emplace_back(0.02 + 0.0025 * std::cos(0.5 * i), 0.0025 * std::sin(0.5 * i));
  const std::uint32_t faces[] = {0, 0, 0, 0};
  return test::turnedSolid(profile, {test::torusAboutZ(0.0, 0.02, 0.0025)}, faces, kSegments);
}

TEST(ExactPick, ATorusGivesItsCentreAxisAndRadii) {
  const RigidTransform pose = somePose(9);
  const test::ExactSolid solid = test::moved(roundRim(), pose);
  for (const FeatureFilter filter : {FeatureFilter::Any, FeatureFilter::Axes, FeatureFilter::Rounds}) {
    const auto picked = pickAt(solid, middleOf(solid.mesh, 14), filter);
    ASSERT_TRUE(picked);
    EXPECT_EQ(picked->feature.shape, FeatureShape::Circle);
    EXPECT_EQ(picked->feature.surface, SurfaceKind::Torus);
    EXPECT_NEAR(picked->feature.radius, 0.02, 1e-12);
    EXPECT_NEAR(picked->feature.minorRadius, 0.0025, 1e-12);
    expectSame(picked->feature.point, pose.translation);
    expectAxis(picked->feature, pose);
    EXPECT_EQ(insertFeature(solid.mesh, *picked).shape, FeatureShape::Axis);
  }
  EXPECT_FALSE(pickAt(solid, middleOf(solid.mesh, 14), FeatureFilter::Faces));
}

TEST(ExactPick, ARoundEdgeIsTheCircleInWhichItsSurfacesMeet) {
  const RigidTransform pose = somePose(11);
  const test::ExactSolid solid = test::moved(sixSided(), pose);
  for (const FeatureFilter filter : {FeatureFilter::Any, FeatureFilter::Axes, FeatureFilter::Rounds}) {
    const auto picked = pickAt(solid, besideFirstSide(solid.mesh, 2), filter);
    ASSERT_TRUE(picked);
    EXPECT_EQ(picked->feature.shape, FeatureShape::Circle);
    EXPECT_TRUE(picked->feature.isExact);
    EXPECT_NEAR(picked->feature.radius, 0.01, 1e-12);
    expectSame(picked->feature.point, pose.translation);
    expectAxis(picked->feature, pose);
    ASSERT_EQ(picked->vertices.size(), 1U + kSegments);
    EXPECT_EQ(picked->vertices.front(), picked->vertices.back());
    // The lower end is its seat.
    const AlignFeature inserted = insertFeature(solid.mesh, *picked);
    EXPECT_EQ(inserted.shape, FeatureShape::Circle);
    expectSame(inserted.direction, pose.applyToVector({0, 0, -1}));
  }
  const auto centre = pickAt(solid, besideFirstSide(solid.mesh, 2), FeatureFilter::Points);
  ASSERT_TRUE(centre);
  EXPECT_EQ(centre->feature.shape, FeatureShape::Point);
  expectSame(centre->feature.point, pose.translation);
}

TEST(ExactPick, TheCornersOfACoarseCircleAreNotCornersOfTheShape) {
  const test::ExactSolid solid = sixSided();
  const glm::dvec3 corner = cornerOf(solid.mesh, 0, 0);
  const SurfaceHit near{0, corner + 0.1 * kReach * glm::normalize(cornerOf(solid.mesh, 0, 1) - corner)};
  EXPECT_EQ(pickAt(solid, near)->feature.shape, FeatureShape::Circle);
  EXPECT_EQ(pickFeature(solid.mesh, near, kReach)->feature.shape, FeatureShape::Point);
}

TEST(ExactPick, SmoothAndBluntTransitionsAreEdgesToo) {
  // A pin: cylinder, a cone of 10 degrees, a rounding that runs smoothly into the flat end.
  const double angle = kPi / 18.0, grown = 0.02 * std::tan(angle);
  const double wide = 0.01 + grown;
  const ExactSurface cone = test::coneAboutZ(0.03 + wide / std::tan(angle), -angle);
  const glm::dvec2 profile[] = {{wide, 0.0}, {wide, 0.03}, {0.01, 0.05}};
  const std::uint32_t faces[] = {0, 1};
  const RigidTransform pose = somePose(13);
  const test::ExactSolid solid =
      test::moved(test::turnedSolid(profile, {test::cylinderAboutZ(wide), cone}, faces, 24), pose);
  const auto blunt = pickAt(solid, besideFirstSide(solid.mesh, 48));
  ASSERT_TRUE(blunt);
  EXPECT_EQ(blunt->feature.shape, FeatureShape::Circle);
  EXPECT_NEAR(blunt->feature.radius, wide, 1e-12);
  expectSame(blunt->feature.point, pose.applyToPoint({0, 0, 0.03}));
  EXPECT_EQ(pickFeature(solid.mesh, besideFirstSide(solid.mesh, 48), kReach)->feature.shape,
            FeatureShape::Axis);

  const double tube = 0.003;
  const glm::dvec2 rounded[] = {{0.01, 0.0}, {0.01, 0.02}, {0.01 - tube, 0.02 + tube}};
  const test::ExactSolid smooth = test::moved(
      test::turnedSolid(rounded, {test::cylinderAboutZ(0.01), test::torusAboutZ(0.02, 0.01 - tube, tube)},
                        faces, kSegments),
      pose);
  const auto fromCylinder = pickAt(smooth, besideFirstSide(smooth.mesh, 2 * kSegments));
  ASSERT_TRUE(fromCylinder);
  EXPECT_EQ(fromCylinder->feature.shape, FeatureShape::Circle);
  EXPECT_NEAR(fromCylinder->feature.radius, 0.01, 1e-12);
  expectSame(fromCylinder->feature.point, pose.applyToPoint({0, 0, 0.02}));
  const auto intoEnd = [&] {
    SurfaceHit hit = middleOf(smooth.mesh, 2 * kSegments + 1);
    const glm::dvec3 upper =
        0.5 * (cornerOf(smooth.mesh, hit.triangle, 1) + cornerOf(smooth.mesh, hit.triangle, 2));
    hit.point = upper + 0.3 * kReach * glm::normalize(hit.point - upper);
    return pickAt(smooth, hit);
  }();
  ASSERT_TRUE(intoEnd);
  EXPECT_EQ(intoEnd->feature.shape, FeatureShape::Circle);
  EXPECT_NEAR(intoEnd->feature.radius, 0.01 - tube, 1e-12);
  expectSame(intoEnd->feature.point, pose.applyToPoint({0, 0, 0.02 + tube}));
}

TEST(ExactPick, AFlatFaceLiesInItsPlaneAndItsEdgesInBoth) {
  TriangleMesh box = test::boxMesh({0.02, 0.04, 0.06});
  SurfaceFaces surfaces;
  for (std::uint32_t t = 0; t < box.triangles().size(); ++t) {
    const glm::dvec3 a = cornerOf(box, t, 0), b = cornerOf(box, t, 1), c = cornerOf(box, t, 2);
    surfaces.faceOfTriangle.push_back(t);
    surfaces.faces.push_back({SurfaceKind::Plane, a, glm::normalize(glm::cross(b - a, c - a))});
  }
  const test::ExactSolid solid{box, surfaces};
  for (std::uint32_t t = 0; t < box.triangles().size(); ++t) {
    const auto face = pickAt(solid, middleOf(box, t));
    ASSERT_TRUE(face);
    EXPECT_EQ(face->feature.shape, FeatureShape::Plane);
    EXPECT_TRUE(face->feature.isExact);
    EXPECT_EQ(face->triangles.size(), 2U) << "both triangles of the face are in one plane";
    EXPECT_EQ(face->feature.direction, surfaces.faces[t].direction);
    // Its middle is on the axis of the box along its normal.
    expectSame(face->feature.point,
               glm::dot(face->feature.point, face->feature.direction) * face->feature.direction);
    const glm::dvec3 corner = cornerOf(box, t, 0);
    const auto point = pickAt(solid, {t, corner + 0.1 * (middleOf(box, t).point - corner) * kReach / 0.02});
    EXPECT_EQ(point->feature.shape, FeatureShape::Point);
    expectSame(point->feature.point, corner);
  }
  const auto edge = [&] {
    for (std::uint32_t t = 0; t < box.triangles().size(); ++t) {
      const auto picked = pickAt(solid, besideFirstSide(box, t));
      if (picked && picked->feature.shape == FeatureShape::Axis) return picked;
    }
    return std::optional<PickedFeature>();
  }();
  ASSERT_TRUE(edge);
  EXPECT_TRUE(edge->feature.isExact);
  EXPECT_EQ(edge->feature.radius, 0.0);
  EXPECT_EQ(edge->vertices.size(), 2U);
  expectSame(edge->feature.point,
             0.5 * (box.vertices()[edge->vertices[0]] + box.vertices()[edge->vertices[1]]));
}

TEST(ExactPick, AMeasureEndsOnTheSurfaceNotOnAFacet) {
  const RigidTransform pose = somePose(21);
  const test::ExactSolid solid = test::moved(sixSided(), pose);
  const SurfaceHit hit = middleOf(solid.mesh, 4);
  const auto picked = pickAt(solid, hit);
  ASSERT_TRUE(picked);
  const glm::dvec3 inside = pose.inverse().applyToPoint(hit.point);
  ASSERT_LT(std::hypot(inside.x, inside.y), 0.0095);
  const MeasureEnd end = measureEnd(solid.mesh, *picked, hit.point, &solid.surfaces);
  const glm::dvec3 on = pose.inverse().applyToPoint(end.point);
  EXPECT_NEAR(std::hypot(on.x, on.y), 0.01, 1e-12);
  EXPECT_NEAR(on.z, inside.z, 1e-12);
  EXPECT_EQ(measureEnd(solid.mesh, *picked, hit.point).point, hit.point);
  // To a second pin 30 mm aside.
  const RigidTransform aside{glm::dquat(1, 0, 0, 0), pose.applyToVector({0.018, 0.024, 0.5})};
  const Measurement apart = measure(end, placed(end, aside));
  EXPECT_NEAR(apart.apart.value(), 0.03, 1e-12);
  EXPECT_NEAR(apart.angle.value(), 0.0, 1e-12);
}

/// A point of a surface by its own two parameters.
glm::dvec3 pointOf(const ExactSurface& surface, double u, double v) {
  const glm::dvec3 aside(std::cos(u), std::sin(u), 0.0), up(0.0, 0.0, 1.0);
  switch (surface.kind) {
    case SurfaceKind::Cylinder:
      return surface.point + surface.radius * aside + v * up;
    case SurfaceKind::Cone:
      return surface.point + std::abs(v) * (std::sin(surface.halfAngle) * aside +
                                            std::cos(surface.halfAngle) * surface.direction);
    case SurfaceKind::Sphere:
      return surface.point + surface.radius * (std::cos(v) * aside + std::sin(v) * up);
    case SurfaceKind::Torus:
      return surface.point + surface.radius * aside +
             surface.minorRadius * (std::cos(v) * aside + std::sin(v) * up);
    default:
      return surface.point + v * aside;
  }
}

std::vector<ExactSurface> surfacesAboutZ() {
  return {test::cylinderAboutZ(0.7),        test::coneAboutZ(-0.4, 0.5),
          test::coneAboutZ(1.1, -0.9),      test::sphereAboutZ(0.1, 0.9),
          test::sphereAboutZ(0.5, 0.8),     test::torusAboutZ(0.2, 0.8, 0.3),
          test::torusAboutZ(0.0, 0.6, 0.4), {SurfaceKind::Plane, {0.3, 0.2, 0.15}, {0.0, 0.0, 1.0}}};
}

TEST(SurfacePairs, ThePointNearestOnASurfaceIsTheOneBelow) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<> in(-1.0, 1.0);
  for (const ExactSurface& surface : surfacesAboutZ()) {
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 p(in(random), in(random), in(random));
      const glm::dvec3 found = nearestOnSurface(surface, p);
      double nearest = 10.0, offSurface = 0.0;
      for (int k = 0; k < 400; ++k) {
        const glm::dvec3 on = pointOf(surface, kPi * in(random), kPi * in(random));
        nearest = std::min(nearest, glm::distance(on, p));
        offSurface = std::max(offSurface, glm::distance(nearestOnSurface(surface, on), on));
      }
      EXPECT_LE(glm::distance(found, p), nearest + 1e-12);
      EXPECT_NEAR(offSurface, 0.0, 1e-12);
      EXPECT_NEAR(glm::distance(nearestOnSurface(surface, found), found), 0.0, 1e-9);
    }
  }
}

TEST(SurfacePairs, TheCircleBetweenTwoSurfacesLiesOnBoth) {
  const std::vector<ExactSurface> all = surfacesAboutZ();
  int circles = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (i == j) continue;
      const auto circle = circleBetween(all[i], all[j], {0.6, 0.1, 0.3}, 1e-9);
      if (!circle) continue;
      ++circles;
      EXPECT_NEAR(std::hypot(circle->centre.x, circle->centre.y), 0.0, 1e-12);
      for (int k = 0; k < 12; ++k) {
        const double angle = kPi * k / 6.0;
        const glm::dvec3 on =
            circle->centre + circle->radius * glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
        EXPECT_NEAR(glm::distance(nearestOnSurface(all[i], on), on), 0.0, 1e-12) << i << ' ' << j;
        EXPECT_NEAR(glm::distance(nearestOnSurface(all[j], on), on), 0.0, 1e-12) << i << ' ' << j;
      }
    }
  }
  EXPECT_GT(circles, 30);
}

TEST(SurfacePairs, SurfacesThatMeetInNoCircleHaveNone) {
  const ExactSurface cylinder = test::cylinderAboutZ(0.01);
  ExactSurface crossing = cylinder, aside = cylinder;
  crossing.direction = {1.0, 0.0, 0.0};
  aside.point = {0.001, 0.0, 0.0};
  const ExactSurface oblique{SurfaceKind::Plane, {}, glm::normalize(glm::dvec3(0.1, 0.0, 1.0))};
  for (const ExactSurface& other : {crossing, aside, oblique, ExactSurface{}, test::cylinderAboutZ(0.02)})
    EXPECT_FALSE(circleBetween(cylinder, other, {0.01, 0.0, 0.0}, 1e-9));
  const ExactSurface above{SurfaceKind::Plane, {0, 0, 0.021}, {0, 0, 1}};
  EXPECT_FALSE(circleBetween(test::sphereAboutZ(0.0, 0.02), above, {0.0, 0.0, 0.02}, 1e-9));
}

}  // namespace
}  // namespace nearfit::exact_pick_test
