#include "core/servo/minima_finder.h"

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "core/servo/scene_tracker.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/servo_fixtures.h"

namespace nearfit::minima_finder_test {
namespace {

constexpr double kCutoff = 0.2;

/// The cone over the floor without lists: what is searched anew is counted as late.
class MinimaFinderOverFloor : public testing::Test {
 protected:
  MinimaFinderOverFloor() {
    scene_ = test::coneOverFloor();
    tracked_ = test::untrackedView(*scene_);
    tracked_.serial = 1;
  }

  struct Felt {
    MinimaFinder::Result result;
    std::vector<std::vector<double>> distances;  ///< Of each body's minima.
  };
  Felt find(const RigidTransform& pose, double cutoff = kCutoff, double apart = 0.0) {
    Felt felt;
    felt.result =
        finder_.find(tracked_, pose, cutoff, apart, MinimaFinder::kFelt, [&](std::span<const Lmd> lmds) {
          felt.distances.emplace_back();
          for (const Lmd& lmd : lmds)
            felt.distances.back().push_back(lmd.distance);
        });
    return felt;
  }
  /// Whether the bodies were searched, which each of these scenes has of which nothing is known.
  bool isSearched(const RigidTransform& pose, double cutoff = kCutoff, double apart = 0.0) {
    return find(pose, cutoff, apart).result.lateBodies > 0;
  }

  std::unique_ptr<ServoScene> scene_;
  TrackedScene tracked_;
  MinimaFinder finder_;
};

TEST_F(MinimaFinderOverFloor, WhereNothingChangedTheSameIsFeltWithoutASearch) {
  const Felt first = find(test::tipAt(0.1));
  EXPECT_EQ(first.result.lateBodies, 1U);
  ASSERT_EQ(first.result.count, 1U);
  EXPECT_NEAR(first.distances[0][0], 0.1, 1e-12);
  const auto before = std::make_unique<ServoSnapshot>(), after = std::make_unique<ServoSnapshot>();
  finder_.write(*before);
  const Felt again = find(test::tipAt(0.1));
  EXPECT_EQ(again.result.lateBodies, 0U);
  EXPECT_EQ(again.distances, first.distances);
  EXPECT_EQ(again.result.count, 1U);
  EXPECT_EQ(again.result.work, first.result.work);
  EXPECT_EQ(again.result.distance, first.result.distance);
  finder_.write(*after);
  EXPECT_EQ(after->storedLmds, 1U);
  EXPECT_EQ(after->lmds[0].lmd.scenePoint, before->lmds[0].lmd.scenePoint);
}

TEST_F(MinimaFinderOverFloor, TheLeastChangeOfThePoseIsSearchedAnew) {
  RigidTransform pose = test::tipAt(0.1);
  EXPECT_TRUE(isSearched(pose));
  EXPECT_FALSE(isSearched(pose));
  pose.translation.z = std::nextafter(pose.translation.z, 1.0);
  EXPECT_TRUE(isSearched(pose));
  pose.rotation.x = -0.0;
  EXPECT_TRUE(isSearched(pose));
  EXPECT_FALSE(isSearched(pose));
}

TEST_F(MinimaFinderOverFloor, AnotherCutoffOrDistanceApartIsSearchedAnew) {
  const RigidTransform pose = test::tipAt(0.1);
  EXPECT_TRUE(isSearched(pose));
  EXPECT_TRUE(isSearched(pose, 0.5 * kCutoff));
  EXPECT_TRUE(isSearched(pose, 0.5 * kCutoff, 0.1));
  EXPECT_FALSE(isSearched(pose, 0.5 * kCutoff, 0.1));
}

TEST_F(MinimaFinderOverFloor, AnotherTrackedSceneIsSearchedAnew) {
  const RigidTransform pose = test::tipAt(0.1);
  EXPECT_NEAR(find(pose).distances[0][0], 0.1, 1e-12);
  scene_->bodies[0].worldFromPart.translation.z = -0.05;
  tracked_ = test::untrackedView(*scene_);
  tracked_.serial = 2;
  EXPECT_NEAR(find(pose).distances[0][0], 0.15, 1e-12);
}

TEST_F(MinimaFinderOverFloor, WhatMayHaveBeenChangedByHandIsSearchedEachTime) {
  tracked_.serial = 0;
  const RigidTransform pose = test::tipAt(0.1);
  EXPECT_TRUE(isSearched(pose));
  EXPECT_TRUE(isSearched(pose));
}

TEST_F(MinimaFinderOverFloor, APoseThatIsNoneIsRefusedEachTime) {
  scene_->bodies[0].worldFromPart.rotation = {0.0, 0.0, 0.0, 0.0};
  tracked_ = test::untrackedView(*scene_);
  tracked_.serial = 3;
  EXPECT_TRUE(find(test::tipAt(0.1)).result.isPoseBad);
  EXPECT_TRUE(find(test::tipAt(0.1)).result.isPoseBad);
}

TEST_F(MinimaFinderOverFloor, MoreBodiesThanAreKeptAreSearchedEachTime) {
  const ServoScene::Body floor = scene_->bodies[0];
  scene_->bodies.assign(MinimaFinder::kMaxKeptBodies, floor);
  tracked_ = test::untrackedView(*scene_);
  tracked_.serial = 4;
  const RigidTransform pose = test::tipAt(0.1);
  EXPECT_EQ(find(pose).result.count, MinimaFinder::kMaxKeptBodies);
  EXPECT_FALSE(isSearched(pose));
  scene_->bodies.push_back(floor);
  tracked_ = test::untrackedView(*scene_);
  tracked_.serial = 5;
  EXPECT_TRUE(isSearched(pose));
  EXPECT_TRUE(isSearched(pose));
  EXPECT_EQ(find(pose).result.count, MinimaFinder::kMaxKeptBodies + 1);
}

TEST_F(MinimaFinderOverFloor, KeepingAllocatesNothing) {
  const RigidTransform pose = test::tipAt(0.1);
  double sum = 0.0;
  const auto feel = [&](std::span<const Lmd> lmds) { sum += lmds[0].distance; };
  test::resetAllocationCount();
  test::startCountingAllocations();
  for (int i = 0; i < 10; ++i)
    finder_.find(tracked_, pose, kCutoff, 0.0, MinimaFinder::kFelt, feel);
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(SceneTracker, EachTrackedSceneHasASerialOfItsOwn) {
  const std::shared_ptr<const ServoScene> scene = test::coneOverFloor();
  SceneTracker a, b;
  a.setScene(scene);
  b.setScene(scene);
  TrackedScene first, second, third;
  a.refresh({kCutoff}, first);
  b.refresh({kCutoff}, second);
  a.refresh({kCutoff}, third);
  EXPECT_NE(first.serial, 0U);
  EXPECT_NE(second.serial, 0U);
  EXPECT_NE(third.serial, 0U);
  EXPECT_NE(first.serial, second.serial);
  EXPECT_NE(first.serial, third.serial);
  EXPECT_NE(second.serial, third.serial);
  EXPECT_EQ(untracked(scene).serial, 0U);
}

}  // namespace
}  // namespace nearfit::minima_finder_test
