#include "core/placing/feature_pick.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/placing/circle_fit.h"
#include "tests/support/degenerate_meshes.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/surface_hits.h"

namespace nearfit::feature_pick_test {
namespace {

constexpr double kPi = std::numbers::pi;

RigidTransform somePose(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<> in(-1.0, 1.0);
  return {glm::angleAxis(kPi * in(random), glm::normalize(glm::dvec3{in(random), in(random), 1.0})),
          glm::dvec3{in(random), in(random), in(random)}};
}

void expectParallel(const glm::dvec3& a, const glm::dvec3& b, double tolerance) {
  EXPECT_NEAR(glm::length(glm::cross(a, b)), 0.0, tolerance);
  EXPECT_NEAR(glm::length(a), 1.0, 1e-12);
}

/// A block with its four edges along z rounded by facets; `facets` a quarter turn.
TriangleMesh roundedBlock(double half, double radius, double height, int facets) {
  std::vector<glm::dvec2> outline;
  const glm::dvec2 middles[] = {{half - radius, half - radius},
                                {radius - half, half - radius},
                                {radius - half, radius - half},
                                {half - radius, radius - half}};
  for (int corner = 0; corner < 4; ++corner) {
    for (int i = 0; i <= facets; ++i) {
      const double angle = 0.5 * kPi * (corner + static_cast<double>(i) / facets);
      outline.push_back(middles[corner] + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
  }
  std::vector<glm::dvec3> vertices{{0, 0, 0}, {0, 0, height}};
  std::vector<Triangle> triangles;
  for (const glm::dvec2& p : outline) {
    vertices.emplace_back(p, 0.0);
    vertices.emplace_back(p, height);
  }
  const auto count = static_cast<std::uint32_t>(outline.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % count);
    triangles.insert(triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}, {0, b, a}, {1, a + 1, b + 1}});
  }
  return {std::move(vertices), std::move(triangles)};
}

TEST(FeaturePick, TheFlatFaceIsAllTrianglesInItsPlane) {
  const TriangleMesh mesh = test::subdivided(test::boxMesh({0.2, 0.1, 0.05}), 3);
  const auto picked = pickFeature(mesh, test::hitBy(mesh, {0.03, 0.01, 1.0}, {0.03, 0.01, 0.0}), 0.001);
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->feature.shape, FeatureShape::Plane);
  EXPECT_NEAR(glm::distance(picked->feature.direction, glm::dvec3(0, 0, 1)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(picked->feature.point, glm::dvec3(0, 0, 0.025)), 0.0, 1e-12);
  EXPECT_EQ(picked->triangles.size(), 2U * 64U);
}

TEST(FeaturePick, CornersAndEdgesAreMeantWithinReach) {
  const TriangleMesh mesh = test::subdivided(test::boxMesh(glm::dvec3(0.1)), 2);
  const auto at = [&](double x, double y) {
    return pickFeature(mesh, test::hitBy(mesh, {x, y, 1.0}, {x, y, 0.0}), 0.003);
  };
  const auto corner = at(0.0485, 0.0485);
  ASSERT_TRUE(corner);
  EXPECT_EQ(corner->feature.shape, FeatureShape::Point);
  EXPECT_NEAR(glm::distance(corner->feature.point, glm::dvec3(0.05)), 0.0, 1e-15);
  const auto edge = at(0.0485, 0.01);
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->feature.shape, FeatureShape::Axis);
  EXPECT_EQ(edge->feature.radius, 0.0);
  expectParallel(edge->feature.direction, {0, 1, 0}, 1e-12);
  EXPECT_NEAR(glm::distance(edge->feature.point, glm::dvec3(0.05, 0.0, 0.05)), 0.0, 1e-15);
  EXPECT_EQ(edge->vertices.size(), 5U);
  // Corners of the subdivision are none of the shape.
  EXPECT_EQ(at(0.0251, 0.0251)->feature.shape, FeatureShape::Plane);
}

