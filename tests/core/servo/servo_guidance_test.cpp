// Guidance as the servo renders it.
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/servo/scene_tracker.h"
#include "core/servo/servo_tick.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::servo_guidance_test {
namespace {

constexpr double kPeriod = 1e-3;
constexpr GuidanceSettings kPull{80.0, 1.0, 0.04};

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

/// A cube in hand, far from anything, and a path along x.
class ServoGuidance : public testing::Test {
 protected:
  ServoGuidance() {
    auto scene = std::make_shared<ServoScene>();
    scene->setMoving({PartId{1}, test::geometryOf(test::boxMesh({0.2, 0.2, 0.2})), at({0.0, 0.0, 0.0})});
    scene->guidance = std::make_shared<const GuidancePath>(
        std::vector<GuidancePose>{{{-1, 0, 0}}, {{0, 0, 0}}, {{1, 0, 0}}}, kPull);
    setScene(scene);
  }
  void setScene(const std::shared_ptr<const ServoScene>& scene) {
    scene_ = scene;
    tracker_.setScene(scene);
    tracker_.refresh(searchReach(parameters_.haptics), tracked_);
  }
  const ServoSnapshot& tick(const glm::dvec3& hand, const glm::dquat& turn = {1, 0, 0, 0}) {
    tick_.run(tracked_, parameters_, {.pose = {turn, hand}}, kPeriod, *snapshot_);
    ++snapshot_->tick;
    return *snapshot_;
  }

  ServoParameters parameters_;
  std::shared_ptr<const ServoScene> scene_;
  SceneTracker tracker_;
  TrackedScene tracked_;
  ServoTick tick_;
  const std::unique_ptr<ServoSnapshot> snapshot_ = std::make_unique<ServoSnapshot>();
};

TEST_F(ServoGuidance, PullsTheHandToThePathAndNotAlongIt) {
  for (int i = 0; i < 200; ++i)
    tick({0.0, 0.0, 0.0});
  for (int i = 0; i < 500; ++i)
    tick({0.3, 0.005, 0.0});
  const ServoSnapshot& s = tick({0.3, 0.005, 0.0});
  // 80 N/m at 5 mm; the device's bound of 2000 N/m leaves 200 N/m.
  EXPECT_NEAR(s.guidance.force.y, -0.4, 1e-9);
  EXPECT_NEAR(s.guidance.force.x, 0.0, 1e-12);
  EXPECT_NEAR(s.unclampedWrench.force.y, -0.4, 1e-6) << "nothing else is felt";
  EXPECT_EQ(tick({0.3, 0.5, 0.0}).guidance.force, glm::dvec3(0.0)) << "the hand has left it";
}

TEST_F(ServoGuidance, TurnsTheHandToThePath) {
  constexpr double kAngle = 0.1;
  const glm::dquat turn = glm::angleAxis(kAngle, glm::dvec3(0, 0, 1));
  for (int i = 0; i < 200; ++i)
    tick({0.0, 0.0, 0.0});
  for (int i = 0; i < 500; ++i)
    tick({0.3, 0.0, 0.0}, turn);
  const ServoSnapshot& s = tick({0.3, 0.0, 0.0}, turn);
  // A radian counts as 40 mm: 80 N/m times the square of that, by the sine of an angle as GuidancePath measures it.
  EXPECT_NEAR(s.guidance.torque.z, -80.0 * 0.04 * 0.04 * 2.0 * std::sin(kAngle / 2.0), 1e-9);
  EXPECT_NEAR(glm::length(s.guidance.force), 0.0, 1e-12);
  EXPECT_NEAR(s.unclampedWrench.torque.z, s.guidance.torque.z, 1e-6) << "nothing else is felt";
  EXPECT_EQ(tick({0.3, 0.0, 0.0}, glm::angleAxis(1.2, glm::dvec3(0, 0, 1))).guidance.torque, glm::dvec3(0.0));
}

TEST_F(ServoGuidance, ADeviceWithoutTorqueIsGuidedInPlaceAlone) {
  parameters_.limits.maxTorque = 0.0;
  const glm::dquat turn = glm::angleAxis(2.0, glm::dvec3(0, 0, 1));
  for (int i = 0; i < 700; ++i)
    tick({0.3, 0.005, 0.0}, turn);
  const ServoSnapshot& s = tick({0.3, 0.005, 0.0}, turn);
  EXPECT_NEAR(s.guidance.force.y, -0.4, 1e-9) << "it cannot help its turn";
  EXPECT_EQ(s.guidance.torque, glm::dvec3(0.0));
}

TEST_F(ServoGuidance, WithoutAPathNothingPulls) {
  auto scene = std::make_shared<ServoScene>(*scene_);
  scene->guidance = nullptr;
  setScene(scene);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(tick({0.0, 0.005, 0.0}).guidance.force, glm::dvec3(0.0));
}

TEST_F(ServoGuidance, AHandThatWandersAboutGainsNoEnergy) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi);
  const double a = phase(random), b = phase(random);
  double most = 0.0, sampled = 0.0;
  glm::dvec3 before(0.0);
  for (int i = 0; i < 20'000; ++i) {
    const double t = kPeriod * i;
    const glm::dvec3 hand(0.5 * std::sin(0.7 * t + a), 0.03 * std::sin(9.0 * t),
                          0.03 * std::sin(13.0 * t + b));
    // A spring that is held while the hand moves gives at most K / 2 times the square of the step across the path.
    const glm::dvec3 step = i > 0 ? hand - before : glm::dvec3(0.0);
    sampled += 0.5 * kPull.stiffness * (step.y * step.y + step.z * step.z);
    before = hand;
    most = std::max(most, tick(hand).energyToHand - sampled);
  }
  // The hand starts beside the path and may get that energy once; and once more while the pull fades in.
  EXPECT_LT(most, 2.0 * guidanceEnergy(kPull, kPull.reach));
}

TEST_F(ServoGuidance, TicksAllocateNothing) {
  for (int i = 0; i < 100; ++i)
    tick({0.001 * i, 0.005, 0.0});
  test::resetAllocationCount();
  test::startCountingAllocations();
  for (int i = 0; i < 200; ++i)
    tick({0.1 + 0.001 * i, 0.005, 0.0});
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
}

}  // namespace
}  // namespace nearfit::servo_guidance_test
