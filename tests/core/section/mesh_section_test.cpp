#include "core/section/mesh_section.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/random_values.h"

namespace nearfit::mesh_section_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// Of the cap, along the normal [m^2]: triangles of the other sense count against it.
double areaOf(const MeshSection& section, const glm::dvec3& normal) {
  glm::dvec3 area(0.0);
  for (const Triangle& t : section.cap) {
    area += 0.5 * glm::cross(section.capPoints[t[1]] - section.capPoints[t[0]],
                             section.capPoints[t[2]] - section.capPoints[t[0]]);
  }
  return glm::dot(area, normal);
}

/// What is left of a triangle behind a plane, its doubled area as a vector.
glm::dvec3 areaBehind(const std::array<glm::dvec3, 3>& t, const CutPlane& plane) {
  std::vector<glm::dvec3> kept;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 a = t[k], b = t[(k + 1) % 3];
    const double from = plane.heightOf(a), to = plane.heightOf(b);
    if (from <= 0.0) kept.push_back(a);
    if ((from <= 0.0) != (to <= 0.0)) kept.push_back(a + from / (from - to) * (b - a));
  }
  glm::dvec3 area(0.0);
  for (std::size_t k = 2; k < kept.size(); ++k)
    area += glm::cross(kept[k - 1] - kept[0], kept[k] - kept[0]);
  return 0.5 * area;
}

/// A closed surface has no area as a vector: the cap's is what the rest of the surface lacks.
double areaWanted(const TriangleMesh& mesh, const CutPlane& plane) {
  glm::dvec3 area(0.0);
  const auto vertices = mesh.vertices();
  for (const Triangle& t : mesh.triangles())
    area += areaBehind({vertices[t[0]], vertices[t[1]], vertices[t[2]]}, plane);
  return -glm::dot(area, plane.normal);
}

CutPlane through(const glm::dvec3& point, const glm::dvec3& normal) {
  const glm::dvec3 unit = glm::normalize(normal);
  return {unit, glm::dot(unit, point)};
}

TEST(MeshSection, ACubeIsCutInASquare) {
  const TriangleMesh box = test::boxMesh({2.0, 3.0, 4.0});
  for (const double height : {-1.9, 0.0, 1.7}) {
    const MeshSection section = sectionOf(box, {{0, 0, 1}, height});
    EXPECT_TRUE(section.isCapped);
    EXPECT_NEAR(areaOf(section, {0, 0, 1}), 6.0, 1e-12);
    for (const glm::dvec3& p : section.capPoints)
      EXPECT_NEAR(p.z, height, 1e-15);
  }
  // Seen against the normal, whichever way that looks.
  EXPECT_NEAR(areaOf(sectionOf(box, {{0, 0, -1}, 0.5}), {0, 0, -1}), 6.0, 1e-12);
  EXPECT_NEAR(areaOf(sectionOf(box, through({}, {1, 1, 0})), glm::normalize(glm::dvec3(1, 1, 0))),
              4.0 * 2.0 * std::sqrt(2.0), 1e-12);
}

TEST(MeshSection, APlaneThatMissesCutsNothing) {
  const MeshSection section = sectionOf(test::boxMesh(glm::dvec3(1.0)), {{0, 0, 1}, 0.6});
  EXPECT_TRUE(section.outline.empty());
  EXPECT_TRUE(section.cap.empty());
}

TEST(MeshSection, ABoreStaysOpen) {
  const std::uint32_t segments = 64;
  const double corners = 0.5 * segments * std::sin(2.0 * kPi / segments);
  const MeshSection section = sectionOf(test::tubeMesh(0.5, 1.0, 2.0, segments), {{0, 0, 1}, 0.1});
  EXPECT_NEAR(areaOf(section, {0, 0, 1}), corners * 0.75, 1e-12);
  // Along the axis: two rectangles.
  EXPECT_NEAR(areaOf(sectionOf(test::tubeMesh(0.5, 1.0, 2.0, segments), {{0, 1, 0}, 0.0}), {0, 1, 0}), 2.0,
              1e-9);
}

