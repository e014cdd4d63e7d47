#include "core/exact/mesh_intersection.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/mesh/mass_properties.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::mesh_intersection_test {
namespace {

constexpr std::size_t kAny = 10'000'000;

MeshArrays arraysOf(const TriangleMesh& mesh) {
  return {mesh.vertices(), mesh.triangles()};
}
IntersectionVolume volumeOf(const TriangleMesh& a, const TriangleMesh& b) {
  return findIntersectionVolume(arraysOf(a), arraysOf(b), kAny, kAny);
}
IntersectionCurves curvesOf(const TriangleMesh& a, const TriangleMesh& b) {
  return findIntersectionCurves(arraysOf(a), arraysOf(b), kAny);
}
double lengthOf(const IntersectionCurves& curves) {
  double length = 0.0;
  for (const auto& line : curves.polylines) {
    for (std::size_t i = 1; i < line.size(); ++i)
      length += glm::distance(line[i - 1], line[i]);
  }
  return length;
}
void expectVolume(const TriangleMesh& a, const TriangleMesh& b, double expected) {
  const IntersectionVolume found = volumeOf(a, b);
  ASSERT_TRUE(found.volume) << static_cast<int>(found.problem);
  EXPECT_NEAR(*found.volume, expected, 1e-12);
  const IntersectionVolume other = volumeOf(b, a);
  ASSERT_TRUE(other.volume);
  EXPECT_NEAR(*other.volume, expected, 1e-12);
}

TEST(MeshIntersection, BoxesThatOverlapAtACornerShareABoxAndALoopOfSixEdges) {
  const TriangleMesh a = test::boxMesh(glm::dvec3(1.0)), b = test::boxMesh(glm::dvec3(1.0), glm::dvec3(0.5));
  expectVolume(a, b, 0.125);
  const IntersectionCurves curves = curvesOf(a, b);
  EXPECT_TRUE(curves.isComplete);
  ASSERT_EQ(curves.polylines.size(), 1U);
  EXPECT_EQ(curves.polylines[0].front(), curves.polylines[0].back());
  EXPECT_NEAR(lengthOf(curves), 6 * 0.5, 1e-12);
}

TEST(MeshIntersection, ABarThroughABoxMeetsItInTwoLoops) {
  const TriangleMesh box = test::boxMesh(glm::dvec3(1.0)), bar = test::boxMesh({0.2, 0.3, 3.0});
  expectVolume(box, bar, 0.2 * 0.3);
  const IntersectionCurves curves = curvesOf(box, bar);
  ASSERT_EQ(curves.polylines.size(), 2U);
  for (const auto& line : curves.polylines)
    EXPECT_EQ(line.front(), line.back());
  EXPECT_NEAR(lengthOf(curves), 2 * (2 * 0.2 + 2 * 0.3), 1e-12);
}

TEST(MeshIntersection, SquareBarsTurnedByAnEighthShareAnOctagon) {
  const TriangleMesh box = test::boxMesh(glm::dvec3(1.0));
  const TriangleMesh bar = test::transformed(test::boxMesh({1.0, 1.0, 2.0}), 1.0,
                                             {glm::angleAxis(std::numbers::pi / 4, glm::dvec3(0, 0, 1)), {}});
  const double side = std::numbers::sqrt2 - 1.0;
  expectVolume(box, bar, 2.0 * side);
  // Eight upright edges, and the bar's walls in the two ends of the box.
  EXPECT_NEAR(lengthOf(curvesOf(box, bar)), 8 * 1.0 + 2 * 4 * side, 1e-12);
}

TEST(MeshIntersection, ABodyInsideAnotherIsSharedWholeWithoutACurve) {
  const TriangleMesh shell = test::boxMesh(glm::dvec3(2.0)), core = test::boxMesh({1.0, 0.5, 0.25});
  expectVolume(shell, core, 0.125);
  EXPECT_TRUE(curvesOf(shell, core).polylines.empty());
}

TEST(MeshIntersection, BodiesThatAreApartShareNothing) {
  const TriangleMesh a = test::boxMesh(glm::dvec3(1.0)), b = test::boxMesh(glm::dvec3(1.0), {1.5, 0.0, 0.0});
  expectVolume(a, b, 0.0);
  EXPECT_TRUE(curvesOf(a, b).polylines.empty());
}

TEST(MeshIntersection, APlaneThroughTheMiddleOfASphereHalvesIt) {
  const TriangleMesh sphere = test::icosphereMesh(0.5, 3);
  const TriangleMesh half = test::boxMesh({2.0, 2.0, 1.0}, {0.0, 0.0, 0.5});
  // An icosphere is its own mirror image about its centre.
  expectVolume(sphere, half, massProperties(sphere).volume / 2.0);
}

TEST(MeshIntersection, CylindersThatCrossShareTheSolidOfSteinmetz) {
  constexpr double kRadius = 0.5;
  constexpr std::uint32_t kSegments = 256;
  const TriangleMesh upright = test::cylinderMesh(kRadius, 3.0, kSegments);
  const TriangleMesh lying =
      test::transformed(upright, 1.0, {glm::angleAxis(std::numbers::pi / 2, glm::dvec3(1, 0, 0)), {}});
  const IntersectionVolume found = volumeOf(upright, lying);
  ASSERT_TRUE(found.volume) << static_cast<int>(found.problem);
  // Between those of the circles around and in the polygons.
  const double inner = kRadius * std::cos(std::numbers::pi / kSegments);
  EXPECT_LT(*found.volume, 16.0 / 3.0 * std::pow(kRadius, 3));
  EXPECT_GT(*found.volume, 16.0 / 3.0 * std::pow(inner, 3));
}

TEST(MeshIntersection, FlushBoxesShareTheirOverlapAndTheOutlineOfTheirCommonFaces) {
  const TriangleMesh a = test::boxMesh(glm::dvec3(1.0)), b = test::boxMesh(glm::dvec3(1.0), {0.5, 0.0, 0.0});
  expectVolume(a, b, 0.5);
  // Two squares, where a box ends in the other, and the four edges between them.
  EXPECT_NEAR(lengthOf(curvesOf(a, b)), 2 * 4 * 1.0 + 4 * 0.5, 1e-12);
}

TEST(MeshIntersection, CurvesDoNotNeedClosedMeshesButTheVolumeDoes) {
  const TriangleMesh sheet = test::squareMesh(4.0, 3), box = test::boxMesh(glm::dvec3(1.0));
  const IntersectionCurves curves = curvesOf(sheet, box);
  EXPECT_NEAR(lengthOf(curves), 4.0, 1e-12);
  EXPECT_EQ(volumeOf(sheet, box).problem, VolumeProblem::Open);
  EXPECT_EQ(volumeOf(box, sheet).problem, VolumeProblem::Open);
}

TEST(MeshIntersection, WhatIsNoSolidIsRefusedWithAReason) {
  const TriangleMesh box = test::boxMesh(glm::dvec3(1.0));
  const TriangleMesh other = test::boxMesh(glm::dvec3(1.0), glm::dvec3(0.3));
  EXPECT_EQ(volumeOf(test::turned(box), other).problem, VolumeProblem::InsideOut);
  const MeshArrays first = arraysOf(box), second = arraysOf(other);
  EXPECT_EQ(findIntersectionVolume(first, second, 23, kAny).problem, VolumeProblem::TooLarge);
  EXPECT_EQ(findIntersectionVolume(first, second, kAny, 1).problem, VolumeProblem::TooLarge);
  // A tetrahedron with a sliver without area in an edge: (0, 1, 2) on one line.
  const TriangleMesh flat({{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {2, 0, 0}, {0, 2, 0}},
                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 4, 2}, {0, 3, 4}, {2, 4, 3}});
  EXPECT_EQ(volumeOf(flat, other).problem, VolumeProblem::NoArea);
  // Two tetrahedra with a common edge.
  const TriangleMesh hinge(
      {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
      {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}, {0, 1, 4}, {0, 5, 1}, {0, 4, 5}, {1, 5, 4}});
  EXPECT_EQ(volumeOf(hinge, other).problem, VolumeProblem::NotManifold);
}