TEST(FeaturePick, CylindersAndBoresHaveTheirAxisAtAnyPoseInSinglePrecision) {
  for (const std::uint32_t segments : {12U, 24U, 100U, 360U}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const RigidTransform pose = somePose(seed);
      const TriangleMesh plain = test::transformed(test::tubeMesh(0.02, 0.04, 0.1, segments), 1.0, pose);
      const TriangleMesh mesh = test::inSinglePrecision(plain);
      // Off the middle of a facet, off its diagonal.
      const double angle = 2.0 * kPi * 0.3 / segments;
      const glm::dvec3 aside(std::cos(angle), std::sin(angle), 0.0);
      for (const double radius : {0.04, 0.02}) {
        const glm::dvec3 from =
            pose.applyToPoint((radius == 0.04 ? 1.0 : 0.0) * aside + glm::dvec3(0, 0, 0.013));
        const glm::dvec3 towards = pose.applyToPoint(0.03 * aside + glm::dvec3(0, 0, 0.013));
        const auto picked = pickFeature(mesh, test::hitBy(mesh, from, towards), 1e-5);
        ASSERT_TRUE(picked);
        ASSERT_EQ(picked->feature.shape, FeatureShape::Axis) << segments << ' ' << seed << ' ' << radius;
        EXPECT_EQ(picked->triangles.size(), 2U * segments) << radius;
        EXPECT_NEAR(picked->feature.radius, radius, 1e-6);
        expectParallel(picked->feature.direction, pose.applyToVector({0, 0, 1}), 2e-5);
        EXPECT_NEAR(glm::distance(picked->feature.point, pose.translation), 0.0, 2e-6);
      }
    }
  }
}

TEST(FeaturePick, RoundEdgesAreCircles) {
  const RigidTransform pose = somePose(9);
  const TriangleMesh mesh =
      test::inSinglePrecision(test::transformed(test::cylinderMesh(0.03, 0.08, 48), 1.0, pose));
  const glm::dvec3 above = pose.applyToPoint({0.029, 0.001, 0.2}),
                   below = pose.applyToPoint({0.029, 0.001, 0.0});
  const SurfaceHit hit = test::hitBy(mesh, above, below);
  const auto picked = pickFeature(mesh, hit, 0.002, FeatureFilter::Axes);
  ASSERT_TRUE(picked);
  ASSERT_EQ(picked->feature.shape, FeatureShape::Circle);
  EXPECT_NEAR(picked->feature.radius, 0.03, 1e-6);
  expectParallel(picked->feature.direction, pose.applyToVector({0, 0, 1}), 1e-5);
  EXPECT_NEAR(glm::distance(picked->feature.point, pose.applyToPoint({0, 0, 0.04})), 0.0, 1e-6);
  EXPECT_EQ(picked->vertices.size(), 49U);
  EXPECT_EQ(picked->vertices.front(), picked->vertices.back());
  // Its centre, where points are looked for.
  const auto centre = pickFeature(mesh, hit, 0.002, FeatureFilter::Points);
  ASSERT_TRUE(centre);
  EXPECT_EQ(centre->feature.shape, FeatureShape::Point);
  EXPECT_NEAR(glm::distance(centre->feature.point, pose.applyToPoint({0, 0, 0.04})), 0.0, 1e-6);
}

TEST(FeaturePick, FacesBetweenRoundingsAreFlatAndRoundingsAreRound) {
  const TriangleMesh mesh = roundedBlock(0.05, 0.01, 0.04, 8);
  const auto side = pickFeature(mesh, test::hitBy(mesh, {1.0, 0.005, 0.02}, {0.0, 0.005, 0.02}), 1e-5);
  ASSERT_TRUE(side);
  EXPECT_EQ(side->feature.shape, FeatureShape::Plane);
  EXPECT_EQ(side->triangles.size(), 2U);
  const auto fillet = pickFeature(mesh, test::hitBy(mesh, {1.0, 0.99, 0.015}, {0.0, 0.0, 0.015}), 1e-5);
  ASSERT_TRUE(fillet);
  ASSERT_EQ(fillet->feature.shape, FeatureShape::Axis);
  EXPECT_NEAR(fillet->feature.radius, 0.01, 1e-9);
  EXPECT_EQ(fillet->triangles.size(), 16U);
  EXPECT_NEAR(glm::distance(fillet->feature.point, glm::dvec3(0.04, 0.04, 0.02)), 0.0, 1e-9);
  // The arc of its edge is one too.
  const auto arc = pickFeature(mesh, test::hitBy(mesh, {0.0465, 0.0465, 1.0}, {0.0465, 0.0465, 0.0}), 0.001);
  ASSERT_TRUE(arc);
  EXPECT_EQ(arc->feature.shape, FeatureShape::Circle);
  EXPECT_NEAR(arc->feature.radius, 0.01, 1e-9);
}

