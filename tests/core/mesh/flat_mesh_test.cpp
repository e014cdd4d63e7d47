// Merged flats: that the surface stays where it was, that meshes stay whole, and that minima do not depend on how
// finely flats are cut.
#include "core/mesh/flat_mesh.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <random>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/exact/outline_fill.h"
#include "core/import/mesh_import.h"
#include "core/mesh/coordinate_rounding.h"
#include "core/mesh/features.h"
#include "core/mesh/mass_properties.h"
#include "tests/support/lmd_comparison.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/places.h"
#include "tests/support/trial_share.h"

namespace nearfit::flat_mesh_test {
namespace {

using std::numbers::pi;
using Loop = std::vector<glm::dvec2>;

const RigidTransform kAskew{glm::normalize(glm::dquat(0.3, 0.5, -0.2, 0.7)), {0.1, -0.2, 0.3}};

Loop ring(double radius, std::uint32_t corners, const glm::dvec2& centre = glm::dvec2(0.0)) {
  Loop loop;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2.0 * pi * i / corners;
    loop.push_back(centre + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  return loop;
}

/// A prism about the middle of z whose outline is loops, holes and rims alike. Loops may share corners.
TriangleMesh prism(const std::vector<Loop>& loops, double height) {
  std::vector<glm::dvec2> points;
  std::vector<std::array<std::uint32_t, 2>> sides;
  const auto number = [&](const glm::dvec2& p) {
    const auto at = std::ranges::find(points, p);
    if (at == points.end()) points.push_back(p);
    return static_cast<std::uint32_t>(std::ranges::find(points, p) - points.begin());
  };
  for (const Loop& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i)
      sides.push_back({number(loop[i]), number(loop[(i + 1) % loop.size()])});
  }
  const FilledOutline filled = fillOutline(points, sides, FillRule::Odd);
  const auto count = static_cast<std::uint32_t>(points.size());
  std::vector<glm::dvec3> vertices;
  for (const double z : {-0.5 * height, 0.5 * height}) {
    for (const glm::dvec2& p : points)
      vertices.emplace_back(p, z);
  }
  std::vector<Triangle> triangles;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  for (const auto& t : filled.triangles) {
    std::array<std::uint32_t, 3> c{};
    for (std::size_t k = 0; k < 3; ++k)
      c[k] = number(filled.points[t[k]]);
    triangles.push_back({c[0], c[2], c[1]});
    triangles.push_back({c[0] + count, c[1] + count, c[2] + count});
    for (std::size_t k = 0; k < 3; ++k)
      ++directed[{c[k], c[(k + 1) % 3]}];
  }
  // Sides that one triangle of the cap has are walls, whichever way their loop runs.
  for (const auto& [side, times] : directed) {
    const auto [a, b] = side;
    if (directed.contains({b, a})) continue;
    triangles.push_back({a, b, b + count});
    triangles.push_back({a, b + count, a + count});
  }
  return {std::move(vertices), std::move(triangles)};
}

TriangleMesh roundedToSingle(const TriangleMesh& mesh) {
  std::vector<glm::dvec3> x;
  for (const glm::dvec3& p : mesh.vertices())
    x.emplace_back(glm::vec3(p));
  return {std::move(x), {mesh.triangles().begin(), mesh.triangles().end()}};
}

double distanceFromTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                            const glm::dvec3& c) {
  const auto fromSegment = [&](const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 way = to - from;
    const double square = glm::dot(way, way);
    const double s = square > 0.0 ? std::clamp(glm::dot(p - from, way) / square, 0.0, 1.0) : 0.0;
    return glm::distance(p, from + s * way);
  };
  double least = std::min({fromSegment(a, b), fromSegment(b, c), fromSegment(c, a)});
  const glm::dvec3 n = glm::cross(b - a, c - a);
  const double length = glm::length(n);
  if (!(length > 0.0)) return least;
  const auto isInside = [&](const glm::dvec3& from, const glm::dvec3& to) {
    return glm::dot(glm::cross(to - from, p - from), n) >= 0.0;
  };
  if (isInside(a, b) && isInside(b, c) && isInside(c, a))
    least = std::min(least, std::abs(glm::dot(p - a, n)) / length);
  return least;
}

/// How far random points of one surface, and its vertices, are from the other, by brute force.
double farthestFrom(const TriangleMesh& from, const TriangleMesh& to, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  double most = 0.0;
  const auto look = [&](const glm::dvec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& t : to.triangles())
      least = std::min(
          least, distanceFromTriangle(p, to.vertices()[t[0]], to.vertices()[t[1]], to.vertices()[t[2]]));
    most = std::max(most, least);
  };
  for (const Triangle& t : from.triangles()) {
    const auto x = from.vertices();
    look(x[t[0]]);
    const double u = uniform(random), v = (1.0 - u) * uniform(random);
    look(x[t[0]] + u * (x[t[1]] - x[t[0]]) + v * (x[t[2]] - x[t[0]]));
  }
  return most;
}

