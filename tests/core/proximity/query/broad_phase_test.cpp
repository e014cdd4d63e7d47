#include "core/proximity/query/broad_phase.h"

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/lmd_comparison.h"

namespace nearfit::broad_phase_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::uint32_t> found(const BroadPhase& phase, const glm::dvec3& centre, double radius) {
  std::vector<std::uint32_t> out;
  phase.visitNear(centre, radius, [&](std::uint32_t i) { out.push_back(i); });
  std::sort(out.begin(), out.end());
  return out;
}

double distanceTo(const Aabb& box, const glm::dvec3& p) {
  return glm::distance(p, glm::clamp(p, box.lower, box.upper));
}

/// Unit cubes with lower corners at x = 0, 2, 4, ...
std::vector<Aabb> cubesInARow(int count) {
  std::vector<Aabb> boxes(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    boxes[static_cast<std::size_t>(i)].add({2.0 * i, 0.0, 0.0});
    boxes[static_cast<std::size_t>(i)].add({2.0 * i + 1.0, 1.0, 1.0});
  }
  return boxes;
}

TEST(BroadPhase, FindsTheBoxesWithinARadiusAndNoOthers) {
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> place(-10.0, 10.0), side(0.0, 1.0);
  for (const std::size_t count : {1U, 2U, 4U, 5U, 63U, 1000U}) {
    std::vector<Aabb> boxes(count);
    for (Aabb& box : boxes) {
      const glm::dvec3 p{place(random), place(random), place(random)};
      box.add(p);
      box.add(p + glm::dvec3{side(random), side(random), side(random)});
    }
    const BroadPhase phase(boxes);
    for (int i = 0; i < 50; ++i) {
      const glm::dvec3 centre{place(random), place(random), place(random)};
      const double radius = 3.0 * side(random);
      std::vector<std::uint32_t> expected;
      for (std::uint32_t k = 0; k < count; ++k) {
        if (distanceTo(boxes[k], centre) <= radius) expected.push_back(k);
      }
      EXPECT_EQ(found(phase, centre, radius), expected);
    }
  }
}

TEST(BroadPhase, BoxesThatAreAllAtOnePlaceAreAllFound) {
  Aabb box;
  box.add(glm::dvec3(1.0));
  const std::vector<Aabb> boxes(500, box);
  EXPECT_EQ(found(BroadPhase(boxes), glm::dvec3(1.0), 0.0).size(), 500U);
  EXPECT_TRUE(found(BroadPhase(boxes), glm::dvec3(2.0), 0.5).empty());
}

TEST(BroadPhase, EmptyBoxesAreNeverNearAndThoseThatAreNoNumbersAlways) {
  Aabb none, broken, whole;
  broken.lower = broken.upper = glm::dvec3(std::numeric_limits<double>::quiet_NaN());
  whole.add(glm::dvec3(5.0));
  const BroadPhase phase(std::vector<Aabb>{none, broken, whole});
  EXPECT_EQ(found(phase, glm::dvec3(0.0), 1.0), std::vector<std::uint32_t>{1});
  EXPECT_EQ(found(phase, glm::dvec3(5.0), 1.0), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(found(phase, glm::dvec3(0.0), kInfinity), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(found(phase, glm::dvec3(1e300), 1.0), std::vector<std::uint32_t>{1});
  EXPECT_TRUE(found(BroadPhase(), glm::dvec3(0.0), kInfinity).empty());
}

TEST(BroadPhase, AsksNoFurtherBoxAfterOneOfWhichItIsNotTrue) {
  const BroadPhase bounds(cubesInARow(1000));
  int asked = 0;
  const auto isAnother = [&](std::uint32_t i) {
    ++asked;
    return i != 50;
  };
  EXPECT_FALSE(bounds.isEachNear({100.5, 0.5, 0.5}, 2.0, isAnother));
  EXPECT_LE(asked, 3);
  asked = 0;
  EXPECT_FALSE(bounds.isEachNear({0.0, 0.0, 0.0}, 1e6, [&](std::uint32_t) { return ++asked < 10; }));
  EXPECT_EQ(asked, 10);
  asked = 0;
  EXPECT_TRUE(bounds.isEachNear({200.5, 0.5, 0.5}, 2.0, isAnother));
  EXPECT_EQ(asked, 3);
}

TEST(BoundsOf, HoldTheCornersOfATurnedBoxTightly) {
  std::mt19937_64 random(32);
  Aabb box;
  box.add({-1.0, 2.0, 3.0});
  box.add({0.5, 2.5, 7.0});
  for (int i = 0; i < 100; ++i) {
    RigidTransform pose = test::randomRotation(random);
    pose.translation = {1e3, -2.0, 0.5};
    const Aabb bounds = boundsOf(box, pose);
    Aabb corners;
    for (int c = 0; c < 8; ++c) {
      corners.add(pose.applyToPoint({(c & 1) != 0 ? box.lower.x : box.upper.x,
                                     (c & 2) != 0 ? box.lower.y : box.upper.y,
                                     (c & 4) != 0 ? box.lower.z : box.upper.z}));
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LE(bounds.lower[axis], corners.lower[axis]);
      EXPECT_GE(bounds.upper[axis], corners.upper[axis]);
      EXPECT_NEAR(bounds.lower[axis], corners.lower[axis], 1e-9);
      EXPECT_NEAR(bounds.upper[axis], corners.upper[axis], 1e-9);
    }
  }
  EXPECT_TRUE(boundsOf(Aabb{}, {}).isEmpty());
}

}  // namespace
}  // namespace nearfit::broad_phase_test
