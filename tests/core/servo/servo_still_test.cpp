#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "core/servo/scene_tracker.h"
#include "core/servo/servo_tick.h"
#include "tests/support/servo_fixtures.h"

namespace nearfit::servo_still_test {
namespace {

constexpr double kPeriod = 1e-3;

/// Two servos on one hand: one uses again what it found when nothing has moved, the other finds all anew.
class ServosAtRest : public testing::TestWithParam<HapticMode> {
 protected:
  ServosAtRest() {
    parameters_.haptics.mode = GetParam();
    parameters_.haptics.springs = {
        .cutoff = 0.1, .stiffness = 50.0, .damping = 2.0, .law = SpringLaw::Linear};
    parameters_.haptics.proxy.margin = 0.01;
    parameters_.limits = {100.0, 100.0};
    std::unique_ptr<ServoScene> scene = test::coneOverFloor();
    scene->moving.worldFromPart = test::tipAt(0.08);
    setScene(std::move(scene));
  }

  void setScene(std::shared_ptr<const ServoScene> scene) {
    scene_ = std::move(scene);
    tracker_.setScene(scene_);
    refresh();
  }
  void refresh() {
    tracker_.refresh(searchReach(parameters_.haptics), tracked_);
    anew_ = tracked_;
    anew_.serial = 0;
  }

  void tick(const RigidTransform& hand) {
    still_.run(tracked_, parameters_, {.pose = hand}, kPeriod, *a_);
    plain_.run(anew_, parameters_, {.pose = hand}, kPeriod, *b_);
    tracker_.update(observationOf(*a_), 1.0);
    expectSame();
    if (tracker_.isDue(searchReach(parameters_.haptics))) refresh();
  }
  void ticks(int count, const RigidTransform& hand) {
    for (int i = 0; i < count; ++i)
      tick(hand);
  }

  void expectSame() const {
    EXPECT_EQ(a_->wrench.force, b_->wrench.force);
    EXPECT_EQ(a_->wrench.torque, b_->wrench.torque);
    EXPECT_EQ(a_->unclampedWrench.force, b_->unclampedWrench.force);
    EXPECT_EQ(a_->proxy.translation, b_->proxy.translation);
    EXPECT_EQ(a_->proxy.rotation, b_->proxy.rotation);
    EXPECT_EQ(a_->distance, b_->distance);
    EXPECT_EQ(a_->energyToHand, b_->energyToHand);
    EXPECT_EQ(a_->fault, b_->fault);
    EXPECT_EQ(a_->contactCount, b_->contactCount);
    EXPECT_EQ(a_->isTruncated, b_->isTruncated);
    ASSERT_EQ(a_->lmdCount, b_->lmdCount);
    ASSERT_EQ(a_->storedLmds, b_->storedLmds);
    for (std::uint32_t i = 0; i < a_->storedLmds; ++i) {
      EXPECT_EQ(a_->lmds[i].other, b_->lmds[i].other);
      EXPECT_EQ(a_->lmds[i].lmd.scenePoint, b_->lmds[i].lmd.scenePoint);
      EXPECT_EQ(a_->lmds[i].lmd.partPoint, b_->lmds[i].lmd.partPoint);
      EXPECT_EQ(a_->lmds[i].lmd.isBlocked, b_->lmds[i].lmd.isBlocked);
    }
  }

  ServoParameters parameters_;
  std::shared_ptr<const ServoScene> scene_;
  SceneTracker tracker_;
  TrackedScene tracked_, anew_;
  ServoTick still_, plain_;
  const std::unique_ptr<ServoSnapshot> a_ = std::make_unique<ServoSnapshot>(),
                                       b_ = std::make_unique<ServoSnapshot>();
};

TEST_P(ServosAtRest, AStillHandFeelsToTheLastBitWhatItWouldAnew) {
  for (int i = 0; i < 30; ++i)
    tick(test::tipAt(0.08 - 0.001 * i));
  // The damping of the springs still fades.
  ticks(60, test::tipAt(0.05));
  EXPECT_EQ(a_->lmdCount, 1U);
  EXPECT_NEAR(a_->distance, 0.05, 1e-6);
  for (int i = 0; i < 20; ++i)
    tick(test::tipAt(0.05 + 0.001 * i));
  ticks(10, test::tipAt(0.07));
}

TEST_P(ServosAtRest, ASceneThatChangesUnderAStillHandIsFeltAtOnce) {
  ticks(40, test::tipAt(0.08));
  EXPECT_NEAR(a_->distance, 0.08, 1e-6);
  auto lower = std::make_shared<ServoScene>(*scene_);
  lower->bodies[0].worldFromPart.translation.z = -0.01;
  setScene(std::move(lower));
  tick(test::tipAt(0.08));
  EXPECT_NEAR(a_->distance, 0.09, 1e-6);
  ticks(20, test::tipAt(0.08));
}

TEST_P(ServosAtRest, SettingsThatChangeUnderAStillHandCountAtOnce) {
  ticks(40, test::tipAt(0.08));
  EXPECT_EQ(a_->lmdCount, 1U);
  parameters_.haptics.springs.stiffness = 80.0;
  ticks(5, test::tipAt(0.08));
  // In the proxy mode a free part pulls at nothing.
  EXPECT_NEAR(a_->unclampedWrench.force.z, GetParam() == HapticMode::Springs ? 80.0 * 0.02 : 0.0, 1e-6);
  parameters_.haptics.springs.cutoff = 0.05;
  ticks(5, test::tipAt(0.08));
  EXPECT_EQ(a_->lmdCount, 0U);
  parameters_.haptics.springs.cutoff = 0.1;
  ticks(5, test::tipAt(0.08));
  EXPECT_EQ(a_->lmdCount, 1U);
}

TEST_P(ServosAtRest, ListsThatArriveUnderAStillHandChangeNothing) {
  ticks(40, test::tipAt(0.08));
  const double distance = a_->distance;
  refresh();
  tick(test::tipAt(0.08));
  EXPECT_EQ(a_->distance, distance);
}

TEST_P(ServosAtRest, AFaultEndsTheForceAndAResetBringsBackTheSame) {
  ticks(40, test::tipAt(0.08));
  RigidTransform bad = test::tipAt(0.08);
  bad.translation.x = std::numeric_limits<double>::quiet_NaN();
  tick(bad);
  EXPECT_EQ(a_->fault, ServoFault::PoseNotFinite);
  EXPECT_EQ(a_->wrench.force, glm::dvec3(0.0));
  ticks(3, test::tipAt(0.08));
  EXPECT_EQ(a_->wrench.force, glm::dvec3(0.0));
  still_.reset();
  plain_.reset();
  ticks(40, test::tipAt(0.08));
  EXPECT_EQ(a_->fault, ServoFault::None);
  EXPECT_EQ(a_->lmdCount, 1U);
}

INSTANTIATE_TEST_SUITE_P(Modes, ServosAtRest, testing::Values(HapticMode::Springs, HapticMode::Proxy),
                         [](const auto& mode) {
                           return mode.param == HapticMode::Springs ? "Springs" : "Proxy";
                         });

}  // namespace
}  // namespace nearfit::servo_still_test