void expectSameSurface(const TriangleMesh& mesh, const FlatMesh& merged) {
  // Of the brute force's own rounding.
  const double rounding = 1e-14 * mesh.bounds().diagonal();
  EXPECT_LE(farthestFrom(mesh, merged.mesh, 1), merged.deviation + rounding);
  EXPECT_LE(farthestFrom(merged.mesh, mesh, 2), merged.deviation + rounding);
}

/// Solids with flats that are not convex, have holes, slivers, or touch themselves at a point.
struct Solid {
  const char* name;
  TriangleMesh mesh;
};
std::vector<Solid> solids() {
  const Loop ell{{0, 0}, {0.6, 0}, {0.6, 0.2}, {0.2, 0.2}, {0.2, 0.7}, {0, 0.7}};
  const Loop square{{-0.5, -0.4}, {0.5, -0.4}, {0.5, 0.4}, {-0.5, 0.4}};
  const Loop needle{{0, 0}, {1.0, 0}, {1.0, 1e-3}, {0.5, 2e-3}, {0.0, 1.5e-3}};
  Loop comb;
  for (int i = 0; i < 6; ++i) {
    comb.emplace_back(0.1 * i, 0.3);
    comb.emplace_back(0.1 * i + 0.05, 0.3);
    comb.emplace_back(0.1 * i + 0.05, 0.1);
    comb.emplace_back(0.1 * i + 0.1, 0.1);
  }
  comb.emplace_back(0.6, 0.0);
  comb.emplace_back(0.0, 0.0);
  std::ranges::reverse(comb);
  // A square hole whose corner is on the rim.
  const Loop touching{{-0.5, -0.4}, {-0.3, -0.3}, {-0.2, -0.1}, {-0.4, -0.2}};
  return {{"box", test::boxMesh({0.4, 0.3, 0.2})},
          {"ell", prism({ell}, 0.3)},
          {"plate with holes", prism({square, ring(0.15, 24, {-0.2, 0.1}), ring(0.1, 5, {0.3, -0.1})}, 0.1)},
          {"needle", prism({needle}, 0.2)},
          {"comb", prism({comb}, 0.15)},
          {"hole at its rim", prism({square, touching}, 0.2)}};
}

TEST(FlatMesh, CutsFlatsIntoAsFewTrianglesAsTheirOutlinesNeed) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const FeatureCounts coarse = NormalConeTree(solid.mesh).keptFeatures();
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const TriangleMesh fine = test::transformed(test::cutUnevenly(solid.mesh, 400, seed), 1.0, kAskew);
      const FlatMesh merged = mergeFlats(fine, 0.0);
      EXPECT_EQ(merged.mesh.triangles().size(), solid.mesh.triangles().size());
      const FeatureCounts kept = NormalConeTree(merged).keptFeatures();
      EXPECT_EQ(kept.vertices, coarse.vertices);
      EXPECT_EQ(kept.edges, coarse.edges);
      EXPECT_EQ(merged.mesh.topology().openEdges, solid.mesh.topology().openEdges);
      EXPECT_EQ(merged.mesh.topology().nonManifoldEdges, solid.mesh.topology().nonManifoldEdges);
      EXPECT_TRUE(merged.mesh.topology().isOriented());
      EXPECT_LT(merged.deviation, 1e-12);
      expectSameSurface(fine, merged);
    }
  }
}

