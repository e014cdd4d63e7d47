// A part near thousands of pairs of features, whose steps take several ticks each: the wrench does not wait for
// them, and what is free does not drag. Here a rod in a tube, ringed alike.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/servo/proxy.h"
#include "core/servo/scene_tracker.h"
#include "core/servo/servo_tick.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/ringed_pair.h"
#include "tests/support/tick_observation.h"

namespace nearfit::two_rates_test {
namespace {

constexpr double kPeriod = 1e-3, kMargin = 0.008;

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

class RodInTube : public testing::Test {
 protected:
  explicit RodInTube(std::uint32_t detail = 4) {
    const test::RingedPair pair{.detail = detail};
    auto scene = std::make_shared<ServoScene>();
    scene->setMoving({PartId{1}, test::solidGeometryOf(pair.rod()), {}});
    scene->bodies.push_back({PartId{2}, test::solidGeometryOf(pair.tube()), {}});
    scene->prepareSurfaces();
    tracker_.setScene(scene);
    parameters_.haptics.proxy.margin = kMargin;
    parameters_.haptics.springs.cutoff = 2.0 * kMargin;
    parameters_.limits.maxForce = 1e6;
    parameters_.limits.maxTorque = 1e6;
  }

  const ServoSnapshot& tick(const RigidTransform& device) {
    const SearchReach reach = searchReach(parameters_.haptics);
    if (snapshot_->tick > 0) tracker_.update(observationOf(*snapshot_), 1.0);
    if (tracker_.isDue(reach)) tracker_.refresh(reach, tracked_);
    tick_.run(tracked_, parameters_, {.pose = device}, kPeriod, *snapshot_);
    ++snapshot_->tick;
    return *snapshot_;
  }

  SceneTracker tracker_;
  TrackedScene tracked_;
  ServoTick tick_;
  ServoParameters parameters_;
  const std::unique_ptr<ServoSnapshot> snapshot_ = std::make_unique<ServoSnapshot>();
};

/// With so many pairs that the part stays behind.
class FineRodInTube : public RodInTube {
 protected:
  FineRodInTube() : RodInTube(5) {}
};

// Pressed against the wall and turned about its axis, which the tube lets it do: the torque about the axis is that of
// a part left behind unless the hand is let go along what is free.
TEST_F(FineRodInTube, WhatIsFreeDoesNotDragWhileThePartIsBehind) {
  const glm::dvec3 pressed(0.05, 0.0, 0.0);
  for (int i = 0; i < 400; ++i)
    tick(at(pressed));
  int behind = 0;
  double most = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double angle = 5e-4 * i;
    const RigidTransform hand{glm::angleAxis(angle, glm::dvec3(0.0, 0.0, 1.0)), pressed};
    const ServoSnapshot& s = tick(hand);
    behind += s.isBehind ? 1 : 0;
    const double press = glm::length(s.wrench.force);
    ASSERT_GT(press, 1.0);
    // As a force at the rod's surface.
    if (i >= 20) most = std::max(most, std::abs(s.wrench.torque.z) / press);
  }
  EXPECT_GT(behind, 200);
  EXPECT_LT(most, 0.02);
}

// What is left of a tick's way limits where the part goes, not what the hand wants: else a part far behind a hand that
// presses would go along what is free by the same share, and drag.
TEST(TwoRates, APartThatIsPressedHardIsFeltAsFarAsItIsFreeToGo) {
  auto scene = std::make_shared<ServoScene>();
  scene->setMoving({PartId{1}, test::solidGeometryOf(test::boxMesh(glm::dvec3(1.0))), {}});
  scene->bodies.push_back(
      {PartId{2}, test::solidGeometryOf(test::boxMesh({10.0, 10.0, 1.0}, {0.0, 0.0, -1.1})), {}});
  scene->prepareSurfaces();
  SceneTracker tracker;
  tracker.setScene(scene);
  const ProxySettings settings{.margin = kMargin};
  TrackedScene tracked;
  Proxy proxy;
  proxy.place({});
  for (int i = 0; i < 60; ++i) {
    tracker.update({proxy.pose(), std::nullopt, proxy.account().isWaiting, false}, 1.0);
    tracker.refresh({kMargin, kContactReach * kMargin}, tracked);
    proxy.follow(tracked, at({0.0, 0.0, -2.0}), settings);
  }
  EXPECT_NEAR(proxy.pose().translation.z, kMargin - 0.1, 0.1 * kMargin);
  constexpr double kSlide = 0.01;
  proxy.begin(tracked, at({kSlide, 0.0, -2.0}), settings);
  proxy.feel(tracked);
  EXPECT_NEAR(proxy.feltPose().translation.x - proxy.pose().translation.x, kSlide, 1e-6 * kSlide);
}

// A trial that was planned for where the hand was a tick ago ended the way, and the part rested short of the hand.
TEST_F(FineRodInTube, APartThatWasBehindArrivesWhereTheHandStopped) {
  const auto turnedBy = [](double angle) {
    return RigidTransform{glm::angleAxis(angle, glm::dvec3(0.0, 0.0, 1.0)), {}};
  };
  for (int i = 0; i < 40; ++i)
    tick({});
  int behind = 0;
  for (const double stop : {0.02, 0.013, 0.05, 0.049, 0.03}) {
    const double start = 2.0 * std::atan2(snapshot_->proxy.rotation.z, snapshot_->proxy.rotation.w);
    for (int i = 1; i <= 30; ++i)
      behind += tick(turnedBy(start + (stop - start) * i / 30.0)).isBehind ? 1 : 0;
    for (int i = 0; i < 400; ++i)
      tick(turnedBy(stop));
    EXPECT_FALSE(snapshot_->isBehind);
    EXPECT_NEAR(2.0 * std::atan2(snapshot_->proxy.rotation.z, snapshot_->proxy.rotation.w), stop, 1e-6);
  }
  EXPECT_GT(behind, 0);
}

TEST_F(RodInTube, WhatTheWrenchWaitsForIsBounded) {
  for (int i = 0; i < 40; ++i)
    tick({});
  Proxy proxy;
  proxy.place({});
  std::uint64_t most = 0;
  for (int i = 0; i < 200; ++i) {
    const RigidTransform hand = at({0.02 * std::sin(0.1 * i), 0.0, 1e-4 * i});
    proxy.begin(tracked_, hand, parameters_.haptics.proxy);
    const bool isDone = proxy.advance(tracked_, ServoTick::kWorkOfFeel, ContactFinder::Excess::None);
    most = std::max(most, proxy.work());
    proxy.feel(tracked_);
    if (isDone && !proxy.account().isBehind) {
      EXPECT_EQ(proxy.feltPose().translation, proxy.pose().translation);
    }
    proxy.advance(tracked_, ContactFinder::kUsualWork, ContactFinder::Excess::ToGather);
  }
  EXPECT_GT(most, ServoTick::kWorkOfFeel / 2);
  // And what is tested before it is asked again, or a program that takes more than was expected.
  EXPECT_LE(most, 4 * ServoTick::kWorkOfFeel);
}

}  // namespace
}  // namespace nearfit::two_rates_test