TEST(MeshSection, PiecesThatOverlapAreFilledOnceAndACavityIsNot) {
  const TriangleMesh overlapping =
      test::joined(test::boxMesh(glm::dvec3(2.0)), test::boxMesh(glm::dvec3(2.0), glm::dvec3(1.0, 1.0, 0.0)));
  EXPECT_NEAR(areaOf(sectionOf(overlapping, {{0, 0, 1}, 0.0}), {0, 0, 1}), 7.0, 1e-12);
  // Side by side with a face in common.
  const TriangleMesh touching =
      test::joined(test::boxMesh(glm::dvec3(2.0)), test::boxMesh(glm::dvec3(2.0), glm::dvec3(2.0, 0.0, 0.0)));
  EXPECT_NEAR(areaOf(sectionOf(touching, {{0, 0, 1}, 0.3}), {0, 0, 1}), 8.0, 1e-12);
  const TriangleMesh hollow =
      test::joined(test::boxMesh(glm::dvec3(2.0)), test::turned(test::boxMesh(glm::dvec3(1.0))));
  EXPECT_NEAR(areaOf(sectionOf(hollow, {{0, 0, 1}, 0.2}), {0, 0, 1}), 3.0, 1e-12);
}

TEST(MeshSection, APlaneThroughCornersEdgesAndFacesStillClosesTheCurves) {
  const TriangleMesh box = test::subdivided(test::boxMesh(glm::dvec3(2.0)), 2);
  for (const double height : {-1.0, -0.5, 0.0, 0.5}) {
    const CutPlane plane{{0, 0, 1}, height};
    EXPECT_NEAR(areaOf(sectionOf(box, plane), plane.normal), 4.0, 1e-12) << height;
  }
  // What lies in the plane is not cut away: the top is there itself.
  EXPECT_TRUE(sectionOf(box, {{0, 0, 1}, 1.0}).cap.empty());
  EXPECT_NEAR(areaOf(sectionOf(box, through({}, {1, 1, 1})), glm::normalize(glm::dvec3(1.0))),
              areaWanted(box, through({}, {1, 1, 1})), 1e-12);
}

TEST(MeshSection, AFaceThatIsPlacedInThePlaneIsNotCutInShreds) {
  test::RandomValues random(23);
  const TriangleMesh box = test::subdivided(test::boxMesh({0.02, 0.03, 0.04}), 3);
  const CutPlane top{{0, 0, 1}, 0.02};
  for (int i = 0; i < 200; ++i) {
    const RigidTransform worldFromPart = random.pose();
    // To the world and back, as a view does it: the numbers are no longer the corners'.
    const CutPlane plane = placed(placed(top, worldFromPart), worldFromPart.inverse());
    EXPECT_TRUE(sectionOf(box, plane).cap.empty()) << i;
    // Of the other side the face is all that is left: it is closed as a whole, or missed as a whole.
    const CutPlane flipped{-plane.normal, -plane.offset};
    const double area = areaOf(sectionOf(box, flipped), flipped.normal);
    EXPECT_TRUE(area == 0.0 || std::abs(area - 0.02 * 0.03) < 1e-12) << i << ": " << area;
  }
}

TEST(MeshSection, ABallIsCutInTheDiscThatGeometryTells) {
  test::RandomValues random(7);
  const double radius = 0.8;
  const TriangleMesh ball = test::icosphereMesh(radius, 6);
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 normal = glm::normalize(random.vector(1.0));
    const double height = random.in(-0.95, 0.95) * radius;
    const double disc = kPi * (radius * radius - height * height);
    // Chords of a fine mesh lie inside the ball by some thousandths of a radius at most.
    EXPECT_NEAR(areaOf(sectionOf(ball, {normal, height}), normal), disc, 2e-3 * radius * radius);
  }
}

