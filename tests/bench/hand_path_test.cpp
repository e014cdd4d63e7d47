#include "tests/bench/hand_path.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace nearfit::bench::hand_path_test {
namespace {

constexpr double kRadius = 0.25, kCutoff = 0.05, kReach = 0.075;

/// A sphere off the part's origin beside one at the scene's: their distance is known.
const PathBodies kSpheres{glm::dvec3(0.0), glm::dvec3(1.0, 2.0, 3.0), kRadius, kRadius, 1.0};

double gapAt(const RigidTransform& sceneFromPart) {
  return glm::length(sceneFromPart.applyToPoint(kSpheres.partCentre)) - 2.0 * kRadius;
}

std::optional<Nearest> probeSpheres(const RigidTransform& sceneFromPart) {
  const double gap = gapAt(sceneFromPart);
  if (gap > kReach) return std::nullopt;
  return Nearest{gap, glm::normalize(sceneFromPart.applyToPoint(kSpheres.partCentre))};
}

HandPathOptions optionsOf(std::uint64_t seed) {
  HandPathOptions options;
  options.cutoff = kCutoff;
  options.reach = kReach;
  options.seed = seed;
  return options;
}

TEST(HandPath, NoStepCanReachTheOtherBody) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const std::vector<RigidTransform> path = handPath(kSpheres, probeSpheres, optionsOf(seed));
    ASSERT_EQ(path.size(), 2000U);
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
      ASSERT_LT(motionBound(kSpheres, path[i], path[i + 1]), gapAt(path[i])) << "pose " << i;
  }
}

TEST(HandPath, StepsAreWholeWhereThereIsRoom) {
  const HandPathOptions options = optionsOf(2);
  const std::vector<RigidTransform> path = handPath(kSpheres, probeSpheres, options);
  const double whole = options.step + options.turn * kRadius;
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    ASSERT_NEAR(motionBound(kSpheres, path[i], path[i + 1]), whole, 1e-9) << "pose " << i;
}

TEST(HandPath, StaysNearContactAndComesAndGoes) {
  const std::vector<RigidTransform> path = handPath(kSpheres, probeSpheres, optionsOf(3));
  std::size_t within = 0;
  double least = 1.0, greatest = 0.0;
  for (const RigidTransform& pose : path) {
    const double gap = gapAt(pose);
    within += gap < kCutoff ? 1U : 0U;
    least = std::min(least, gap);
    greatest = std::max(greatest, gap);
  }
  EXPECT_GT(within, 1800U);
  EXPECT_LT(least, 0.2 * kCutoff);
  EXPECT_GT(greatest, 0.6 * kCutoff);
}

TEST(HandPath, DirectionsChangeSmoothlyWhereNothingIsInTheWay) {
  HandPathOptions options = optionsOf(4);
  // A body without extent turns without moving: it never has to give way.
  const PathBodies pointLike{glm::dvec3(0.0), kSpheres.partCentre, 2.0 * kRadius, 0.0, 1.0};
  const std::vector<RigidTransform> path = handPath(pointLike, probeSpheres, options);
  std::size_t sharp = 0;
  for (std::size_t i = 2; i < path.size(); ++i) {
    const auto at = [&](std::size_t k) { return path[k].applyToPoint(kSpheres.partCentre); };
    const glm::dvec3 before = glm::normalize(at(i - 1) - at(i - 2)),
                     after = glm::normalize(at(i) - at(i - 1));
    sharp += glm::dot(before, after) < std::cos(0.3) ? 1U : 0U;
  }
  EXPECT_LT(sharp, path.size() / 50);
}

TEST(HandPath, StaysWithinItsRange) {
  HandPathOptions options = optionsOf(5);
  options.range = 0.1;
  const std::vector<RigidTransform> path = handPath(kSpheres, probeSpheres, options);
  const glm::dvec3 home = path.front().applyToPoint(kSpheres.partCentre);
  double farthest = 0.0;
  for (const RigidTransform& pose : path)
    farthest = std::max(farthest, glm::distance(home, pose.applyToPoint(kSpheres.partCentre)));
  EXPECT_LE(farthest, 0.1 + 1e-12);
  EXPECT_GT(farthest, 0.05);
}

TEST(HandPath, SameSeedGivesTheSamePathAndAnotherAnother) {
  const auto walk = [](std::uint64_t seed) { return handPath(kSpheres, probeSpheres, optionsOf(seed)); };
  const std::vector<RigidTransform> first = walk(6), again = walk(6), other = walk(7);
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].translation, again[i].translation);
    ASSERT_EQ(first[i].rotation, again[i].rotation);
  }
  EXPECT_NE(first.back().translation, other.back().translation);
}

TEST(HandPath, StartInContactIsRefused) {
  HandPathOptions options = optionsOf(1);
  options.start = RigidTransform{glm::dquat(1.0, 0.0, 0.0, 0.0),
                                 glm::dvec3(2.0 * kRadius, 0.0, 0.0) - kSpheres.partCentre};
  EXPECT_THROW(handPath(kSpheres, probeSpheres, options), Error);
}

TEST(MotionBound, AddsTurnTimesRadiusToTheCentresWay) {
  RigidTransform from, to;
  to.rotation = glm::angleAxis(0.5, glm::dvec3(0.0, 0.0, 1.0));
  // The centre is held: only the turn remains.
  to.translation = kSpheres.partCentre - to.applyToVector(kSpheres.partCentre);
  EXPECT_NEAR(motionBound(kSpheres, from, to), 0.5 * kRadius, 1e-12);
  to.translation.x += 0.3;
  EXPECT_NEAR(motionBound(kSpheres, from, to), 0.3 + 0.5 * kRadius, 1e-12);
  // The other of the two quaternions of one rotation is the same motion.
  to.rotation = -to.rotation;
  EXPECT_NEAR(motionBound(kSpheres, from, to), 0.3 + 0.5 * kRadius, 1e-12);
}

}  // namespace
}  // namespace nearfit::bench::hand_path_test
