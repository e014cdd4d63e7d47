#include "core/mesh/sampled_surface.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/mesh/shaded_mesh.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::sampled_surface_test {
namespace {

constexpr std::size_t kMany = 2'000'000;

double areaOfTriangles(std::span<const glm::dvec3> points, std::span<const Triangle> triangles) {
  double area = 0.0;
  for (const Triangle& t : triangles)
    area += 0.5 * glm::length(glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]));
  return area;
}

double longestSide(const SampledSurface& surface) {
  double longest = 0.0;
  for (const Triangle& t : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, glm::distance(surface.points[t[k]], surface.points[t[(k + 1) % 3]]));
  }
  return longest;
}

/// Sides by the places of their ends, with how often a triangle runs along them either way.
std::map<std::array<double, 6>, int> balanceOfSides(const SampledSurface& surface) {
  std::map<std::array<double, 6>, int> balance;
  for (const Triangle& t : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 &a = surface.points[t[k]], &b = surface.points[t[(k + 1) % 3]];
      std::array<double, 6> key{a.x, a.y, a.z, b.x, b.y, b.z};
      const std::array<double, 6> back{b.x, b.y, b.z, a.x, a.y, a.z};
      const bool isForward = key < back;
      balance[isForward ? key : back] += isForward ? 1 : -1;
    }
  }
  return balance;
}

TEST(SampledSurface, SidesOfABlockAreShortAndItsAreaStays) {
  const TriangleMesh block = test::boxMesh({0.04, 0.03, 0.02});
  const SampledSurface surface = sampleSurface(block, {0.002, kMany, {}});
  EXPECT_LE(longestSide(surface), 0.002);
  EXPECT_GT(longestSide(surface), 0.0009) << "no finer than asked for";
  const double area = 2.0 * (0.04 * 0.03 + 0.04 * 0.02 + 0.03 * 0.02);
  EXPECT_NEAR(areaOfTriangles(surface.points, surface.triangles), area, 1e-13);
  EXPECT_NEAR(std::accumulate(surface.areas.begin(), surface.areas.end(), 0.0), area, 1e-13);
  EXPECT_FALSE(surface.isCoarse);
  EXPECT_EQ(surface.firstOf.size(), 13U);
  EXPECT_EQ(surface.firstOf.back(), surface.triangles.size());
}

TEST(SampledSurface, NeighboursShareThePointsOfTheirSides) {
  for (const TriangleMesh& mesh :
       {test::boxMesh({1.0, 0.3, 0.2}), test::cylinderMesh(0.2, 2.0, 40), test::starMesh(5, 1.0, 1, 0.4),
        test::withSlivers(test::icosphereMesh(1.0, 0), 1e4, 0.1)}) {
    const SampledSurface surface = sampleSurface(mesh, {0.07, kMany, {}});
    EXPECT_LE(longestSide(surface), 0.07);
    for (const auto& [side, balance] : balanceOfSides(surface))
      ASSERT_EQ(balance, 0) << "a gap";
  }
}

TEST(SampledSurface, PiecesOfATriangleLieInItAndCoverIt) {
  const TriangleMesh mesh = test::starMesh(2, 1.0, 1, 0.4);
  const SampledSurface surface = sampleSurface(mesh, {0.05, kMany, {}});
  for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
    const auto pieces =
        std::span(surface.triangles).subspan(surface.firstOf[i], surface.firstOf[i + 1] - surface.firstOf[i]);
    const double whole = areaOfTriangles(mesh.vertices(), mesh.triangles().subspan(i, 1));
    EXPECT_NEAR(areaOfTriangles(surface.points, pieces), whole, 1e-13);
    const Triangle& t = mesh.triangles()[i];
    const glm::dvec3 a = mesh.vertices()[t[0]];
    const glm::dvec3 normal =
        glm::normalize(glm::cross(mesh.vertices()[t[1]] - a, mesh.vertices()[t[2]] - a));
    for (const Triangle& piece : pieces) {
      for (const std::uint32_t corner : piece)
        ASSERT_NEAR(glm::dot(surface.points[corner] - a, normal), 0.0, 1e-14);
    }
  }
}

TEST(SampledSurface, NormalsAreThoseThatAreDrawn) {
  // Smooth around, sharp at the rims: in the middle of a strip of the wall the normal points straight out.
  constexpr std::uint32_t kSegments = 24;
  const SampledSurface surface = sampleSurface(test::cylinderMesh(1.0, 1.0, kSegments), {0.05, kMany, {}});
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const glm::dvec3 p = surface.points[i], n = surface.normals[i];
    EXPECT_NEAR(glm::length(n), 1.0, 1e-6);
    const bool isCap = std::abs(n.z) > 0.5;
    if (isCap) {
      EXPECT_NEAR(std::abs(n.z), 1.0, 1e-6);
      continue;
    }
    const double out = glm::dot(glm::normalize(glm::dvec2(n)), glm::normalize(glm::dvec2(p)));
    // Normals at the rims lean by a third of half a facet, 0.044 rad; that of a facet is off by 0.13 at its sides.
    EXPECT_GT(out, std::cos(0.06)) << "interpolated, not that of the facet";
  }
}

TEST(SampledSurface, TooManySamplesMakeItCoarser) {
  const TriangleMesh block = test::boxMesh(glm::dvec3(1.0));
  const SampledSurface surface = sampleSurface(block, {1e-3, 20'000, {}});
  EXPECT_TRUE(surface.isCoarse);
  EXPECT_LE(surface.points.size(), 20'000U);
  EXPECT_GT(surface.points.size(), 4'000U) << "no coarser than needed";
  EXPECT_LE(longestSide(surface), surface.maxSide);
  const TriangleMesh ball = test::icosphereMesh(1.0, 3);
  const SampledSurface vertices = sampleSurface(ball, {1e-3, 10, {}});
  EXPECT_EQ(vertices.points.size(), ball.vertices().size()) << "vertices are always samples";
  EXPECT_EQ(vertices.triangles.size(), ball.triangles().size());
}

TEST(SampledSurface, OnlyWhatIsNearIsFine) {
  const TriangleMesh plate = test::squareMesh(10.0, 1);
  Aabb near;
  // In the middle of a triangle, away from its sides.
  near.add({1.4, -2.6, -0.1});
  near.add({1.6, -2.4, 0.1});
  const SampledSurface surface = sampleSurface(plate, {0.05, kMany, near});
  EXPECT_LT(surface.points.size(), 5'000U);
  std::size_t within = 0;
  for (const Triangle& t : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 &a = surface.points[t[k]], &b = surface.points[t[(k + 1) % 3]];
      const glm::dvec3 middle = 0.5 * (a + b);
      const bool isNear = std::abs(middle.x - 1.5) <= 0.1 && std::abs(middle.y + 2.5) <= 0.1;
      if (!isNear) continue;
      ++within;
      EXPECT_LE(glm::distance(a, b), 0.05);
    }
  }
  EXPECT_GT(within, 50U);
  for (const auto& [side, balance] : balanceOfSides(surface)) {
    const bool isRim = std::abs(std::abs(side[0] + side[3]) - 10.0) < 1e-9 ||
                       std::abs(std::abs(side[1] + side[4]) - 10.0) < 1e-9;
    ASSERT_TRUE(balance == 0 || isRim) << "a gap within the plate";
  }
}

TEST(SampledSurface, CancellingStopsIt) {
  EXPECT_THROW(sampleSurface(test::icosphereMesh(1.0, 4), {0.001, kMany, {}}, [](double) { return false; }),
               Cancelled);
}

}  // namespace
}  // namespace nearfit::sampled_surface_test
