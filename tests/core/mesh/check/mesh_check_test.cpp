#include "core/mesh/check/mesh_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/import/mesh_import.h"
#include "core/mesh/check/crossing_triangles.h"
#include "tests/core/mesh/check/faulty_meshes.h"
#include "tests/exact/exact_meeting.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/places.h"

namespace nearfit::mesh_check_test {
namespace {

using test::boxMesh;
using test::joined;
using test::turned;

std::vector<MeshFinding> findingsOf(const MeshCheck& check, FindingKind kind) {
  std::vector<MeshFinding> found;
  std::ranges::copy_if(check.findings, std::back_inserter(found),
                       [kind](const MeshFinding& finding) { return finding.kind == kind; });
  return found;
}

/// The one finding of a mesh; fails if there are others.
MeshFinding onlyFinding(const TriangleMesh& mesh, FindingKind kind, const MeshCheckOptions& options = {}) {
  const MeshCheck check = checkMesh(mesh, options);
  EXPECT_EQ(check.findings.size(), 1U);
  const std::vector<MeshFinding> found = findingsOf(check, kind);
  EXPECT_EQ(found.size(), 1U);
  return found.empty() ? MeshFinding() : found.front();
}

bool isWithin(const Aabb& box, const glm::dvec3& p) {
  return glm::all(glm::lessThanEqual(box.lower, p)) && glm::all(glm::lessThanEqual(p, box.upper));
}

double perimeterOf(const TriangleMesh& mesh, std::size_t triangle) {
  const Triangle& t = mesh.triangles()[triangle];
  const glm::dvec3 a = mesh.vertices()[t[0]], b = mesh.vertices()[t[1]], c = mesh.vertices()[t[2]];
  return glm::distance(a, b) + glm::distance(b, c) + glm::distance(c, a);
}

TEST(MeshCheck, SoundMeshesHaveNoFindings) {
  for (const TriangleMesh& mesh : {boxMesh({3, 4, 5}), test::torusMesh(2, 0.5, 24, 12),
                                   test::tubeMesh(1, 2, 3, 32), test::icosphereMesh(1, 3)}) {
    const MeshCheck check = checkMesh(mesh);
    EXPECT_TRUE(check.findings.empty());
    EXPECT_FALSE(check.worst());
    EXPECT_EQ(check.places(), 0U);
  }
}

TEST(MeshCheck, AMissingTriangleIsALoopOfItsThreeEdges) {
  const TriangleMesh box = boxMesh({3, 4, 5});
  for (const std::size_t triangle : {0U, 5U, 11U}) {
    const MeshFinding hole = onlyFinding(test::withoutTriangle(box, triangle), FindingKind::OpenEdges);
    EXPECT_EQ(hole.count, 3U);
    EXPECT_NEAR(hole.length, perimeterOf(box, triangle), 1e-12);
    EXPECT_EQ(hole.severity, FindingSeverity::Warning);
    EXPECT_EQ(hole.edges.size(), 3U);
    EXPECT_TRUE(isWithin(hole.box, hole.point));
  }
}

TEST(MeshCheck, LoopsThatTouchInAVertexAreToldApart) {
  // Two squares that share a corner, each with its own border.
  const TriangleMesh mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}},
                          {{0, 1, 2}, {0, 2, 3}, {2, 4, 5}, {2, 5, 6}});
  const MeshCheck check = checkMesh(mesh);
  const std::vector<MeshFinding> loops = findingsOf(check, FindingKind::OpenEdges);
  ASSERT_EQ(loops.size(), 2U);
  for (const MeshFinding& loop : loops) {
    EXPECT_EQ(loop.count, 4U);
    EXPECT_NEAR(loop.length, 4.0, 1e-12);
  }
  EXPECT_EQ(check.total(FindingKind::OpenEdges).count, 8U);
  const std::vector<MeshFinding> pinches = findingsOf(check, FindingKind::NonManifoldVertices);
  ASSERT_EQ(pinches.size(), 1U);
  EXPECT_TRUE(isWithin(pinches[0].box, {1, 1, 0}));
}

