#include <memory>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/servo/servo_tick.h"
#include "core/servo/work_bound.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/servo_fixtures.h"

namespace nearfit::spring_areas_test {
namespace {

/// A ball in a bowl whose facets give many minima of one contact.
class BallInBowlServo : public testing::Test {
 protected:
  BallInBowlServo() {
    scene_.setMoving({PartId{2}, test::geometryOf(test::icosphereMesh(0.5, 4), glm::dvec3(0.0)), pose_});
    scene_.bodies.push_back({PartId{1}, test::geometryOf(test::bowlMesh(1.0, 1.2, 128, 32)), {}});
    parameters_.haptics.mode = HapticMode::Springs;
    parameters_.haptics.springs = {.cutoff = 0.25, .stiffness = 4.0, .onePerArea = true};
    parameters_.limits = {.maxForce = 1e3, .maxTorque = 1e3, .damping = 1e3, .rotationalDamping = 1e3};
  }

  const ServoSnapshot& tick() {
    tick_.run(test::untrackedView(scene_), parameters_, {.pose = pose_}, 1e-3, *snapshot_);
    return *snapshot_;
  }

  const RigidTransform pose_{{1.0, 0.0, 0.0, 0.0}, {0.02, 0.01, -0.42}};
  ServoScene scene_;
  ServoParameters parameters_;
  ServoTick tick_;
  const std::unique_ptr<ServoSnapshot> snapshot_ = std::make_unique<ServoSnapshot>();
};

TEST_F(BallInBowlServo, HoldsOneSpringAtTheNearestMinimum) {
  const ServoSnapshot& s = tick();
  EXPECT_GT(s.lmdCount, 1U);
  EXPECT_EQ(s.areaCount, 1U);
  EXPECT_NEAR(glm::length(s.unclampedWrench.force), 4.0 * (0.25 - s.distance), 1e-12);
  EXPECT_LE(s.work, mostWork(HapticMode::Springs));
  for (std::uint32_t i = 0; i < s.storedLmds; ++i)
    EXPECT_EQ(s.lmds[i].lmd.isMerged, i > 0) << i;
}

TEST_F(BallInBowlServo, ASettingThatChangesUnderAStillHandCountsAtOnce) {
  const double grouped = glm::length(tick().unclampedWrench.force);
  parameters_.haptics.springs.onePerArea = false;
  const ServoSnapshot& s = tick();
  EXPECT_EQ(s.areaCount, s.lmdCount);
  EXPECT_GT(glm::length(s.unclampedWrench.force), 1.5 * grouped);
  parameters_.haptics.springs.onePerArea = true;
  EXPECT_EQ(glm::length(tick().unclampedWrench.force), grouped);
}

TEST_F(BallInBowlServo, MergingAllocatesNothing) {
  tick();
  const TrackedScene view = test::untrackedView(scene_);
  test::resetAllocationCount();
  test::startCountingAllocations();
  tick_.run(view, parameters_, {.pose = pose_}, 1e-3, *snapshot_);
  test::stopCountingAllocations();
  EXPECT_GT(snapshot_->lmdCount, 1U);
  EXPECT_EQ(test::countedAllocations(), 0U);
}

}  // namespace
}  // namespace nearfit::spring_areas_test
