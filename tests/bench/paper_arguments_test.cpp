#include "tests/bench/paper_arguments.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/mesh_generators.h"

namespace nearfit::bench::paper_arguments_test {
namespace {

constexpr double kCutoff = 0.1;

RigidTransform at(double x) {
  return {{1, 0, 0, 0}, {x, 0, 0}};
}

Lmd lmdAt(double distance, const glm::dvec3& place = glm::dvec3(0.0)) {
  Lmd lmd;
  lmd.scenePoint = place;
  lmd.direction = {0, 0, 1};
  lmd.distance = distance;
  lmd.partPoint = place + distance * lmd.direction;
  return lmd;
}

TEST(WrenchAsPrinted, HasTheForceOfThePrintAndATorqueWithoutStiffnessAndOfTheOtherSign) {
  // One spring at 0.04 m, 0.3 m beside the centre: f = 0.06 * 0.04, pushing the part up.
  const std::array<Lmd, 1> lmds{lmdAt(0.04, {0.3, 0.0, 0.0})};
  const Wrench wrench = wrenchAsPrinted(lmds, kCutoff, 500.0, {0.0, 0.0, 0.04});
  EXPECT_NEAR(wrench.force.z, 500.0 * 0.06 * 0.04, 1e-12);
  // (0.3, 0, 0) x (0, 0, -0.0024)
  EXPECT_NEAR(wrench.torque.y, 0.3 * 0.0024, 1e-12);
  // The forces' own torque would be (0.3, 0, 0) x (0, 0, 1.2).
  EXPECT_LT(wrench.torque.y * (-0.3 * wrench.force.z), 0.0);
}

TEST(WrenchAsPrinted, HasNoForceAtAndBeyondTheCutoff) {
  const std::array<Lmd, 2> lmds{lmdAt(kCutoff), lmdAt(2.0 * kCutoff)};
  EXPECT_EQ(glm::length(wrenchAsPrinted(lmds, kCutoff, 500.0, {}).force), 0.0);
}

TEST(JumpBetween, IsNextToNothingOfASmoothForce) {
  const SpringMode mode = [](const RigidTransform& pose, ContactAnswer& answer) {
    answer.clear();
    answer.wrench.force = {std::sin(3.0 * pose.translation.x), 0, 0};
  };
  const Jump jump = jumpBetween(mode, at(0.0), at(0.1), kCutoff, 1.0);
  EXPECT_NEAR(jump.change, std::sin(0.3), 1e-12);
  EXPECT_LE(jump.size, 0.3 / 4096.0 * 1.01);
  EXPECT_EQ(jump.within + jump.atCutoff, 0U);
}

TEST(JumpBetween, IsAllOfAStepAndSaysThatASpringWasBornWithinTheCutoff) {
  const SpringMode mode = [](const RigidTransform& pose, ContactAnswer& answer) {
    answer.clear();
    answer.minima.push_back(lmdAt(0.05));
    const bool isBorn = pose.translation.x > 0.0377;
    if (isBorn) answer.minima.push_back(lmdAt(0.02, {1.0, 0.0, 0.0}));
    answer.wrench.force = {pose.translation.x, 0, isBorn ? 0.8 : 0.0};
  };
  const Jump birth = jumpBetween(mode, at(0.0), at(0.1), kCutoff, 1.0);
  EXPECT_NEAR(birth.size, 0.8, 1e-3);
  EXPECT_EQ(birth.within, 1U);
  EXPECT_EQ(birth.atCutoff, 0U);
  EXPECT_EQ(jumpBetween(mode, at(0.1), at(0.0), kCutoff, 1.0).within, 1U);
}

TEST(JumpBetween, TellsASpringThatComesInAtTheCutoff) {
  const SpringMode mode = [](const RigidTransform& pose, ContactAnswer& answer) {
    answer.clear();
    const double distance = 0.15 - pose.translation.x;
    if (distance < kCutoff) answer.minima.push_back(lmdAt(distance));
    answer.wrench.force = {0, 0, distance < kCutoff ? kCutoff - distance : 0.0};
  };
  // All of the change is after the birth, so the halves that are kept are not those of it.
  const Jump jump = jumpBetween(mode, at(0.0499), at(0.0501), kCutoff, 1.0);
  EXPECT_LE(jump.size, 1e-6);
  EXPECT_EQ(jump.within, 0U);
}

TEST(OnsetsAtCutoff, AreNewSpringsNoDeeperThanTheMotionExplains) {
  ContactAnswer before, after;
  const auto spring = [](double distance, std::uint32_t index) {
    Lmd lmd = lmdAt(distance);
    lmd.sceneIndex = index;
    return lmd;
  };
  before.minima = {spring(0.0999, 1)};
  // The first was there, the second is new at the cutoff, the third new and deep.
  after.minima = {spring(0.0995, 1), spring(0.099, 2), spring(0.05, 3)};
  const std::vector<double> pushes = onsetsAtCutoff(before, after, kCutoff, 0.002);
  ASSERT_EQ(pushes.size(), 1U);
  EXPECT_NEAR(pushes[0], 0.01, 1e-12);
  EXPECT_TRUE(onsetsAtCutoff(before, after, kCutoff, 0.0005).empty());
}

}  // namespace
}  // namespace nearfit::bench::paper_arguments_test
