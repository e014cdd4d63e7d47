#include "core/placing/measure.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/placing/feature_pick.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/random_values.h"

namespace nearfit::measure_test {
namespace {

constexpr double kPi = std::numbers::pi;

MeasureEnd plane(const glm::dvec3& point, const glm::dvec3& normal, const glm::dvec3& clicked) {
  return {clicked, {FeatureShape::Plane, point, glm::normalize(normal)}};
}
MeasureEnd axis(const glm::dvec3& point, const glm::dvec3& along, const glm::dvec3& clicked) {
  return {clicked, {FeatureShape::Axis, point, glm::normalize(along)}};
}
MeasureEnd point(const glm::dvec3& at) {
  return {at, {FeatureShape::Point, at}};
}

TEST(Measure, TwoPointsAreAsFarApartAsPythagorasSays) {
  const Measurement m = measure(point({0.001, 0.002, 0.003}), point({0.003, 0.005, 0.009}));
  EXPECT_NEAR(m.distance, 0.007, 1e-15);
  EXPECT_EQ(m.from, glm::dvec3(0.001, 0.002, 0.003));
  EXPECT_EQ(m.to, glm::dvec3(0.003, 0.005, 0.009));
  EXPECT_FALSE(m.apart);
  EXPECT_FALSE(m.angle);
}

TEST(Measure, ParallelFacesAreApartSquareToThemWhereverTheyAreClicked) {
  const Measurement m = measure(plane({0.1, 0, 0.02}, {0, 0, 1}, {0.3, 0.4, 0.02}),
                                plane({-0.2, 0, 0.05}, {0, 0, -1}, {-0.3, -0.4, 0.05}));
  EXPECT_NEAR(m.apart.value(), 0.03, 1e-15);
  EXPECT_NEAR(m.angle.value(), 0.0, 1e-15);
  EXPECT_NEAR(m.distance, 0.03, 1e-15) << "the engineer's answer";
  EXPECT_LT(glm::distance(m.to, glm::dvec3(0.3, 0.4, 0.05)), 1e-15);
  EXPECT_NEAR(m.pointToPoint.value(), std::sqrt(0.36 + 0.64 + 0.0009), 1e-15);
}

TEST(Measure, FacesThatPointTowardsEachOtherHaveAGapWithASign) {
  const MeasureEnd top = plane({}, {0, 0, 1}, {});
  const auto gapTo = [&](double height, double sense) {
    return measure(top, plane({0.5, 0, height}, {0, 0, sense}, {0.5, 0.1, height})).gap;
  };
  EXPECT_NEAR(gapTo(0.002, -1.0).value(), 0.002, 1e-15);
  EXPECT_NEAR(gapTo(0.0, -1.0).value(), 0.0, kTouchingGap);
  EXPECT_NEAR(gapTo(-0.001, -1.0).value(), -0.001, 1e-15);
  EXPECT_FALSE(gapTo(0.002, 1.0)) << "both look the same way";
  EXPECT_FALSE(measure(top, point({0, 0, 1})).gap);
}

TEST(Measure, FacesThatMeetHaveAnAngleOnly) {
  const Measurement m = measure(plane({}, {0, 0, 1}, {}), plane({}, {0, std::sin(0.5), -std::cos(0.5)}, {}));
  EXPECT_NEAR(m.angle.value(), 0.5, 1e-15);
  EXPECT_FALSE(m.apart);
}

TEST(Measure, ParallelEdgesAreAsFarApartAsTheirLines) {
  const Measurement m =
      measure(axis({0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}), axis({7, 0.3, 0.4}, {-1, 0, 0}, {7, 0.3, 0.4}));
  EXPECT_NEAR(m.apart.value(), 0.5, 1e-15);
  EXPECT_NEAR(m.angle.value(), 0.0, 1e-15);
}

TEST(Measure, AnAxisThatRunsAlongAFaceIsApartFromIt) {
  const MeasureEnd face = plane({}, {0, 0, 1}, {}), along = axis({1, 1, 0.2}, {1, 2, 0}, {1, 1, 0.2});
  for (const Measurement& m : {measure(face, along), measure(along, face)}) {
    EXPECT_NEAR(m.apart.value(), 0.2, 1e-15);
    EXPECT_NEAR(m.angle.value(), 0.0, 1e-15);
  }
  const Measurement square = measure(face, axis({1, 1, 0.2}, {0, 0, -1}, {1, 1, 0.2}));
  EXPECT_NEAR(square.angle.value(), 0.5 * kPi, 1e-15);
  EXPECT_FALSE(square.apart);
}

TEST(Measure, ParallelAxesAreMeasuredBetweenTheirCentresWhereverTheirWallsAreClicked) {
  // Clicked on the walls of bores of 5 mm radius, 4 mm along from each other.
  const Measurement m = measure(axis({0, 0, 0.1}, {0, 0, 1}, {0.005, 0, 0.02}),
                                axis({0.06, 0, -3}, {0, 0, -1}, {0.06, 0.005, 0.024}));
  EXPECT_NEAR(m.distance, 0.06, 1e-15);
  EXPECT_NEAR(m.apart.value(), 0.06, 1e-15);
  EXPECT_LT(glm::distance(m.from, glm::dvec3(0, 0, 0.02)), 1e-15);
  EXPECT_LT(glm::distance(m.to, glm::dvec3(0.06, 0, 0.02)), 1e-15);
  EXPECT_NEAR(m.pointToPoint.value(), std::sqrt(0.055 * 0.055 + 0.005 * 0.005 + 0.004 * 0.004), 1e-15);
}

TEST(Measure, AnEdgeAlongAFaceIsMeasuredSquareToIt) {
  const MeasureEnd face = plane({0, 0, 0.1}, {0, 0, 1}, {3, 4, 0.1}),
                   edge = axis({1, 1, 0.3}, {1, 0, 0}, {2, 1, 0.3});
  const glm::dvec3 onEdge(2, 1, 0.3), below(2, 1, 0.1);
  const Measurement down = measure(edge, face), up = measure(face, edge);
  for (const Measurement& m : {down, up}) {
    EXPECT_NEAR(m.distance, 0.2, 1e-15);
    EXPECT_NEAR(m.pointToPoint.value(), std::sqrt(1.0 + 9.0 + 0.04), 1e-14);
  }
  EXPECT_LT(glm::distance(down.from, onEdge) + glm::distance(down.to, below), 1e-15);
  EXPECT_LT(glm::distance(up.from, below) + glm::distance(up.to, onEdge), 1e-15);
  EXPECT_NEAR(measure(axis({0, 0, 0.1}, {1, 1, 0}, {5, 5, 0.1}), face).distance, 0.0, 1e-15) << "in the face";
}

TEST(Measure, ACentreAndAnAxisAcrossAreMeasuredBetweenTheirPoints) {
  const Measurement skew =
      measure(axis({}, {1, 0, 0}, {0.3, 0, 0}), axis({0, 0, 0.4}, {0, 1, 0}, {0, 0, 0.4}));
  EXPECT_NEAR(skew.distance, 0.5, 1e-15);
  EXPECT_FALSE(skew.pointToPoint);
  const MeasureEnd low{{}, {FeatureShape::Circle, {}, {0, 0, 1}, 0.01}},
      high{{0, 0, 0.3}, {FeatureShape::Circle, {0, 0, 0.3}, {0, 0, 1}, 0.01}};
  EXPECT_NEAR(measure(low, high).distance, 0.3, 1e-15);
  EXPECT_FALSE(measure(low, high).pointToPoint);
}

/// The distance was that to the click, 26.009 mm instead of 26.
TEST(Measure, ACentreBesideAnEdgeIsMeasuredSquareToItWhereverItIsClicked) {
  const glm::dvec3 at(0.002, 0.010, 0.024);
  // Ends in a plane of its own, not square to the edge.
  const MeasureEnd circle{at, {FeatureShape::Circle, at, glm::normalize(glm::dvec3(1, 2, 3)), 0.005}};
  for (const double clicked : {-0.03, 0.0, 0.0013, 0.03}) {
    MeasureEnd edge = axis({0, 0, 0}, {1, 0, 0}, {clicked, 0, 0});
    edge.extent = {-0.03, 0.03};
    const Measurement there = measure(circle, edge), back = measure(edge, circle);
    for (const Measurement& m : {there, back, measure(point(at), edge), measure(edge, point(at))}) {
      EXPECT_NEAR(m.distance, 0.026, 1e-15);
      EXPECT_NEAR(m.apart.value(), 0.026, 1e-15);
      EXPECT_NEAR(m.pointToPoint.value(), std::hypot(0.002 - clicked, 0.026), 1e-15);
    }
    EXPECT_LT(glm::distance(there.to, glm::dvec3(0.002, 0, 0)) + glm::distance(there.from, at), 1e-15);
    EXPECT_LT(glm::distance(back.from, glm::dvec3(0.002, 0, 0)) + glm::distance(back.to, at), 1e-15);
    EXPECT_NEAR(there.angle.value(), std::acos(1.0 / std::sqrt(14.0)), 1e-12);
    EXPECT_FALSE(measure(point(at), edge).angle);
  }
}

TEST(Measure, ACentreBeyondTheEndOfAnEdgeIsMeasuredToTheClick) {
  const glm::dvec3 at(0.04, 0.03, 0.0);
  const MeasureEnd circle{at, {FeatureShape::Circle, at, {0, 0, 1}, 0.005}};
  MeasureEnd edge = axis({0, 0, 0}, {1, 0, 0}, {0, 0, 0});
  edge.extent = {-0.01, 0.01};
  for (const Measurement& m : {measure(circle, edge), measure(edge, circle)}) {
    EXPECT_NEAR(m.distance, 0.05, 1e-15);
    EXPECT_NEAR(m.apart.value(), 0.03, 1e-15) << "to its line";
    EXPECT_FALSE(m.pointToPoint);
  }
  edge.extent = {-0.01, 0.04};
  EXPECT_NEAR(measure(circle, edge).distance, 0.03, 1e-15) << "across from its end";
}

TEST(Measure, ACircleIsAsFarFromAFaceAsItsCentre) {
  const MeasureEnd circle{{0, 0, 0.3}, {FeatureShape::Circle, {0, 0, 0.3}, {0, 0, 1}, 0.01}};
  const Measurement m = measure(circle, plane({1, 1, 0.1}, {0, 0, 1}, {1, 1, 0.1}));
  EXPECT_NEAR(m.apart.value(), 0.2, 1e-15);
}

TEST(Measure, APointIsSquareFromAFaceAndFromAnEdge) {
  const MeasureEnd corner = point({0.3, 0.4, 1.2});
  EXPECT_NEAR(measure(corner, plane({}, {0, 0, 1}, {5, 5, 0})).apart.value(), 1.2, 1e-15);
  EXPECT_NEAR(measure(axis({}, {0, 0, 1}, {}), corner).apart.value(), 0.5, 1e-15);
  EXPECT_FALSE(measure(axis({}, {0, 0, 1}, {}), corner).angle);
}

TEST(Measure, IsTheSameInEveryFrame) {
  test::RandomValues random(7);
  for (int i = 0; i < 50; ++i) {
    const glm::dvec3 along = random.vector(1.0);
    const MeasureEnd a = plane(random.vector(1.0), along, random.vector(1.0));
    const MeasureEnd b = axis(random.vector(1.0), glm::cross(along, random.vector(1.0)), random.vector(1.0));
    const RigidTransform pose{glm::angleAxis(random.in(-3.0, 3.0), glm::normalize(random.vector(1.0))),
                              random.vector(1.0)};
    const Measurement here = measure(a, b), there = measure(placed(a, pose), placed(b, pose));
    EXPECT_NEAR(here.distance, there.distance, 1e-12);
    EXPECT_NEAR(here.apart.value(), there.apart.value(), 1e-12);
    EXPECT_NEAR(here.angle.value(), there.angle.value(), 1e-12);
  }
}

TEST(MeasureEnd, OfAnEdgeIsItsNearestPointOfAFaceTheVeryPoint) {
  const TriangleMesh box = test::boxMesh({0.02, 0.04, 0.06});
  // The upper face, near its edge along y.
  std::uint32_t upper = 0;
  while (box.vertices()[box.triangles()[upper][0]].z < 0.0 ||
         box.vertices()[box.triangles()[upper][1]].z < 0.0 ||
         box.vertices()[box.triangles()[upper][2]].z < 0.0)
    ++upper;
  const SurfaceHit hit{upper, {0.0095, 0.011, 0.03}};
  const auto edge = pickFeature(box, hit, 0.001);
  ASSERT_TRUE(edge && edge->feature.shape == FeatureShape::Axis);
  const MeasureEnd onEdge = measureEnd(box, *edge, hit.point);
  EXPECT_LT(glm::distance(onEdge.point, glm::dvec3(0.01, 0.011, 0.03)), 1e-15);
  // It is 40 mm long.
  ASSERT_TRUE(onEdge.extent);
  EXPECT_NEAR(onEdge.extent->x, -0.02, 1e-15);
  EXPECT_NEAR(onEdge.extent->y, 0.02, 1e-15);
  const auto face = pickFeature(box, hit, 1e-6);
  ASSERT_TRUE(face && face->feature.shape == FeatureShape::Plane);
  EXPECT_EQ(measureEnd(box, *face, hit.point).point, hit.point);
  const auto corner = pickFeature(box, hit, 0.05);
  ASSERT_TRUE(corner && corner->feature.shape == FeatureShape::Point);
  EXPECT_LT(glm::distance(measureEnd(box, *corner, hit.point).point, glm::dvec3(0.01, 0.02, 0.03)), 1e-15);
}

TEST(MeasureEnd, OfACircleIsItsCentre) {
  const TriangleMesh cylinder = test::cylinderMesh(0.01, 0.04, 48);
  std::uint32_t rim = 0;
  while (cylinder.vertices()[cylinder.triangles()[rim][0]].z < 0.0 ||
         cylinder.vertices()[cylinder.triangles()[rim][1]].z < 0.0 ||
         cylinder.vertices()[cylinder.triangles()[rim][2]].z < 0.0)
    ++rim;
  const Triangle& t = cylinder.triangles()[rim];
  glm::dvec3 on(0.0);
  for (const std::uint32_t v : t)
    on += cylinder.vertices()[v] / 3.0;
  const auto circle = pickFeature(cylinder, {rim, on}, 0.008, FeatureFilter::Axes);
  ASSERT_TRUE(circle && circle->feature.shape == FeatureShape::Circle);
  EXPECT_LT(glm::distance(measureEnd(cylinder, *circle, on).point, glm::dvec3(0, 0, 0.02)), 1e-12);
}

}  // namespace
}  // namespace nearfit::measure_test
