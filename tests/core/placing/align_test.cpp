#include "core/placing/align.h"

#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

namespace nearfit::align_test {
namespace {

constexpr double kPi = std::numbers::pi;

class Features {
 public:
  explicit Features(unsigned seed) : random_(seed) {}
  double in(double most) { return std::uniform_real_distribution<>(-most, most)(random_); }
  glm::dvec3 direction() {
    const glm::dvec3 v(in(1.0), in(1.0), in(1.0));
    return glm::length(v) > 0.1 ? glm::normalize(v) : direction();
  }
  AlignFeature of(FeatureShape shape) {
    return {shape, glm::dvec3(in(1.0), in(1.0), in(1.0)),
            shape == FeatureShape::Point ? glm::dvec3(0.0) : direction(), 0.01};
  }

 private:
  std::mt19937 random_;
};

double angleOf(const glm::dquat& turn) {
  return 2.0 * std::acos(std::min(1.0, std::abs(turn.w)));
}
double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}
double distanceFromLine(const glm::dvec3& p, const AlignFeature& line) {
  return glm::length(glm::cross(p - line.point, line.direction));
}
double height(const glm::dvec3& p, const AlignFeature& plane) {
  return glm::dot(p - plane.point, plane.direction);
}

TEST(Align, FacesMeetFlushWithTheLeastTurnAndShift) {
  Features features(1);
  for (int i = 0; i < 200; ++i) {
    const AlignFeature moving = features.of(FeatureShape::Plane), fixed = features.of(FeatureShape::Plane);
    for (const bool isFlipped : {false, true}) {
      const RigidTransform motion = alignMotion(moving, fixed, {isFlipped, 0.25});
      const AlignFeature moved = placed(moving, motion);
      const glm::dvec3 wanted = isFlipped ? fixed.direction : -fixed.direction;
      EXPECT_NEAR(glm::distance(moved.direction, wanted), 0.0, 1e-13);
      EXPECT_NEAR(height(moved.point, fixed), 0.25, 1e-13);
      EXPECT_NEAR(angleOf(motion.rotation), angleBetween(moving.direction, wanted), 1e-7);
      // The face's middle goes straight to the plane.
      EXPECT_NEAR(glm::length(glm::cross(moved.point - moving.point, fixed.direction)), 0.0, 1e-13);
    }
  }
}

TEST(Align, FacesThatAlreadyLookAtEachOtherOrAwayAreHandled) {
  const AlignFeature fixed{FeatureShape::Plane, {0, 0, 0}, {0, 0, 1}};
  for (const double lean : {0.0, 1e-15, 1e-9, 1e-5, 0.01, 0.1}) {
    const AlignFeature away{FeatureShape::Plane, {0.3, 0, 1}, {std::sin(lean), 0, std::cos(lean)}};
    const AlignFeature moved = placed(away, alignMotion(away, fixed));
    EXPECT_NEAR(glm::distance(moved.direction, glm::dvec3(0, 0, -1)), 0.0, 1e-14) << lean;
    EXPECT_NEAR(glm::distance(moved.point, glm::dvec3(0.3, 0, 0)), 0.0, 1e-14) << lean;
    const RigidTransform none = alignMotion(away, fixed, {true, 1.0});
    EXPECT_NEAR(angleOf(none.rotation), lean, 1e-7) << lean;
  }
}

TEST(Align, AxesBecomeCoaxialAndStayWhereTheyAreAlong) {
  Features features(2);
  for (int i = 0; i < 200; ++i) {
    for (const FeatureShape other : {FeatureShape::Axis, FeatureShape::Circle}) {
      const AlignFeature moving = features.of(FeatureShape::Axis), fixed = features.of(other);
      const RigidTransform motion = alignMotion(moving, fixed);
      const AlignFeature moved = placed(moving, motion);
      EXPECT_NEAR(distanceFromLine(moved.point, fixed), 0.0, 1e-13);
      EXPECT_NEAR(glm::length(glm::cross(moved.direction, fixed.direction)), 0.0, 1e-13);
      EXPECT_NEAR(glm::dot(moved.point - moving.point, fixed.direction), 0.0, 1e-13);
      EXPECT_LE(angleOf(motion.rotation), kPi / 2.0 + 1e-7);
      const RigidTransform flipped = alignMotion(moving, fixed, {true, 0.0});
      EXPECT_NEAR(glm::dot(placed(moving, flipped).direction, moved.direction), -1.0, 1e-13);
      EXPECT_NEAR(distanceFromLine(placed(moving, flipped).point, fixed), 0.0, 1e-13);
    }
  }
}

TEST(Align, CirclesMeetInTheirCentres) {
  Features features(3);
  for (int i = 0; i < 100; ++i) {
    const AlignFeature moving = features.of(FeatureShape::Circle), fixed = features.of(FeatureShape::Circle);
    const AlignFeature moved = placed(moving, alignMotion(moving, fixed));
    EXPECT_NEAR(glm::distance(moved.point, fixed.point), 0.0, 1e-13);
    EXPECT_NEAR(glm::length(glm::cross(moved.direction, fixed.direction)), 0.0, 1e-13);
  }
}

TEST(Align, PointsGoTheLeastWayWithoutTurning) {
  Features features(4);
  for (int i = 0; i < 100; ++i) {
    const AlignFeature point = features.of(FeatureShape::Point);
    for (const FeatureShape other :
         {FeatureShape::Plane, FeatureShape::Axis, FeatureShape::Circle, FeatureShape::Point}) {
      const AlignFeature fixed = features.of(other);
      for (const auto& [from, to] : {std::pair(point, fixed), std::pair(fixed, point)}) {
        const RigidTransform motion = alignMotion(from, to);
        EXPECT_EQ(motion.rotation, glm::dquat(1.0, 0.0, 0.0, 0.0));
        const bool isMovedPoint = from.shape == FeatureShape::Point;
        const AlignFeature there = isMovedPoint ? to : placed(from, motion);
        const glm::dvec3 at = isMovedPoint ? motion.applyToPoint(from.point) : to.point;
        const double way = glm::length(motion.translation);
        const double expected = other == FeatureShape::Plane  ? std::abs(height(point.point, fixed))
                                : other == FeatureShape::Axis ? distanceFromLine(point.point, fixed)
                                                              : glm::distance(point.point, fixed.point);
        EXPECT_NEAR(way, expected, 1e-13);
        const double left = other == FeatureShape::Plane  ? std::abs(height(at, there))
                            : other == FeatureShape::Axis ? distanceFromLine(at, there)
                                                          : glm::distance(at, there.point);
        EXPECT_NEAR(left, 0.0, 1e-13);
      }
    }
  }
}

TEST(Align, AnAxisStandsSquareOnAPlaneWhereItIs) {
  Features features(5);
  for (int i = 0; i < 100; ++i) {
    const AlignFeature axis = features.of(FeatureShape::Axis), plane = features.of(FeatureShape::Plane);
    for (const auto& [from, to] : {std::pair(axis, plane), std::pair(plane, axis)}) {
      const RigidTransform motion = alignMotion(from, to);
      const AlignFeature moved = placed(from, motion);
      EXPECT_NEAR(glm::length(glm::cross(moved.direction, to.direction)), 0.0, 1e-13);
      EXPECT_NEAR(glm::distance(moved.point, from.point), 0.0, 1e-13);
    }
  }
}

TEST(Align, OnlyPairsWithDirectionsFlipAndOnlyPlanesAreOffset) {
  EXPECT_TRUE(canBeFlipped(FeatureShape::Plane, FeatureShape::Axis));
  EXPECT_FALSE(canBeFlipped(FeatureShape::Plane, FeatureShape::Point));
  EXPECT_TRUE(canBeOffset(FeatureShape::Plane, FeatureShape::Plane));
  EXPECT_TRUE(canBeOffset(FeatureShape::Point, FeatureShape::Plane));
  EXPECT_FALSE(canBeOffset(FeatureShape::Axis, FeatureShape::Axis));
  const AlignFeature a{FeatureShape::Point, {0, 0, 1}, {0, 0, 0}},
      b{FeatureShape::Point, {0, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(alignMotion(a, b, {true, 5.0}).translation, glm::dvec3(0, 0, -1));
}

}  // namespace
}  // namespace nearfit::align_test
