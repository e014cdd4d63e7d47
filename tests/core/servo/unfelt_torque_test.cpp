// Devices that sense turning and have no motors against it: a torque that cannot be shown must not become a force.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "core/servo/scene_tracker.h"
#include "core/servo/servo_tick.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::unfelt_torque_test {
namespace {

constexpr double kPeriod = 1e-3;
constexpr glm::dquat kUpright{1.0, 0.0, 0.0, 0.0};

/// A bar of 0.2 by 0.04 by 0.04, 2 mm over a floor at z = 0, or at another height, led by a Touch: force without torque.
class UnfeltTorque : public testing::Test {
 protected:
  UnfeltTorque() {
    auto scene = std::make_shared<ServoScene>();
    scene->setMoving(
        {PartId{1}, test::geometryOf(test::boxMesh({0.2, 0.04, 0.04})), {kUpright, {0.0, 0.0, kHeight}}});
    scene->bodies.push_back(
        {PartId{2}, test::geometryOf(test::boxMesh({4.0, 4.0, 1.0}, {0.0, 0.0, -0.5})), {}});
    tracker_.setScene(scene);
    // Stiff in both, so that a torque which is not shown would be large.
    parameters_.haptics.coupling = {false, 600.0, 0.1, 1.0, 1e-4};
    parameters_.limits.maxForce = 3.3;
    parameters_.limits.rotationalDamping = 1e-2;
  }
  const ServoSnapshot& tick(const glm::dquat& turn, double height = kHeight) {
    const SearchReach reach = searchReach(parameters_.haptics);
    if (snapshot_->tick > 0)
      tracker_.update({snapshot_->proxy, std::nullopt, snapshot_->isWaiting, false}, 1.0);
    if (tracker_.isDue(reach)) tracker_.refresh(reach, tracked_);
    HandleInput input;
    input.pose = {turn, {0.0, 0.0, height}};
    input.isTorqueFelt = isFelt_;
    tick_.run(tracked_, parameters_, input, kPeriod, *snapshot_);
    ++snapshot_->tick;
    mostForce_ = std::max(mostForce_, glm::length(snapshot_->wrench.force));
    mostTorque_ = std::max(mostTorque_, glm::length(snapshot_->wrench.torque));
    wasClamped_ = wasClamped_ || snapshot_->isClamped;
    return *snapshot_;
  }
  /// Turns the bar's end into the floor in half a second, and holds it there for as long.
  void turnIntoTheFloor() {
    for (int i = 0; i < 1000; ++i)
      tick(glm::angleAxis(kTurn * std::min(1.0, i / 500.0), glm::dvec3(0.0, 1.0, 0.0)));
  }
  /// As a device without motors for torque does it, or one with.
  void lead(bool isFelt) {
    isFelt_ = isFelt;
    parameters_.limits.maxTorque = isFelt ? 0.5 : 0.0;
    for (int i = 0; i < 500; ++i)
      tick(kUpright);
    mostForce_ = mostTorque_ = 0.0;
  }

  static constexpr double kHeight = 0.022, kTurn = 0.1;  // [m], [rad]: the end would be 8 mm in the floor.