TEST(MeshCheck, ARepeatedFaceIsADuplicateInEitherSense) {
  const TriangleMesh box = boxMesh({3, 4, 5});
  for (const bool isTurned : {false, true}) {
    Triangle copy = box.triangles()[3];
    if (isTurned) std::swap(copy[0], copy[1]);
    const MeshCheck check = checkMesh(test::withTriangle(box, copy));
    const std::vector<MeshFinding> copies = findingsOf(check, FindingKind::DuplicateFaces);
    ASSERT_EQ(copies.size(), 1U);
    EXPECT_EQ(copies[0].count, 1U);
    EXPECT_EQ(copies[0].severity, isTurned ? FindingSeverity::Warning : FindingSeverity::Note);
    // Its three edges have three faces now.
    ASSERT_EQ(findingsOf(check, FindingKind::NonManifoldEdges).size(), 1U);
    EXPECT_EQ(check.total(FindingKind::NonManifoldEdges).count, 3U);
    EXPECT_EQ(check.total(FindingKind::SelfIntersections).count, 0U);
  }
}

TEST(MeshCheck, ShellsThatFaceTheWrongWayAreFound) {
  const TriangleMesh outer = boxMesh({3, 4, 5}), inner = boxMesh({1, 1, 1}),
                     beside = boxMesh({1, 1, 1}, {9, 0, 0});
  EXPECT_TRUE(checkMesh(joined(outer, turned(inner))).findings.empty()) << "a cavity";
  EXPECT_TRUE(checkMesh(joined(joined(outer, turned(inner)), boxMesh({0.5, 0.5, 0.5}))).findings.empty())
      << "a solid in a cavity";
  const MeshFinding flipped = onlyFinding(joined(outer, turned(beside)), FindingKind::InvertedShells);
  EXPECT_EQ(flipped.count, 12U);
  EXPECT_EQ(flipped.severity, FindingSeverity::Serious);
  EXPECT_EQ(flipped.box.lower.x, 8.5);
  EXPECT_EQ(onlyFinding(turned(outer), FindingKind::InvertedShells).count, 12U);
  EXPECT_EQ(onlyFinding(joined(outer, inner), FindingKind::InvertedShells).severity, FindingSeverity::Note);
}

TEST(MeshCheck, AShellInTheBoxOfAnotherButOutsideItIsNotWithinIt) {
  // In the hole of a torus.
  const TriangleMesh torus = test::torusMesh(2, 0.5, 24, 12), ball = test::icosphereMesh(0.3, 2);
  EXPECT_TRUE(checkMesh(joined(torus, ball)).findings.empty());
  EXPECT_EQ(onlyFinding(joined(torus, turned(ball)), FindingKind::InvertedShells).severity,
            FindingSeverity::Serious);
}

TEST(MeshCheck, ATurnedFaceMakesItsEdgesInconsistent) {
  const TriangleMesh box = boxMesh({3, 4, 5});
  std::vector<Triangle> triangles = test::trianglesOf(box);
  std::swap(triangles[4][0], triangles[4][1]);
  const MeshFinding finding =
      onlyFinding(test::withTriangles(box, triangles), FindingKind::InconsistentEdges);
  EXPECT_EQ(finding.count, 3U);
  EXPECT_EQ(finding.severity, FindingSeverity::Serious);
}

TEST(MeshCheck, EdgesOfThreeFacesAreNonManifold) {
  const TriangleMesh fins({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}},
                          {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}});
  const MeshCheck check = checkMesh(fins);
  EXPECT_EQ(check.total(FindingKind::NonManifoldEdges).count, 1U);
  EXPECT_EQ(check.total(FindingKind::OpenEdges).count, 6U);
  EXPECT_EQ(check.total(FindingKind::NonManifoldVertices).count, 0U);
}

TEST(MeshCheck, AVertexInWhichTwoSolidsTouchIsNonManifold) {
  // Two tetrahedra with one vertex in common.
  const TriangleMesh one(
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
      {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}});
  ASSERT_TRUE(one.topology().isClosed() && one.topology().isOriented());
  const MeshCheck check = checkMesh(one);
  const std::vector<MeshFinding> pinches = findingsOf(check, FindingKind::NonManifoldVertices);
  ASSERT_EQ(pinches.size(), 1U);
  EXPECT_EQ(pinches[0].count, 1U);
  EXPECT_EQ(pinches[0].severity, FindingSeverity::Note);
}