TEST(MeshSection, ATorusIsCutInARingOrInTwoDiscs) {
  const double major = 1.0, minor = 0.3;
  const std::uint32_t around = 256, across = 128;
  const TriangleMesh torus = test::torusMesh(major, minor, around, across);
  const auto areaAcross = [&](const glm::dvec3& normal, double offset) {
    return areaOf(sectionOf(torus, {normal, offset}), normal);
  };
  // About one of the axes, whichever the generator takes.
  const double ring = 4.0 * kPi * major * minor, discs = 2.0 * kPi * minor * minor;
  std::array areas{areaAcross({1, 0, 0}, 0.0), areaAcross({0, 1, 0}, 0.0), areaAcross({0, 0, 1}, 0.0)};
  std::ranges::sort(areas);
  EXPECT_NEAR(areas[0], discs, 1e-3 * discs);
  EXPECT_NEAR(areas[1], discs, 1e-3 * discs);
  EXPECT_NEAR(areas[2], ring, 1e-3 * ring);
}

TEST(MeshSection, ShellsInShellsAreFilledByTurns) {
  TriangleMesh nested = test::boxMesh(glm::dvec3(4.0));
  nested = test::joined(nested, test::turned(test::boxMesh(glm::dvec3(3.0))));
  nested = test::joined(nested, test::boxMesh(glm::dvec3(2.0)));
  nested = test::joined(nested, test::turned(test::boxMesh(glm::dvec3(1.0))));
  EXPECT_NEAR(areaOf(sectionOf(nested, {{0, 0, 1}, 0.1}), {0, 0, 1}), 16.0 - 9.0 + 4.0 - 1.0, 1e-12);
  EXPECT_NEAR(areaOf(sectionOf(nested, {{0, 0, 1}, 0.7}), {0, 0, 1}), 16.0 - 9.0 + 4.0, 1e-12);
  EXPECT_NEAR(areaOf(sectionOf(nested, {{0, 0, 1}, 1.7}), {0, 0, 1}), 16.0, 1e-12);
}

TEST(MeshSection, PointsAreOnTheCapWhereTheMaterialIs) {
  test::RandomValues random(31);
  const MeshSection section = sectionOf(test::tubeMesh(0.5, 1.0, 2.0, 128), {{0, 0, 1}, 0.1});
  int on = 0;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 point(random.in(-1.2, 1.2), random.in(-1.2, 1.2), 0.1);
    const double radius = std::hypot(point.x, point.y);
    // Between a chord and its arc it is the mesh that counts.
    if (std::abs(radius - 0.5) < 1e-3 || std::abs(radius - 1.0) < 1e-3) continue;
    const bool isInWall = radius > 0.5 && radius < 1.0;
    on += isInWall ? 1 : 0;
    EXPECT_EQ(isOnCap(section, {0, 0, 1}, point), isInWall);
  }
  EXPECT_GT(on, 500);
  EXPECT_FALSE(isOnCap({}, {0, 0, 1}, glm::dvec3(0.0)));
}

TEST(MeshSection, FillsWhatTheSurfaceLacksWhereverItIsCut) {
  test::RandomValues random(11);
  const TriangleMesh meshes[] = {test::torusMesh(1.0, 0.3, 40, 24), test::starMesh(3, 1.0, 3, 0.3),
                                 test::bowlMesh(0.7, 1.0, 32, 12), test::icosphereMesh(1.0, 3)};
  for (const TriangleMesh& mesh : meshes) {
    for (int i = 0; i < 60; ++i) {
      const CutPlane plane = through(random.vector(0.5), random.vector(1.0));
      const MeshSection section = sectionOf(mesh, plane);
      EXPECT_NEAR(areaOf(section, plane.normal), areaWanted(mesh, plane), 1e-9);
      for (const glm::dvec3& p : section.capPoints)
        EXPECT_NEAR(plane.heightOf(p), 0.0, 1e-12);
    }
  }
}