  SceneTracker tracker_;
  TrackedScene tracked_;
  ServoTick tick_;
  ServoParameters parameters_;
  const std::unique_ptr<ServoSnapshot> snapshot_ = std::make_unique<ServoSnapshot>();
  bool isFelt_ = true, wasClamped_ = false;
  double mostForce_ = 0.0, mostTorque_ = 0.0;
};

/// Eight millimetres of spring would push with 4.8 N. The proxy turns as freely as the program's condition allows: about a
/// tenth of the gyration (here 58 mm) on an arm of 100 mm, 1 / (1 + (0.1 / 0.0058)^2) of the way is lifted, 16 mN. Contact
/// that comes on step by step leaves more; a fiftieth of the whole is what a hand hardly feels [N].
constexpr double kMaxLeak = 0.1;

TEST_F(UnfeltTorque, TurningIntoAFloorPushesTheHandNeitherRoundNorUp) {
  lead(false);
  turnIntoTheFloor();
  EXPECT_LT(mostForce_, kMaxLeak);
  EXPECT_EQ(mostTorque_, 0.0);
  EXPECT_FALSE(wasClamped_) << "a torque that is not shown is no force at its limit";
  // The bar gave way by turning: its lower end is on the floor.
  const glm::dvec3 end = snapshot_->proxy.applyToPoint({0.1, 0.0, -0.02});
  EXPECT_GT(end.z, 0.0);
  EXPECT_LT(end.z, 1e-3);
}

TEST_F(UnfeltTorque, ADeviceWithMotorsForItFeelsTheTurn) {
  lead(true);
  turnIntoTheFloor();
  EXPECT_GT(mostTorque_, 1e-3);
  EXPECT_GT(mostForce_, 5.0 * kMaxLeak) << "shared between both, as the coupling's energy has it";
}

TEST_F(UnfeltTorque, PushingFlatOnAFloorIsFeltAsEver) {
  lead(false);
  constexpr double kDeep = 2e-3;
  for (int i = 0; i < 1000; ++i)
    tick(kUpright, kHeight - (0.002 + kDeep) * std::min(1.0, i / 500.0));
  // The coupling's spring between the hand and the bar, which stays the margin above the floor.
  const double stretch = kDeep + parameters_.haptics.proxy.margin;
  EXPECT_NEAR(snapshot_->wrench.force.z, snapshot_->coupling.stiffness * stretch,
              0.1 * snapshot_->coupling.stiffness * stretch);
}

/// A device that does not sense turning (omega.3, Falcon): its handle stays upright, and it has no motors for torque.
TEST_F(UnfeltTorque, OffCentreADeviceOfThreeMotorsFeelsTheForceThatOneOfSixFeels) {
  auto scene = std::make_shared<ServoScene>();
  scene->setMoving(
      {PartId{1}, test::geometryOf(test::boxMesh({0.2, 0.04, 0.04})), {kUpright, {0.0, 0.0, kHeight}}});
  // Under one end of the bar only.
  scene->bodies.push_back(
      {PartId{2}, test::geometryOf(test::boxMesh({0.04, 0.2, 0.1}, {0.09, 0.0, -0.05})), {}});
  tracker_.setScene(scene);
  const auto press = [&](double maxTorque) {
    lead(true);
    parameters_.limits.maxTorque = maxTorque;
    wasClamped_ = false;
    constexpr double kDeep = 0.004;  // [m]; half of it is the gap.
    for (int i = 0; i < 1500; ++i)
      tick(kUpright, kHeight - kDeep * std::min(1.0, i / 500.0));
    const glm::dvec3 force = snapshot_->wrench.force;
    for (int i = 0; i < 500; ++i)
      tick(kUpright, kHeight - kDeep * (1.0 - i / 500.0));
    return force;
  };
  const glm::dvec3 six = press(0.5);
  EXPECT_GT(mostTorque_, 1e-3) << "it is off centre";
  EXPECT_GT(six.z, 0.1);
  const glm::dvec3 three = press(0.0);
  EXPECT_EQ(mostTorque_, 0.0);
  EXPECT_FALSE(wasClamped_) << "a torque that nothing renders is not at its limit";
  EXPECT_LT(glm::length(three - six), 0.02 * glm::length(six));
}

/// Turned into the floor, lifted out turned and turned back in the air, then down again: over a round the hand must get
/// nothing, though its turning does no work.
TEST_F(UnfeltTorque, ARoundThatTurnsAndLiftsGivesNoEnergy) {
  lead(false);
  const double before = snapshot_->energyToHand;
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 4000; ++i) {
      const double share = (i % 1000) / 1000.0;
      const int side = i / 1000;
      const double turn = side == 0 ? share : side == 1 ? 1.0 : side == 2 ? 1.0 - share : 0.0;
      const double lift = side == 0 ? 0.0 : side == 1 ? share : side == 2 ? 1.0 : 1.0 - share;
      tick(glm::angleAxis(kTurn * turn, glm::dvec3(0.0, 1.0, 0.0)), kHeight + 0.02 * lift);
    }
  }
  // What leaks of the force (above) lifts the hand by 8 mm in each of five rounds: less than a millijoule.
  EXPECT_LT(snapshot_->energyToHand - before, 1e-3);
}

}  // namespace
}  // namespace nearfit::unfelt_torque_test
