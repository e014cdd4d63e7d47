#include "core/placing/insert.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <stdexcept>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/mesh/ray_tree.h"
#include "core/placing/feature_pick.h"
#include "tests/support/mesh_generators.h"

namespace nearfit::insert_test {
namespace {

constexpr double kReach = 1e-3;  ///< [m]

/// A bolt along z: its head above z = 0, its shank of 8 mm below.
TriangleMesh bolt() {
  const glm::dvec2 profile[] = {{0.004, -0.03}, {0.004, 0.0}, {0.007, 0.0}, {0.007, 0.005}};
  return test::turnedMesh(profile, 48);
}

/// A plate with a bore of 8.4 mm along z; its upper face is at z = 5 mm.
TriangleMesh plate() {
  return test::tubeMesh(0.0042, 0.02, 0.01, 48);
}

/// A bolt whose shank meets the head in a cone of 45 degrees.
TriangleMesh countersunk() {
  const glm::dvec2 profile[] = {{0.004, -0.03}, {0.004, 0.0}, {0.007, 0.003}, {0.007, 0.005}};
  return test::turnedMesh(profile, 48);
}

PickedFeature picked(const TriangleMesh& mesh, const glm::dvec3& from, const glm::dvec3& to) {
  const std::optional<RayHit> hit = RayTree(mesh).firstHit(from, to);
  if (!hit) throw std::runtime_error("nothing was hit");
  return pickFeature(mesh, {hit->triangle, hit->point}, kReach, FeatureFilter::Rounds).value();
}

/// Where the shank meets the head.
AlignFeature underHead(const TriangleMesh& mesh) {
  return insertFeature(mesh, picked(mesh, {0.1, 0.001, -4e-4}, {0.0, 0.001, -4e-4}));
}

AlignFeature upperEdgeOfBore(const TriangleMesh& mesh) {
  return insertFeature(mesh, picked(mesh, {0.0046, 0.0, 0.1}, {0.0046, 0.0, 0.0}));
}

RigidTransform somewhere(std::mt19937_64& random) {
  std::uniform_real_distribution<> in(-1.0, 1.0);
  const glm::dvec3 axis = glm::normalize(glm::dvec3(in(random), in(random), 1.1));
  return {glm::angleAxis(std::numbers::pi * in(random), axis), {in(random), in(random), in(random)}};
}

TEST(Insert, TheSeatOfARoundEdgeIsTheFlatFaceInItsPlane) {
  const AlignFeature head = underHead(bolt());
  EXPECT_EQ(head.shape, FeatureShape::Circle);
  EXPECT_NEAR(glm::distance(head.direction, glm::dvec3(0, 0, -1)), 0.0, 1e-12);
  EXPECT_NEAR(glm::length(head.point), 0.0, 1e-12);
  EXPECT_NEAR(head.radius, 0.004, 1e-12);
  const AlignFeature bore = upperEdgeOfBore(plate());
  EXPECT_EQ(bore.shape, FeatureShape::Circle);
  EXPECT_NEAR(glm::distance(bore.direction, glm::dvec3(0, 0, 1)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(bore.point, glm::dvec3(0, 0, 0.005)), 0.0, 1e-12);
  EXPECT_NEAR(bore.radius, 0.0042, 1e-12);
}

TEST(Insert, AnEdgeWithoutAFlatFaceGivesItsAxis) {
  EXPECT_EQ(underHead(countersunk()).shape, FeatureShape::Axis);
}

TEST(Insert, AWallGivesItsAxis) {
  const TriangleMesh mesh = bolt();
  const AlignFeature shank = insertFeature(mesh, picked(mesh, {0.1, 0.0, -0.015}, {0.0, 0.0, -0.015}));
  EXPECT_EQ(shank.shape, FeatureShape::Axis);
  EXPECT_NEAR(std::abs(shank.direction.z), 1.0, 1e-12);
}

TEST(Insert, ABoltIsSeatedInItsBoreFromAnywhere) {
  const AlignFeature head = underHead(bolt()), bore = upperEdgeOfBore(plate());
  std::mt19937_64 random(11);
  for (int i = 0; i < 200; ++i) {
    const RigidTransform bolt = somewhere(random), plate = somewhere(random);
    const RigidTransform motion = insertMotion(placed(head, bolt), placed(bore, plate));
    const RigidTransform plateFromBolt = plate.inverse() * motion * bolt;
    EXPECT_NEAR(glm::distance(plateFromBolt.translation, glm::dvec3(0, 0, 0.005)), 0.0, 1e-12);
    EXPECT_NEAR(glm::distance(plateFromBolt.applyToVector({0, 0, 1}), glm::dvec3(0, 0, 1)), 0.0, 1e-12);
  }
}

TEST(Insert, DistanceLiftsTheHeadAndFlipTurnsItOver) {
  const AlignFeature head = underHead(bolt()), bore = upperEdgeOfBore(plate());
  const RigidTransform lifted = insertMotion(head, bore, {false, 0.002});
  EXPECT_NEAR(glm::distance(lifted.translation, glm::dvec3(0, 0, 0.007)), 0.0, 1e-12);
  const RigidTransform flipped = insertMotion(head, bore, {true, 0.002});
  EXPECT_NEAR(glm::distance(flipped.applyToVector({0, 0, 1}), glm::dvec3(0, 0, -1)), 0.0, 1e-12);
  EXPECT_NEAR(glm::distance(flipped.translation, glm::dvec3(0, 0, 0.007)), 0.0, 1e-12);
}

TEST(Insert, WithoutASeatThePartStaysWhereItIsAlongTheAxis) {
  const TriangleMesh mesh = bolt();
  const AlignFeature shank = insertFeature(mesh, picked(mesh, {0.1, 0.0, -0.015}, {0.0, 0.0, -0.015}));
  const RigidTransform aside{glm::angleAxis(0.2, glm::dvec3(0, 1, 0)), {0.05, 0.02, 0.1}};
  const AlignFeature moving = placed(shank, aside), bore = upperEdgeOfBore(plate());
  const RigidTransform motion = insertMotion(moving, bore, {false, 0.5});
  const glm::dvec3 middle = motion.applyToPoint(moving.point);
  EXPECT_NEAR(std::hypot(middle.x, middle.y), 0.0, 1e-12);
  EXPECT_NEAR(middle.z, moving.point.z, 1e-12);
  EXPECT_NEAR(glm::distance((motion * aside).applyToVector({0, 0, 1}), glm::dvec3(0, 0, 1)), 0.0, 1e-12);
}

TEST(Insert, StraightEdgesAreNotPicked) {
  const TriangleMesh box = test::boxMesh(glm::dvec3(0.02));
  const std::optional<RayHit> hit = RayTree(box).firstHit({0.0, 0.0098, 0.1}, {0.0, 0.0098, 0.0});
  ASSERT_TRUE(hit);
  const SurfaceHit near{hit->triangle, hit->point};
  EXPECT_TRUE(pickFeature(box, near, kReach, FeatureFilter::Axes));
  EXPECT_FALSE(pickFeature(box, near, kReach, FeatureFilter::Rounds));
}

}  // namespace
}  // namespace nearfit::insert_test