TEST(MeshSection, SliversAndNeedlesDoNoHarm) {
  test::RandomValues random(5);
  const TriangleMesh ball = test::icosphereMesh(0.5, 2);
  for (const TriangleMesh& mesh : {test::withSlivers(ball, 1e9, 0.0), test::withNeedles(ball, 1e9, 0.0)}) {
    for (int i = 0; i < 40; ++i) {
      const CutPlane plane = through(random.vector(0.2), random.vector(1.0));
      EXPECT_NEAR(areaOf(sectionOf(mesh, plane), plane.normal), areaWanted(mesh, plane), 1e-9);
    }
  }
}

TEST(MeshSection, TheMaterialLiesOnTheLeftOfTheOutline) {
  const MeshSection section = sectionOf(test::cylinderMesh(1.0, 2.0, 24), {{0, 0, 1}, 0.2});
  ASSERT_EQ(section.outline.size(), 48U);
  for (const auto& [from, to] : section.outline) {
    const glm::dvec3 a = section.points[from], b = section.points[to];
    EXPECT_GT(glm::cross(b - a, -a).z, -1e-12);
  }
}

TEST(MeshSection, AnOpenMeshHasAnOutlineWithoutACap) {
  const TriangleMesh square = test::squareMesh(2.0, 4);
  const MeshSection section = sectionOf(square, {{1, 0, 0}, 0.1});
  EXPECT_FALSE(section.isCapped);
  EXPECT_FALSE(section.outline.empty());
  EXPECT_TRUE(section.cap.empty());
}

TEST(MeshSection, WhatWouldTakeTooLongToFillHasAnOutlineAlone) {
  const MeshSection section = sectionOf(test::cylinderMesh(1.0, 2.0, 13'000), {{0, 0, 1}, 0.2});
  EXPECT_EQ(section.outline.size(), 26'000U);
  EXPECT_FALSE(section.isCapped);
  EXPECT_TRUE(section.cap.empty());
}

TEST(MeshSection, WithoutACommonSenseTheCapGoesByParity) {
  // Every second triangle turned round, the surface is closed still.
  const TriangleMesh box = test::subdivided(test::boxMesh(glm::dvec3(2.0)), 1);
  std::vector<Triangle> triangles(box.triangles().begin(), box.triangles().end());
  for (std::size_t i = 0; i < triangles.size(); i += 2)
    std::swap(triangles[i][0], triangles[i][1]);
  const TriangleMesh mixed({box.vertices().begin(), box.vertices().end()}, std::move(triangles));
  ASSERT_FALSE(mixed.topology().isOriented());
  EXPECT_NEAR(areaOf(sectionOf(mixed, {{0, 0, 1}, 0.3}), {0, 0, 1}), 4.0, 1e-12);
}

TEST(CutPlane, GoesWithItsFrame) {
  test::RandomValues random(3);
  for (int i = 0; i < 20; ++i) {
    const RigidTransform pose{glm::angleAxis(random.in(-3.0, 3.0), glm::normalize(random.vector(1.0))),
                              random.vector(2.0)};
    const CutPlane plane = through(random.vector(1.0), random.vector(1.0));
    const glm::dvec3 point = random.vector(1.0);
    EXPECT_NEAR(placed(plane, pose).heightOf(pose.applyToPoint(point)), plane.heightOf(point), 1e-12);
    const auto [right, up] = axesOf(plane);
    EXPECT_LT(glm::distance(glm::cross(right, up), plane.normal), 1e-12);
    EXPECT_NEAR(glm::length(right), 1.0, 1e-12);
  }
}

TEST(CutPlane, ABoxReachesAsFarAsItsFarthestCorners) {
  Aabb box;
  box.add({-1, 2, 3});
  box.add({2, 4, 8});
  const auto [low, high] = reachAlong(box, {0.6, 0.0, -0.8});
  EXPECT_NEAR(low, -0.6 - 6.4, 1e-15);
  EXPECT_NEAR(high, 1.2 - 2.4, 1e-15);
}

}  // namespace
}  // namespace nearfit::mesh_section_test