TEST(FlatMesh, WhatSinglePrecisionRoundedIsFlatAgain) {
  for (const Solid& solid : solids()) {
    SCOPED_TRACE(solid.name);
    // Twenty cuts on a needle of a thousandth are as fine as its coordinates are rounded.
    const bool isThin = std::string(solid.name) == "needle";
    const TriangleMesh fine =
        roundedToSingle(test::transformed(test::cutUnevenly(solid.mesh, isThin ? 20 : 400, 4), 1.0, kAskew));
    const double rounding = coordinateRounding(fine.vertices());
    EXPECT_NEAR(rounding, 0.5 * std::numeric_limits<float>::epsilon(), rounding) << "that of a float near 1";
    const FlatMesh merged = mergeFlats(fine, rounding);
    EXPECT_LE(merged.mesh.triangles().size(), solid.mesh.triangles().size() + (isThin ? 40U : 8U));
    EXPECT_LT(merged.deviation, 1e-6 * fine.bounds().diagonal());
    EXPECT_TRUE(merged.mesh.topology().isOriented());
    EXPECT_EQ(merged.mesh.topology().openEdges, fine.topology().openEdges);
    expectSameSurface(fine, merged);
  }
}

TEST(FlatMesh, MinimaDoNotDependOnHowFinelyFlatsAreCut) {
  const std::vector<Solid> all = solids();
  std::mt19937_64 random(9);
  std::size_t compared = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Solid &a = all[i], &b = all[(i + 1) % all.size()];
    const test::BodyPair pair{a.name, a.mesh, b.mesh};
    const NormalConeTree coarseA(a.mesh), coarseB(b.mesh);
    const NormalConeTree fineA(mergeFlats(test::cutUnevenly(a.mesh, 300, 5), 0.0));
    const NormalConeTree fineB(mergeFlats(test::cutUnevenly(b.mesh, 300, 6), 0.0));
    for (int k = 0; k < 60; ++k) {
      const RigidTransform pose = k % 2 == 0 ? test::poseNearContact(pair, 0.1, random)
                                             : test::poseWithParallelFaces(pair, 0.1, 0.0, random);
      std::vector<Lmd> coarse = test::allLmds(coarseA, coarseB, pose, 0.1);
      std::vector<Lmd> fine = test::allLmds(fineA, fineB, pose, 0.1);
      ASSERT_EQ(fine.size(), coarse.size()) << a.name << " and " << b.name << ", pose " << k;
      for (const Lmd& lmd : coarse) {
        const bool isThere = std::ranges::any_of(fine, [&](const Lmd& other) {
          return std::abs(other.distance - lmd.distance) < 1e-11 &&
                 glm::distance(other.scenePoint, lmd.scenePoint) < 1e-9 && other.isRegion == lmd.isRegion;
        });
        EXPECT_TRUE(isThere) << a.name << " and " << b.name << ", pose " << k << ", distance "
                             << lmd.distance;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 300U);
}

TEST(FlatMesh, MergedMeshesHaveTheMinimaOfBruteForce) {
  const std::vector<Solid> all = solids();
  std::size_t minima = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Solid& b = all[(i + 2) % all.size()];
    const test::BodyPair pair{all[i].name, mergeFlats(test::cutUnevenly(all[i].mesh, 200, 7), 0.0).mesh,
                              mergeFlats(test::cutUnevenly(b.mesh, 200, 8), 0.0).mesh};
    minima += test::compareWithOracle(pair, 40 / test::kTrialShare, 0.1, 11).minima;
  }
  EXPECT_GT(minima, 30 / test::kTrialShare);
}

TEST(FlatMesh, CurvedMeshesStayAsTheyAre) {
  for (const TriangleMesh& mesh : {test::icosphereMesh(1.0, 4), test::starMesh(1, 1.0, 3, 0.3)}) {
    const FlatMesh merged = mergeFlats(mesh, 0.0);
    EXPECT_EQ(merged.mesh.vertices().data(), mesh.vertices().data());
    EXPECT_EQ(merged.deviation, 0.0);
  }
}