TEST(MeshCheck, ATJointIsACrackOfNoWidth) {
  const MeshCheck check = checkMesh(test::tJoint(0.0));
  const std::vector<MeshFinding> cracks = findingsOf(check, FindingKind::HairlineCracks);
  ASSERT_EQ(cracks.size(), 1U);
  EXPECT_EQ(cracks[0].count, 1U) << "the edge on which the vertex lies";
  EXPECT_EQ(cracks[0].length, 0.0);
  EXPECT_EQ(check.total(FindingKind::OpenEdges).count, 7U);
  EXPECT_EQ(check.total(FindingKind::OpenEdges).places, 2U);
}

TEST(MeshCheck, ACrackHasItsWidthAndTheToleranceDecides) {
  for (const double width : {1e-6, 1e-3, 0.02}) {
    const TriangleMesh sheets =
        joined(test::squareMesh(1.0, 4), test::moved(test::squareMesh(1.0, 4), {1.0 + width, 0.0, 0.0}));
    MeshCheckOptions options;
    options.crackTolerance = 1.5 * width;
    const MeshCheck check = checkMesh(sheets, options);
    const std::vector<MeshFinding> cracks = findingsOf(check, FindingKind::HairlineCracks);
    ASSERT_EQ(cracks.size(), 1U) << width;
    EXPECT_NEAR(cracks[0].length, width, 1e-12);
    // Four on each side, and where the crack ends the two that go on from it on each side.
    EXPECT_EQ(cracks[0].count, 12U);
    EXPECT_GE(cracks[0].box.lower.x, 0.2);
    options.crackTolerance = 0.5 * width;
    EXPECT_EQ(checkMesh(sheets, options).total(FindingKind::HairlineCracks).places, 0U);
  }
}

TEST(MeshCheck, TheFineBorderOfAHoleIsNoCrack) {
  // An open tube of 200 edges around, each shorter than the tolerance.
  const TriangleMesh solid = test::cylinderMesh(1.0, 2.0, 200);
  std::vector<Triangle> wall;
  for (const Triangle& t : solid.triangles()) {
    const auto z = [&](std::size_t k) { return solid.vertices()[t[k]].z; };
    if (!(z(0) == z(1) && z(1) == z(2))) wall.push_back(t);
  }
  MeshCheckOptions options;
  options.crackTolerance = 0.1;
  const MeshCheck check = checkMesh(test::withTriangles(solid, wall), options);
  EXPECT_EQ(check.total(FindingKind::OpenEdges).places, 2U);
  EXPECT_EQ(check.total(FindingKind::HairlineCracks).places, 0U);
}

TEST(MeshCheck, FacesWithoutAreaAreFound) {
  // The line fills a T-joint, so that the mesh is closed.
  const glm::dvec3 a(0, 0, 0), b(2, 0, 0), c(0, 2, 0), d(0, 0, 2);
  const TriangleMesh mesh({a, b, c, d, 0.5 * (a + b)},
                          {{0, 2, 1}, {0, 4, 3}, {4, 1, 3}, {0, 1, 4}, {0, 3, 2}, {1, 2, 3}});
  ASSERT_TRUE(mesh.topology().isClosed() && mesh.topology().isOriented());
  EXPECT_EQ(checkMesh(mesh).total(FindingKind::DegenerateFaces).count, 1U);
}

/// Pairs of triangles without a common corner that meet, by rational arithmetic.
std::size_t meetingPairs(const TriangleMesh& mesh) {
  const auto corners = [&](const Triangle& t) {
    return std::array{mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]};
  };
  std::size_t count = 0;
  for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
    for (std::size_t j = i + 1; j < mesh.triangles().size(); ++j) {
      const Triangle &a = mesh.triangles()[i], &b = mesh.triangles()[j];
      const bool areJoined =
          std::ranges::any_of(a, [&](std::uint32_t v) { return std::ranges::count(b, v) > 0; });
      count += !areJoined && test::doMeetExactly(corners(a), corners(b)) ? 1 : 0;
    }
  }
  return count;
}