TEST(FeaturePick, AHexagonHasSixFacesAndNoAxis) {
  const TriangleMesh mesh = test::cylinderMesh(0.03, 0.08, 6);
  const auto picked = pickFeature(mesh, test::hitBy(mesh, {1.0, 0.2, 0.001}, {0.0, 0.0, 0.0}), 1e-4);
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->feature.shape, FeatureShape::Plane);
  EXPECT_EQ(picked->triangles.size(), 2U);
}

TEST(FeaturePick, FiltersGiveWhatTheySay) {
  const TriangleMesh mesh = test::cylinderMesh(0.03, 0.08, 48);
  const SurfaceHit side = test::hitBy(mesh, {1.0, 0.01, 0.001}, {0.0, 0.0, 0.0});
  EXPECT_EQ(pickFeature(mesh, side, 1e-4, FeatureFilter::Faces)->feature.shape, FeatureShape::Plane);
  EXPECT_EQ(pickFeature(mesh, side, 1e-4, FeatureFilter::Axes)->feature.shape, FeatureShape::Axis);
  const auto point = pickFeature(mesh, side, 1e-4, FeatureFilter::Points);
  EXPECT_EQ(point->feature.shape, FeatureShape::Point);
  EXPECT_EQ(point->feature.point, side.point);
  const SurfaceHit cap = test::hitBy(mesh, {0.01, 0.003, 1.0}, {0.01, 0.003, 0.0});
  EXPECT_FALSE(pickFeature(mesh, cap, 1e-4, FeatureFilter::Axes));
}

TEST(FeaturePick, ABallHasNoCylinder) {
  const TriangleMesh mesh = test::icosphereMesh(0.05, 3);
  const auto picked = pickFeature(mesh, test::hitBy(mesh, {1.0, 0.12, 0.33}, {0.0, 0.0, 0.0}), 1e-4);
  ASSERT_TRUE(picked);
  EXPECT_EQ(picked->feature.shape, FeatureShape::Plane);
}

TEST(FeaturePick, EveryTriangleOfDamagedMeshesHasAnAnswer) {
  for (const TriangleMesh& mesh :
       {test::starMesh(5, 0.1, 2, 0.5), test::squareMesh(0.1, 4),
        test::joined(test::boxMesh(glm::dvec3(0.1)), test::boxMesh(glm::dvec3(0.1)))}) {
    for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t) {
      const Triangle& c = mesh.triangles()[t];
      const glm::dvec3 middle = (mesh.vertices()[c[0]] + mesh.vertices()[c[1]] + mesh.vertices()[c[2]]) / 3.0;
      for (const FeatureFilter filter :
           {FeatureFilter::Any, FeatureFilter::Faces, FeatureFilter::Axes, FeatureFilter::Points}) {
        const auto picked = pickFeature(mesh, {t, middle}, 0.01, filter);
        if (!picked) continue;
        EXPECT_TRUE(std::isfinite(glm::length(picked->feature.point)));
        const double length = glm::length(picked->feature.direction);
        EXPECT_NEAR(length, picked->feature.shape == FeatureShape::Point ? 0.0 : 1.0, 1e-9);
      }
    }
  }
}

TEST(CircleFit, PointsOnACircleGiveIt) {
  const RigidTransform pose = somePose(3);
  std::vector<glm::dvec3> points;
  for (const double angle : {0.1, 0.4, 0.5, 1.1})
    points.push_back(pose.applyToPoint({0.7 * std::cos(angle), 0.7 * std::sin(angle), 0.0}));
  const auto circle = fitCircle(points);
  ASSERT_TRUE(circle);
  EXPECT_NEAR(circle->radius, 0.7, 1e-9);
  EXPECT_NEAR(glm::distance(circle->centre, pose.translation), 0.0, 1e-9);
  expectParallel(circle->axis, pose.applyToVector({0, 0, 1}), 1e-9);
  const std::vector<glm::dvec3> row = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_FALSE(fitCircle(row));
}

}  // namespace
}  // namespace nearfit::feature_pick_test
