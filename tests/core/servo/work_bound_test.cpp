// Two plates of twelve thousand triangles face to face: thousands of pieces of one flat region, all at one
// distance. Merged for display in one tick, they took two milliseconds.
#include "core/servo/work_bound.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "core/servo/scene_tracker.h"
#include "core/servo/servo_tick.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/tick_observation.h"

namespace nearfit::work_bound_test {
namespace {

constexpr double kPeriod = 1e-3, kMargin = 1e-3, kCutoff = 0.02, kThickness = 0.01;
/// The upper plate is off by less than a triangle, so that each lies across several.
constexpr double kAside = 0.0013;

class FlatPlates : public testing::Test {
 protected:
  FlatPlates() {
    const auto plate = test::geometryOf(test::subdivided(test::boxMesh({0.2, 0.2, kThickness}), 5));
    const auto scene = std::make_shared<ServoScene>();
    scene->setMoving({PartId{1}, plate, atGap(10.0 * kMargin)});
    scene->bodies.push_back({PartId{2}, plate, {}});
    tracker_.setScene(scene);
    parameters_.haptics.springs.cutoff = kCutoff;
    parameters_.haptics.proxy.margin = kMargin;
    tracker_.refresh(searchReach(parameters_.haptics), tracked_);
  }

  static RigidTransform atGap(double gap) { return {{1, 0, 0, 0}, {kAside, 0.7 * kAside, kThickness + gap}}; }

  const ServoSnapshot& tick(double gap) {
    const SearchReach reach = searchReach(parameters_.haptics);
    if (ticks_++ > 0) tracker_.update(test::partAt(snapshot_->proxy), 1.0);
    if (tracker_.isDue(reach)) tracker_.refresh(reach, tracked_);
    tick_.run(tracked_, parameters_, {.pose = atGap(gap)}, kPeriod, *snapshot_);
    return *snapshot_;
  }

  SceneTracker tracker_;
  TrackedScene tracked_;
  ServoTick tick_;
  ServoParameters parameters_;
  int ticks_ = 0;
  const std::unique_ptr<ServoSnapshot> snapshot_ = std::make_unique<ServoSnapshot>();
};

TEST_F(FlatPlates, NoTickOfTheProxyIsBeyondTheBoundAndTheDistanceIsRight) {
  for (int i = 0; i < 400; ++i) {
    const double gap = kMargin * (6.0 + 4.0 * std::cos(0.03 * i));
    const ServoSnapshot& s = tick(gap);
    ASSERT_EQ(s.fault, ServoFault::None);
    ASSERT_LE(s.work, mostWork(HapticMode::Proxy)) << i;
    ASSERT_GT(s.storedLmds, 0U) << i;
    EXPECT_TRUE(s.isTruncated || s.lmdCount == 1) << i;
    // No part of the way is kept from it: a gap of two margins is free.
    ASSERT_NEAR(s.proxy.translation.z, kThickness + gap, 1e-12) << i;
    EXPECT_NEAR(s.distance, gap, 1e-9) << i;
  }
}

TEST_F(FlatPlates, AtRestEachTickTakesAsMuchAsTheOneBefore) {
  for (int i = 0; i < 300; ++i)
    tick(2.0 * kMargin);
  const std::uint64_t work = snapshot_->work;
  EXPECT_GT(work, 0U);
  for (int i = 0; i < 300; ++i)
    EXPECT_EQ(tick(2.0 * kMargin).work, work) << i;
}

TEST_F(FlatPlates, PressedOnEachOtherTheyStayWithinTheBoundToo) {
  for (int i = 0; i < 300; ++i) {
    const ServoSnapshot& s = tick(10.0 * kMargin - 2e-4 * i);
    ASSERT_LE(s.work, mostWork(HapticMode::Proxy)) << i;
    EXPECT_GE(s.proxy.translation.z, kThickness + 0.9 * kMargin) << i;
  }
  EXPECT_GT(snapshot_->wrench.force.z, 1.0);
}

TEST_F(FlatPlates, SpringsFeelTheWholeRegionWithinTheirLargerBound) {
  parameters_.haptics.mode = HapticMode::Springs;
  for (int i = 0; i < 20; ++i) {
    const double gap = kMargin * (2.0 + 0.2 * i);
    const ServoSnapshot& s = tick(gap);
    ASSERT_LE(s.work, mostWork(HapticMode::Springs));
    EXPECT_NEAR(s.distance, gap, 1e-9);
  }
}

TEST(WorkBound, PiecesThatAreMergeableAreSoHoweverTheyLie) {
  for (const std::uint64_t work : {0ULL, 31ULL, 32ULL, 4096ULL, 8192ULL, 1ULL << 20}) {
    const std::size_t pieces = mergeablePieces(work);
    EXPECT_LE(mostMergeWork(pieces), work);
    EXPECT_GT(mostMergeWork(pieces + 1), work);
  }
  // By hand: 158 * 32 + 158 * 158 / 8 = 5056 + 3120.
  EXPECT_EQ(mergeablePieces(8192), 158U);
}

}  // namespace
}  // namespace nearfit::work_bound_test