TEST(MeshCheck, CrossingBoxesMeetAsOftenAsTheOracleSays) {
  const glm::dquat turn = glm::normalize(glm::dquat{0.9, 0.1, -0.3, 0.2});
  const TriangleMesh boxes =
      joined(boxMesh({3, 4, 5}), test::transformed(boxMesh({3, 4, 5}), 1.0, {turn, {2.5, 0.5, 0.25}}));
  const std::size_t expected = meetingPairs(boxes);
  ASSERT_GT(expected, 0U);
  const MeshCheck check = checkMesh(boxes);
  EXPECT_EQ(check.total(FindingKind::SelfIntersections).count, expected);
  EXPECT_EQ(check.places(), check.total(FindingKind::SelfIntersections).places) << "there is nothing else";
  EXPECT_EQ(check.worst(), FindingSeverity::Note) << "solids that cross are felt as their union";
}

TEST(MeshCheck, LooseTrianglesMeetAsOftenAsTheOracleSays) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const TriangleMesh mesh = test::looseTriangles(seed, 60);
    const CrossingTriangles found = findCrossingTriangles(mesh, 10'000);
    EXPECT_TRUE(found.isComplete);
    EXPECT_EQ(found.pairs.size(), meetingPairs(mesh));
    EXPECT_TRUE(std::ranges::is_sorted(found.pairs));
  }
}

TEST(MeshCheck, AComponentThatCrossesItselfMattersForContact) {
  const MeshCheck check = checkMesh(test::figureOfEightMesh(0.5));
  const std::vector<MeshFinding> crossings = findingsOf(check, FindingKind::SelfIntersections);
  ASSERT_FALSE(crossings.empty());
  EXPECT_EQ(crossings[0].severity, FindingSeverity::Warning);
}

/// Needles along x and along y, all in one plane: each of one kind crosses each of the other.
TriangleMesh crossedNeedles(std::uint32_t count) {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double at = (i + 0.5) / count, width = 0.1 / count;
    for (const bool isAlongX : {true, false}) {
      const auto first = static_cast<std::uint32_t>(vertices.size());
      for (const glm::dvec2 p : {glm::dvec2(0, at), glm::dvec2(1, at), glm::dvec2(0, at + width)})
        vertices.emplace_back(isAlongX ? glm::dvec3(p.x, p.y, 0) : glm::dvec3(p.y, p.x, 0));
      triangles.push_back(isAlongX ? Triangle{first, first + 1, first + 2}
                                   : Triangle{first, first + 2, first + 1});
    }
  }
  return {std::move(vertices), std::move(triangles)};
}

TEST(MeshCheck, ManyIntersectionsAreCutOffAndThatIsSaid) {
  const TriangleMesh needles = crossedNeedles(2000);
  const MeshCheck check = checkMesh(needles);
  EXPECT_TRUE(check.total(FindingKind::SelfIntersections).isCut);
  EXPECT_EQ(check.total(FindingKind::SelfIntersections).count, MeshCheckOptions().maxIntersections);
  for (const MeshFinding& finding : check.findings) {
    EXPECT_LE(finding.triangles.size(), MeshFinding::kMaxShown);
    EXPECT_LE(finding.edges.size(), MeshFinding::kMaxShown);
  }
}

TEST(MeshCheck, OfManyPlacesTheLargestAreListedAndAllAreCounted) {
  TriangleMesh mesh = test::squareMesh(1.0, 2);
  std::vector<glm::dvec3> vertices = test::verticesOf(mesh);
  std::vector<Triangle> triangles = test::trianglesOf(mesh);
  for (std::uint32_t i = 0; i < 300; ++i) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const glm::dvec3 p : {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)})
      vertices.push_back(p + glm::dvec3(10.0 * (i + 1), 0, 0));
    triangles.push_back({first, first + 1, first + 2});
  }
  const MeshCheck check = checkMesh({std::move(vertices), std::move(triangles)});
  EXPECT_EQ(check.findings.size(), MeshCheck::kMaxPlaces);
  EXPECT_EQ(check.findings.front().count, 8U) << "the square";
  EXPECT_EQ(check.total(FindingKind::OpenEdges).places, 301U);
  EXPECT_EQ(check.total(FindingKind::OpenEdges).count, 908U);
}

