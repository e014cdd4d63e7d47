#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/mesh/features.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"

/// Features that rounding would drop or keep wrongly, each for a reason of its own.
namespace nearfit::features_rounding_test {
namespace {

using Extended = glm::tvec3<long double>;

bool keepsEdge(const MeshFeatures& features, const TriangleMesh& mesh, std::uint32_t v0, std::uint32_t v1) {
  return std::ranges::any_of(features.edges, [&](const EdgeFeature& f) {
    const MeshEdge& e = mesh.edges()[f.edge];
    return e.v0 == v0 && e.v1 == v1;
  });
}

TEST(Features, EdgeOfASliverIsConvexOrReflexByItsShapeNotByRounding) {
  // A sliver a hundred million times as long as high, and a large face behind its long side, bent by a few
  // 1e-9: its side's perpendicular, and its normal, are off by as much in double precision.
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&] { return glm::dvec3{unit(random), unit(random), unit(random)}; };
  int convex = 0, reflex = 0;
  for (int i = 0; i < 400; ++i) {
    const glm::dvec3 a(0.0), b = vector(), c = 0.45 * b + 3e-8 * vector();
    const Extended e(b), w(c), height = w - e * (glm::dot(w, e) / glm::dot(e, e));
    if (glm::length(e) < 0.3L || glm::length(height) < 1e-8L) continue;
    const glm::dvec3 d = glm::dvec3(0.5L * e - glm::normalize(height)) + 1e-8 * vector();
    // Above the plane of the sliver a, b, c: reflex. To some 1e-11 in extended precision.
    const Extended x(d);
    const long double bend = glm::dot(glm::cross(e, w), x) / (glm::length(e) * glm::length(height));
    if (std::abs(bend) < 1e-10L) continue;
    const TriangleMesh mesh({a, b, c, d}, {{0, 1, 2}, {1, 0, 3}});
    EXPECT_EQ(keepsEdge(findFeatures(mesh), mesh, 0, 1), bend < 0.0L) << i << ", bend " << double(bend);
    (bend < 0.0L ? convex : reflex) += 1;
  }
  EXPECT_GT(convex, 100);
  EXPECT_GT(reflex, 100);
}

TEST(Features, VertexIsKeptHoweverFlatWhereItsPolarConeIsWiderThanTheTolerance) {
  // The search for the cone's middle used to stop at hulls within a ten-millionth of the origin.
  for (const double flat : {1e-3, 1e-6, 1e-7, 1e-8, 1e-9, 5e-10}) {
    for (const std::uint32_t segments : {3U, 5U, 8U, 100U}) {
      const TriangleMesh cone = test::coneMesh(1.0, flat, segments);
      const auto apex = static_cast<std::uint32_t>(cone.vertices().size() - 1);
      EXPECT_TRUE(std::ranges::any_of(findFeatures(cone).vertices, [&](auto& v) { return v.vertex == apex; }))
          << flat << ' ' << segments;
    }
    // The ends of a flat roof's ridge: a cone as wide as a quarter turn one way, and `flat` the other.
    const MeshFeatures roof = findFeatures(test::wedgeMesh(std::numbers::pi / 2 - flat));
    EXPECT_EQ(roof.vertices.size(), 6U) << flat;
  }
}

TEST(Features, WhatOnlyFacesWithoutAreaJoinIsNoFeature) {
  // A corner of the degenerate face, and its edges, used to count as a spike with half a sphere of
  // directions.
  const TriangleMesh box = test::boxMesh({1, 1, 1});
  const MeshFeatures plain = findFeatures(box);
  for (const VertexFeature& v : findFeatures(test::withFacesWithoutArea(box)).vertices)
    EXPECT_LT(v.vertex, box.vertices().size());
  EXPECT_EQ(findFeatures(test::withFacesWithoutArea(box)).faces.size(), plain.faces.size());
}

TEST(Features, SheetFoldedBackOnItselfKeepsItsCorners) {
  // Its pseudonormal is nothing but rounding, whose sign used to decide.
  const TriangleMesh flat({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                          {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {2, 1, 3}});
  EXPECT_EQ(findFeatures(flat).vertices.size(), 4U);
  for (int i = 1; i < 50; ++i) {
    const glm::dquat turn = glm::angleAxis(0.1 * i, glm::normalize(glm::dvec3(1, 2, 3)));
    EXPECT_EQ(findFeatures(test::transformed(flat, 1.0, {turn, {0.1, 0.2, 0.3}})).vertices.size(), 4U) << i;
  }
}

}  // namespace
}  // namespace nearfit::features_rounding_test