TEST(FlatMesh, OpenSheetsKeepTheirRims) {
  const TriangleMesh fine =
      test::transformed(test::cutUnevenly(test::squareMesh(1.0, 3), 300, 3), 1.0, kAskew);
  const FlatMesh merged = mergeFlats(fine, 0.0);
  EXPECT_EQ(merged.mesh.triangles().size(), 2U);
  EXPECT_EQ(merged.mesh.topology().openEdges, 4U);
  expectSameSurface(fine, merged);
}

/// It has no defect that it did not have, and no other volume.
void expectWhole(const TriangleMesh& mesh, double rounding) {
  const FlatMesh merged = mergeFlats(mesh, rounding);
  EXPECT_LE(merged.mesh.triangles().size(), mesh.triangles().size());
  EXPECT_LE(merged.mesh.topology().openEdges, mesh.topology().openEdges);
  EXPECT_LE(merged.mesh.topology().nonManifoldEdges, mesh.topology().nonManifoldEdges);
  EXPECT_LE(merged.mesh.topology().inconsistentEdges, mesh.topology().inconsistentEdges);
  const double size = mesh.bounds().diagonal();
  EXPECT_LE(merged.deviation, 1e-5 * size);
  if (!mesh.topology().isClosed() || !mesh.topology().isOriented()) return;
  EXPECT_NEAR(massProperties(merged.mesh).volume, massProperties(mesh).volume,
              6.0 * merged.deviation * size * size + 1e-12 * size * size * size);
}

TEST(FlatMesh, GeneratedMeshesStayWhole) {
  const TriangleMesh box = test::subdivided(test::boxMesh({1, 2, 3}), 2);
  for (const TriangleMesh& mesh :
       {box, test::turned(box), test::joined(box, test::transformed(box, 0.5, kAskew)),
        test::squareMesh(1.0, 9), test::torusMesh(2.0, 0.5, 40, 12), test::bowlMesh(1.0, 1.2, 16, 6),
        test::tubeMesh(0.2, 0.3, 1.0, 24), test::coneMesh(1.0, 2.0, 30), test::starMesh(2, 1.0, 3, 0.3)}) {
    expectWhole(mesh, 0.0);
    const TriangleMesh rounded = roundedToSingle(test::transformed(mesh, 1.0, kAskew));
    expectWhole(rounded, coordinateRounding(rounded.vertices()));
  }
}

// Real meshes, drawn by many programs, where they are there.
TEST(FlatMesh, RealMeshesStayWhole) {
  const std::filesystem::path models = test::sharedFolder() / "models";
  if (!std::filesystem::is_directory(models)) return;
  std::size_t meshes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(models)) {
    const std::string kind = entry.path().extension().string();
    const bool isMesh =
        kind == ".stl" || kind == ".STL" || kind == ".obj" || kind == ".off" || kind == ".ply";
    if (!entry.is_regular_file() || !isMesh || entry.file_size() > 3'000'000 / test::kTrialShare) continue;
    ImportedMesh imported;
    try {
      imported = importMesh(entry.path(), {});
    } catch (const std::exception&) {
      continue;  // Refused, as the tests of import say.
    }
    SCOPED_TRACE(entry.path().filename().string());
    expectWhole(imported.mesh, imported.report.coordinateRounding);
    ++meshes;
  }
  EXPECT_GT(meshes, 20U);
}

TEST(CoordinateRounding, IsReadFromTheNumbers) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-7.0, 7.0);
  std::vector<glm::dvec3> full, single, sixDigits;
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 p(uniform(random), uniform(random), uniform(random));
    full.push_back(p);
    single.emplace_back(glm::vec3(p));
    sixDigits.push_back(glm::round(p * 1e5) / 1e5);
  }
  EXPECT_NEAR(coordinateRounding(full), 7.0 * 0x1p-53, 0x1p-53);
  EXPECT_NEAR(coordinateRounding(single), 7.0 * 0x1p-24, 0x1p-24);
  EXPECT_NEAR(coordinateRounding(sixDigits), 0.5e-5, 1e-12);
  EXPECT_EQ(coordinateRounding({}), 0.0);
  EXPECT_EQ(coordinateRounding(std::vector{glm::dvec3(std::nan(""))}), 0.0);
}

}  // namespace
}  // namespace nearfit::flat_mesh_test
