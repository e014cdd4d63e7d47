#include "core/mesh/check/mesh_repair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mesh/check/mesh_check.h"
#include "tests/core/mesh/check/faulty_meshes.h"
#include "tests/support/cached_meshes.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::mesh_repair_test {
namespace {

using test::boxMesh;
using test::joined;
using test::turned;

constexpr MeshRepair kClean{RepairKind::Clean}, kOrient{RepairKind::Orient};

RepairedMesh repaired(const TriangleMesh& mesh, const MeshRepairs& repairs) {
  return repairMesh(mesh, repairs);
}

/// No findings at all.
void expectSound(const TriangleMesh& mesh) {
  for (const MeshFinding& finding : checkMesh(mesh).findings)
    ADD_FAILURE() << wordOf(finding.kind) << ": " << finding.count;
  EXPECT_TRUE(mesh.topology().isClosed() && mesh.topology().isOriented());
}

TEST(MeshRepair, AMissingTriangleIsFilledAndTheChangeIsStated) {
  const TriangleMesh box = boxMesh({3, 4, 5});
  for (std::size_t i = 0; i < box.triangles().size(); ++i) {
    const TriangleMesh open = test::withoutTriangle(box, i);
    const RepairedMesh result = repaired(open, {{RepairKind::FillHoles, 10.0}});
    expectSound(result.mesh);
    ASSERT_EQ(result.steps.size(), 1U);
    EXPECT_EQ(result.steps[0].changed, 1U);
    EXPECT_EQ(result.steps[0].addedFaces, 1U);
    EXPECT_EQ(result.steps[0].left, 0U);
    EXPECT_EQ(result.originOf.size(), 12U);
    EXPECT_EQ(result.originOf.back(), RepairedMesh::kNoOrigin);
    EXPECT_EQ(result.originOf.front(), 0U);
    const MeshChange change = changeBetween(open, result.mesh);
    EXPECT_FALSE(change.before.volume);
    EXPECT_EQ(change.before.openEdges, 3U);
    EXPECT_NEAR(change.after.volume.value(), 60.0, 1e-9);
    EXPECT_NEAR(change.after.area, 94.0, 1e-9);
    const Triangle& t = box.triangles()[i];
    const glm::dvec3 a = box.vertices()[t[0]], b = box.vertices()[t[1]], c = box.vertices()[t[2]];
    const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
    EXPECT_NEAR(change.after.area - change.before.area, area, 1e-9);
    // Its centre is a third of its smallest height from the rim.
    const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    EXPECT_NEAR(change.maxDistance, 2.0 * area / longest / 3.0, 1e-9);
    EXPECT_FALSE(change.isSampled);
  }
}

TEST(MeshRepair, AHoleLargerThanTheSizeStays) {
  const TriangleMesh open = test::withoutTriangle(boxMesh({3, 4, 5}), 0);
  const RepairedMesh result = repaired(open, {{RepairKind::FillHoles, 1.0}});
  EXPECT_EQ(result.steps[0].changed, 0U);
  EXPECT_TRUE(result.mesh.sharesArraysOf(open)) << "nothing is copied if nothing changes";
}

TEST(MeshRepair, TheEndsOfATubeAreFilledFlat) {
  constexpr std::uint32_t kSegments = 48;
  const TriangleMesh solid = test::cylinderMesh(1.0, 2.0, kSegments);
  std::vector<Triangle> wall;
  for (const Triangle& t : solid.triangles()) {
    const auto z = [&](std::size_t k) { return solid.vertices()[t[k]].z; };
    if (!(z(0) == z(1) && z(1) == z(2))) wall.push_back(t);
  }
  const TriangleMesh tube = test::withTriangles(solid, wall);
  const RepairedMesh result = repaired(tube, {{RepairKind::FillHoles, 3.0}});
  expectSound(result.mesh);
  EXPECT_EQ(result.steps[0].changed, 2U);
  EXPECT_EQ(result.steps[0].addedFaces, 2U * (kSegments - 2));
  const double prism = 2.0 * 0.5 * kSegments * std::sin(2.0 * std::numbers::pi / kSegments);
  EXPECT_NEAR(changeBetween(tube, result.mesh).after.volume.value(), prism, 1e-9);
}

TEST(MeshRepair, TheOutsideOfALooseTriangleIsNoHole) {
  const TriangleMesh loose({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  const RepairedMesh result = repaired(loose, {{RepairKind::FillHoles, 10.0}});
  EXPECT_EQ(result.steps[0].changed, 0U);
  EXPECT_EQ(result.steps[0].left, 1U);
}

TEST(MeshRepair, ADoubledFaceIsRemovedAndTheOneThatFitsStays) {
  const TriangleMesh box = boxMesh({3, 4, 5});
  for (const bool isTurned : {false, true}) {
    Triangle copy = box.triangles()[3];
    if (isTurned) std::swap(copy[0], copy[1]);
    // Whichever comes first.
    std::vector<Triangle> triangles = test::trianglesOf(box);
    triangles.insert(triangles.begin(), copy);
    for (const TriangleMesh& doubled : {test::withTriangle(box, copy), test::withTriangles(box, triangles)}) {
      const RepairedMesh result = repaired(doubled, {kClean});
      expectSound(result.mesh);
      EXPECT_EQ(result.steps[0].removedFaces, 1U);
      EXPECT_NEAR(changeBetween(doubled, result.mesh).after.volume.value(), 60.0, 1e-9);
      EXPECT_EQ(changeBetween(doubled, result.mesh).maxDistance, 0.0);
    }
  }
}

TEST(MeshRepair, AWallBetweenTwoSolidsGoes) {
  // Two boxes side by side that share the corners of a face, each with its own.
  const TriangleMesh both =
      repaired(joined(boxMesh({1, 1, 1}), boxMesh({1, 1, 1}, {1, 0, 0})), {{RepairKind::Weld, 1e-9}}).mesh;
  ASSERT_GT(checkMesh(both).total(FindingKind::DuplicateFaces).count, 0U);
  const RepairedMesh result = repaired(both, {kClean});
  expectSound(result.mesh);
  const MeshChange change = changeBetween(both, result.mesh);
  EXPECT_NEAR(change.after.volume.value(), 2.0, 1e-12);
  // Two triangles from each side; what is farthest from the surface is the middle of the wall.
  EXPECT_EQ(result.steps[0].wallFaces, 4U);
  EXPECT_NEAR(change.maxDistance, 0.5, 1e-12);
  EXPECT_TRUE(change.isOfRemoved);
}

TEST(MeshRepair, ALineThatSticksOutAndACopyAreNoSurfaceThatMoved) {
  const TriangleMesh box = boxMesh({3, 4, 5});
  std::vector<glm::dvec3> vertices(box.vertices().begin(), box.vertices().end());
  const glm::dvec3 corner = vertices[0];
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.push_back(corner + glm::sign(corner));
  vertices.push_back(corner + 2.0 * glm::sign(corner));
  std::vector<Triangle> triangles = test::trianglesOf(box);
  triangles.push_back({0, first, first + 1});
  triangles.push_back(triangles[3]);
  const TriangleMesh faulty(vertices, triangles);
  const RepairedMesh result = repaired(faulty, {kClean});
  EXPECT_EQ(result.steps[0].removedFaces, 2U);
  EXPECT_EQ(result.steps[0].wallFaces, 0U);
  const MeshChange change = changeBetween(faulty, result.mesh);
  EXPECT_EQ(change.maxDistance, 0.0);
  EXPECT_FALSE(change.isOfRemoved);
}

TEST(MeshRepair, ALineInATJointIsSwapped) {
  const glm::dvec3 a(0, 0, 0), b(2, 0, 0), c(0, 2, 0), d(0, 0, 2);
  const TriangleMesh mesh({a, b, c, d, 0.5 * (a + b)},
                          {{0, 2, 1}, {0, 4, 3}, {4, 1, 3}, {0, 1, 4}, {0, 3, 2}, {1, 2, 3}});
  const RepairedMesh result = repaired(mesh, {kClean});
  expectSound(result.mesh);
  EXPECT_EQ(result.steps[0].changed, 1U);
  // Two triangles cover the face behind the line.
  EXPECT_EQ(std::ranges::count(result.originOf, 0U), 2);
  EXPECT_EQ(std::ranges::count(result.originOf, 3U), 0);
  EXPECT_NEAR(changeBetween(mesh, result.mesh).after.volume.value(), 8.0 / 6.0, 1e-12);
}

TEST(MeshRepair, ShellsAreTurnedOutwardAndCavitiesStay) {
  const TriangleMesh outer = boxMesh({3, 4, 5}), cavity = turned(boxMesh({1, 1, 1})),
                     beside = boxMesh({1, 1, 1}, {9, 0, 0});
  const TriangleMesh wrong = joined(joined(outer, cavity), turned(beside));
  const RepairedMesh result = repaired(wrong, {kOrient});
  expectSound(result.mesh);
  EXPECT_EQ(result.steps[0].changed, 12U);
  const MeshChange change = changeBetween(wrong, result.mesh);
  EXPECT_NEAR(change.before.volume.value(), 60.0 - 1.0 - 1.0, 1e-9);
  EXPECT_NEAR(change.after.volume.value(), 60.0 - 1.0 + 1.0, 1e-9);
  EXPECT_EQ(change.maxDistance, 0.0);
}

TEST(MeshRepair, TurnedFacesAreTurnedBack) {
  const TriangleMesh ball = test::icosphereMesh(1, 2);
  std::vector<Triangle> triangles = test::trianglesOf(ball);
  for (std::size_t i = 0; i < triangles.size(); i += 7)
    std::swap(triangles[i][0], triangles[i][1]);
  const RepairedMesh result = repaired(test::withTriangles(ball, triangles), {kOrient});
  expectSound(result.mesh);
  EXPECT_EQ(result.steps[0].changed, (triangles.size() + 6) / 7);
  EXPECT_EQ(result.steps[0].left, 0U);
}

TEST(MeshRepair, AMoebiusStripCannotBeOriented) {
  constexpr std::uint32_t kCuts = 24;
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < kCuts; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / kCuts;
    const glm::dvec3 out(std::cos(turn), std::sin(turn), 0.0);
    const glm::dvec3 across = 0.3 * (std::cos(0.5 * turn) * out + glm::dvec3(0, 0, std::sin(0.5 * turn)));
    vertices.push_back(out - across);
    vertices.push_back(out + across);
  }
  for (std::uint32_t i = 0; i < kCuts; ++i) {
    const bool isLast = i + 1 == kCuts;
    const std::uint32_t a = 2 * i, b = 2 * i + 1, c = isLast ? 1 : 2 * i + 2, d = isLast ? 0 : 2 * i + 3;
    triangles.push_back({a, c, b});
    triangles.push_back({b, c, d});
  }
  const RepairedMesh result = repaired({vertices, triangles}, {kOrient});
  EXPECT_EQ(result.steps[0].left, 1U);
}

TEST(MeshRepair, ALooseLidIsStitchedOnAndMovesByTheGap) {
  for (const double gap : {1e-6, 1e-3}) {
    const TriangleMesh loose = test::boxWithALooseLid(gap);
    ASSERT_EQ(loose.topology().openEdges, 8U);
    const RepairedMesh result = repaired(loose, {{RepairKind::Stitch, 2.0 * gap}});
    expectSound(result.mesh);
    EXPECT_EQ(result.steps[0].changed, 4U);
    EXPECT_EQ(result.steps[0].addedFaces, 0U);
    const MeshChange change = changeBetween(loose, result.mesh);
    EXPECT_NEAR(change.maxDistance, gap, 1e-12);
    EXPECT_NEAR(change.after.volume.value(), 60.0, 1e-9);
    // A narrower tolerance leaves it.
    EXPECT_EQ(repaired(loose, {{RepairKind::Stitch, 0.5 * gap}}).mesh.topology().openEdges, 8U);
  }
}

TEST(MeshRepair, ATJointIsSplitAtItsVertex) {
  for (const double rise : {0.0, 1e-3}) {
    const TriangleMesh torn = test::tJoint(rise);
    const RepairedMesh result = repaired(torn, {{RepairKind::Stitch, 2e-3}});
    EXPECT_EQ(result.mesh.topology().openEdges, 4U);
    EXPECT_EQ(result.steps[0].addedFaces, 1U);
    EXPECT_LE(changeBetween(torn, result.mesh).maxDistance, rise + 1e-12);
    // Both fragments are of the third triangle.
    EXPECT_EQ(std::ranges::count(result.originOf, 2U), 2);
  }
}

TEST(MeshRepair, StitchingDoesNotSwallowSmallFaces) {
  // All edges of this fine border are shorter than the tolerance.
  const TriangleMesh sheet = test::squareMesh(1.0, 100);
  const RepairedMesh result = repaired(sheet, {{RepairKind::Stitch, 0.012}});
  EXPECT_GE(result.mesh.triangles().size(), sheet.triangles().size());
}

TEST(MeshRepair, VerticesOfTrianglesTornApartAreWelded) {
  const TriangleMesh torn = test::tornApart(test::icosphereMesh(1, 2));
  const RepairedMesh result = repaired(torn, {{RepairKind::Weld, 1e-9}});
  expectSound(result.mesh);
  EXPECT_EQ(result.steps[0].changed, 3U * 320U - 162U);
  EXPECT_EQ(result.mesh.vertices().size(), 162U);
  EXPECT_EQ(changeBetween(torn, result.mesh).maxDistance, 0.0);
}

TEST(MeshRepair, CrumbsAreDropped) {
  const TriangleMesh box = boxMesh({3, 4, 5}), crumb = boxMesh({0.01, 0.01, 0.01}, {9, 0, 0});
  const RepairedMesh result = repaired(joined(box, crumb), {{RepairKind::DropShells, 0.02}});
  EXPECT_EQ(result.steps[0].changed, 1U);
  EXPECT_EQ(result.steps[0].removedFaces, 12U);
  EXPECT_TRUE(test::areSame(result.mesh, box));
  // The crumb was that far from the box.
  EXPECT_NEAR(changeBetween(joined(box, crumb), result.mesh).maxDistance, 9.005 - 1.5, 1e-9);
}

TEST(MeshRepair, ARepairThatLeavesNothingIsAnError) {
  const TriangleMesh box = boxMesh({3, 4, 5});
  EXPECT_THROW(repaired(box, {{RepairKind::DropShells, 100.0}}), Error);
  EXPECT_THROW(repaired(box, {{RepairKind::Weld, 100.0}}), Error);
}

TEST(MeshRepair, RepairsInARowMendWhatNoneMendsAlone) {
  // A loose lid, a hole, a turned face and a doubled one.
  std::vector<Triangle> triangles = test::trianglesOf(test::boxWithALooseLid(1e-4));
  const std::vector<glm::dvec3> vertices = test::verticesOf(test::boxWithALooseLid(1e-4));
  const auto isOnFloor = [&](const Triangle& t) {
    return std::ranges::all_of(t, [&](std::uint32_t v) { return vertices[v].z < 0.0; });
  };
  triangles.erase(std::ranges::find_if(triangles, isOnFloor));
  const auto side = std::ranges::find_if(triangles, [&](const Triangle& t) { return !isOnFloor(t); });
  std::swap((*side)[0], (*side)[1]);
  triangles.push_back(*side);
  RepairChoice choice;
  choice.stitch = 2e-4;
  choice.fill = 10.0;
  choice.clean = choice.orient = true;
  const MeshRepairs repairs = repairsOf(choice);
  const TriangleMesh damaged(vertices, triangles);
  const RepairedMesh result = repaired(damaged, repairs);
  expectSound(result.mesh);
  EXPECT_NEAR(changeBetween(damaged, result.mesh).after.volume.value(), 60.0, 1e-3);
  // The scene keeps the repairs only, so that the same must come out.
  EXPECT_TRUE(test::areSame(repaired(damaged, repairs).mesh, result.mesh));
}

TEST(MeshRepair, DegenerateMeshesAreRepairedToTheEnd) {
  const TriangleMesh star = test::starMesh(3, 1.0, 2, 0.4);
  RepairChoice choice;
  choice.weld = 1e-9;
  choice.stitch = 1e-4;
  choice.drop = 1e-3;
  choice.fill = 1.0;
  choice.clean = choice.orient = true;
  for (const TriangleMesh& mesh :
       {test::withSlivers(star, 1e6, 0.0), test::withNeedles(star, 1e9, 0.1), test::withDuplicates(star),
        test::withFacesWithoutArea(star), test::jaggedFan(7, 500, 0.1), test::finsMesh(5, 40, 6.0),
        test::coplanarFans(2, 6), test::crossedApexMesh(), test::tornApart(star)}) {
    const RepairedMesh result = repaired(mesh, repairsOf(choice));
    EXPECT_EQ(result.originOf.size(), result.mesh.triangles().size());
    for (const std::uint32_t origin : result.originOf)
      EXPECT_TRUE(origin == RepairedMesh::kNoOrigin || origin < mesh.triangles().size());
    EXPECT_TRUE(std::isfinite(changeBetween(mesh, result.mesh).maxDistance));
  }
}

TEST(MeshRepair, IsCancelled) {
  const TriangleMesh mesh = test::icosphereMesh(1, 3);
  EXPECT_THROW(repairMesh(mesh, MeshRepairs{kOrient}, [](double) { return false; }), Cancelled);
  EXPECT_THROW(changeBetween(mesh, test::moved(mesh, {1, 0, 0}), [](double) { return false; }), Cancelled);
}

TEST(MeshRepair, SizesOutOfRangeAreRefused) {
  for (const double size : {0.0, -1.0, std::nan(""), HUGE_VAL, 1e7})
    EXPECT_THROW(checkRepairs(MeshRepairs{{RepairKind::Weld, size}}), UsageError) << size;
  checkRepairs(MeshRepairs{kOrient, kClean, {RepairKind::Weld, 1e-6}});
  EXPECT_THROW(checkRepairs(MeshRepairs(kMaxRepairs + 1, kOrient)), UsageError);
}

TEST(MeshRepair, WordsAndTextsTellRepairsApart) {
  std::vector<std::string> texts{textOf(MeshRepairs())};
  for (std::size_t i = 0; i < kRepairKinds; ++i) {
    const auto kind = static_cast<RepairKind>(i);
    EXPECT_EQ(repairNamed(wordOf(kind)), kind);
    texts.push_back(textOf(MeshRepairs{{kind, 1e-3}}));
  }
  texts.push_back(textOf(MeshRepairs{{RepairKind::Weld, std::nextafter(1e-3, 1.0)}}));
  texts.push_back(textOf(MeshRepairs{kOrient, kOrient}));
  std::ranges::sort(texts);
  EXPECT_EQ(std::ranges::adjacent_find(texts), texts.end());
  EXPECT_FALSE(repairNamed("melt"));
}

TEST(MeshRepair, SizesScaleWithTheMesh) {
  const MeshRepairs scaled = scaledRepairs({{RepairKind::Weld, 1e-6}, kOrient}, 1000.0);
  EXPECT_NEAR(scaled[0].size, 1e-3, 1e-15);
  EXPECT_EQ(scaled[1], kOrient);
}

}  // namespace
}  // namespace nearfit::mesh_repair_test