TEST(MeshCheck, OpenEdgesOfFilesAreThoseCountedAnew) {
  const std::filesystem::path models = test::sharedFolder() / "models";
  for (const char* name :
       {"nasty/obj_nonmanifold_vierbein.obj", "nasty/obj_moebius.obj", "nasty/obj_wallhole.obj",
        "nasty/stl_motor_nonmanifold.stl", "nasty/stl_spider_degenerate.stl", "public/teapot_6320.obj",
        "public/peghole/factory_rectangular_hole_12mm_subdiv_3x.obj"}) {
    if (!std::filesystem::exists(models / name)) continue;
    MeshBuildOptions options;
    const TriangleMesh mesh = importMesh(models / name, options).mesh;
    std::uint64_t open = 0, nonManifold = 0;
    for (const auto& [edge, faces] : test::facesByEdge(mesh)) {
      open += faces == 1 ? 1 : 0;
      nonManifold += faces > 2 ? 1 : 0;
    }
    const MeshCheck check = checkMesh(mesh);
    EXPECT_EQ(check.total(FindingKind::OpenEdges).count, open) << name;
    EXPECT_EQ(check.total(FindingKind::NonManifoldEdges).count, nonManifold) << name;
    std::uint64_t listed = 0;
    for (const MeshFinding& loop : findingsOf(check, FindingKind::OpenEdges))
      listed += loop.count;
    const bool areAllListed = check.total(FindingKind::OpenEdges).places <= MeshCheck::kMaxPlaces;
    EXPECT_TRUE(!areAllListed || listed == open) << name << ": each edge is in one loop";
  }
}

TEST(MeshCheck, DegenerateMeshesAreCheckedToTheEnd) {
  const TriangleMesh star = test::starMesh(3, 1.0, 2, 0.4);
  for (const TriangleMesh& mesh :
       {test::withSlivers(star, 1e6, 0.0), test::withNeedles(star, 1e9, 0.1), test::withDuplicates(star),
        test::withFacesWithoutArea(star), test::jaggedFan(7, 500, 0.1), test::finsMesh(5, 40, 6.0),
        test::coplanarFans(2, 6), test::crossedApexMesh(), test::tornApart(star)}) {
    const MeshCheck first = checkMesh(mesh), second = checkMesh(mesh);
    EXPECT_EQ(first.findings.size(), second.findings.size());
    for (const MeshFinding& finding : first.findings) {
      EXPECT_GT(finding.count, 0U);
      EXPECT_FALSE(finding.box.isEmpty());
    }
  }
}

TEST(MeshCheck, IsCancelledAndReportsProgressUpToTheEnd) {
  const TriangleMesh mesh = test::icosphereMesh(1, 4);
  EXPECT_THROW(checkMesh(mesh, {}, [](double) { return false; }), Cancelled);
  double last = 0.0;
  checkMesh(mesh, {}, [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  });
  EXPECT_EQ(last, 1.0);
}

TEST(MeshCheck, AnInvalidToleranceIsRefused) {
  for (const double tolerance : {-1.0, std::nan(""), HUGE_VAL}) {
    MeshCheckOptions options;
    options.crackTolerance = tolerance;
    EXPECT_THROW(checkMesh(boxMesh({1, 1, 1}), options), UsageError);
  }
}

TEST(MeshCheck, WhatLoadingHasMendedIsNoDefectOfThePart) {
  MeshCheck check = checkMesh(boxMesh({1, 1, 1}));
  addMended(check, FindingKind::DuplicateFaces, 0, {});
  EXPECT_TRUE(check.findings.empty());
  addMended(check, FindingKind::DegenerateFaces, 7, {});
  ASSERT_EQ(check.findings.size(), 1U);
  EXPECT_FALSE(check.findings[0].hasPlace);
  EXPECT_EQ(check.total(FindingKind::DegenerateFaces).count, 7U);
  EXPECT_FALSE(check.worst());
  EXPECT_EQ(check.places(), 0U);
}

}  // namespace
}  // namespace nearfit::mesh_check_test