TEST(MeshIntersection, AMeshThatCrossesItselfThereHasCurvesButNoVolume) {
  const TriangleMesh crossed =
      test::joined(test::boxMesh(glm::dvec3(1.0)), test::boxMesh(glm::dvec3(1.0), glm::dvec3(0.4)));
  const TriangleMesh bar = test::boxMesh({0.3, 0.3, 4.0}, {0.45, 0.0, 0.0});
  EXPECT_FALSE(volumeOf(crossed, bar).volume);
  EXPECT_GT(lengthOf(curvesOf(crossed, bar)), 1.0);
}

TEST(MeshIntersection, TheCallerCanStopItAndLimitIt) {
  const TriangleMesh a = test::icosphereMesh(0.5, 4),
                     b = test::transformed(a, 1.0, {glm::dquat(1, 0, 0, 0), {0.3, 0.2, 0.1}});
  const GoOn stop = [] { return false; };
  EXPECT_EQ(findIntersectionVolume(arraysOf(a), arraysOf(b), kAny, kAny, stop).problem,
            VolumeProblem::Stopped);
  EXPECT_FALSE(findIntersectionCurves(arraysOf(a), arraysOf(b), kAny, stop).isComplete);
  EXPECT_FALSE(findIntersectionCurves(arraysOf(a), arraysOf(b), 10).isComplete);
}

TEST(MeshIntersection, TheFrameChangesNothingFarFromTheOrigin) {
  const RigidTransform far{glm::dquat(1, 0, 0, 0), {1024.0, -2048.0, 512.0}};
  const TriangleMesh a = test::transformed(test::boxMesh(glm::dvec3(1.0)), 1.0, far);
  const TriangleMesh b = test::transformed(test::boxMesh(glm::dvec3(1.0), glm::dvec3(0.5)), 1.0, far);
  expectVolume(a, b, 0.125);
}

}  // namespace
}  // namespace nearfit::mesh_intersection_test
