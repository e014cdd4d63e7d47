// The servo's tick in the proxy mode: what the hand feels, and what becomes of it when modes, clutch, age and
// scene change.
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "core/math/rotation_vector.h"
#include "core/servo/scene_tracker.h"
#include "core/servo/servo_tick.h"
#include "tests/support/allocation_hook.h"
#include "tests/support/joint_sets.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"
#include "tests/support/ringed_pair.h"

namespace nearfit::servo_tick_proxy_test {
namespace {

constexpr double kPeriod = 1e-3, kMargin = 1e-3;

RigidTransform at(const glm::dvec3& translation) {
  return {{1, 0, 0, 0}, translation};
}

/// A cube of side 0.2 in hand over a floor at z = 0, ticked as the servo does it.
class ServoTickWithProxy : public testing::Test {
 protected:
  ServoTickWithProxy() {
    auto scene = std::make_shared<ServoScene>();
    scene->setMoving({PartId{1}, test::geometryOf(test::boxMesh({0.2, 0.2, 0.2})), at({0.0, 0.0, 0.2})});
    scene->bodies.push_back(
        {PartId{2}, test::geometryOf(test::boxMesh({4.0, 4.0, 1.0}, {0.0, 0.0, -0.5})), {}});
    setScene(scene);
    parameters_.haptics.springs.cutoff = 0.05;
    parameters_.haptics.proxy.margin = kMargin;
  }

  void setScene(const std::shared_ptr<const ServoScene>& scene) {
    scene_ = scene;
    tracker_.setScene(scene);
  }

  const ServoSnapshot& tick(const RigidTransform& device, double age = 0.0, bool isClutched = false) {
    const SearchReach reach = searchReach(parameters_.haptics);
    if (snapshot_->tick > 0)
      tracker_.update({snapshot_->proxy, std::nullopt, snapshot_->isWaiting, false}, 1.0);
    if (tracker_.isDue(reach)) tracker_.refresh(reach, tracked_);
    tick_.run(tracked_, parameters_, {.pose = device, .age = age, .isClutched = isClutched}, kPeriod,
              *snapshot_);
    ++snapshot_->tick;
    return *snapshot_;
  }
  const ServoSnapshot& letGo(const RigidTransform& device) {
    tick_.run(tracked_, parameters_, {.pose = device, .returnsToPart = true}, kPeriod, *snapshot_);
    ++snapshot_->tick;
    return *snapshot_;
  }
  const ServoSnapshot& hold(const RigidTransform& device, int ticks) {
    for (int i = 0; i < ticks; ++i)
      tick(device);
    return *snapshot_;
  }

  /// Leads the hand down to a pose in half a second, turned from the start, and holds still there.
  const ServoSnapshot& press(const RigidTransform& device) {
    constexpr int kTicks = 500;
    const glm::dvec3 above(0.0, 0.0, 0.1);
    for (int i = 0; i < kTicks; ++i)
      tick({device.rotation, device.translation + (1.0 - static_cast<double>(i) / kTicks) * above});
    return hold(device, kTicks);
  }

  std::shared_ptr<const ServoScene> scene_;
  SceneTracker tracker_;
  TrackedScene tracked_;
  ServoTick tick_;
  ServoParameters parameters_;
  const std::unique_ptr<ServoSnapshot> snapshot_ = std::make_unique<ServoSnapshot>();
};

/// A cube that springs let into the floor was said to be clear of it by the distance of the surfaces.
TEST_F(ServoTickWithProxy, SpringsSayWhatThePartOverlapsAndWhereThatIsNotKnown) {
  parameters_.haptics.mode = HapticMode::Springs;
  // The cube's bottom is 10 mm above the floor.
  const ServoSnapshot& s = hold(at({0.0, 0.0, 0.11}), 20);
  EXPECT_EQ(s.overlappingCount, 0U);
  EXPECT_FALSE(s.isOverlapUnknown);
  EXPECT_NEAR(s.distance, 0.01, 1e-12);

  // 30 mm into it at once: the search ahead has not seen that yet.
  tick(at({0.0, 0.0, 0.07}));
  EXPECT_TRUE(s.isOverlapUnknown);
  hold(at({0.0, 0.0, 0.07}), 20);
  ASSERT_EQ(s.overlappingCount, 1U);
  EXPECT_EQ(s.overlapping[0], PartId{2});
  EXPECT_FALSE(s.isOverlapUnknown);

  // Wholly inside, where no surface is within the cutoff.
  hold(at({0.0, 0.0, -0.5}), 20);
  EXPECT_EQ(s.overlappingCount, 1U);
  EXPECT_FALSE(s.isOverlapUnknown);

  hold(at({0.0, 0.0, 0.12}), 20);
  EXPECT_EQ(s.overlappingCount, 0U);
  EXPECT_FALSE(s.isOverlapUnknown);
  EXPECT_NEAR(s.distance, 0.02, 1e-12);
}

TEST_F(ServoTickWithProxy, AJointIsFeltAsASpringAcrossItAndNotAlongIt) {
  auto scene = std::make_shared<ServoScene>(*scene_);
  const RigidTransform start = scene->moving.worldFromPart;
  scene->setJoints(test::jointSetOf({test::keptAt(JointKind::OnAxis, start, start.translation)}, start));
  setScene(scene);
  hold(start, 20);
  const glm::dvec3 aside(0.003, 0.0, 0.0);
  const ServoSnapshot& s = hold({glm::angleAxis(0.2, glm::dvec3(0, 0, 1)), start.translation + aside}, 1500);
  EXPECT_EQ(s.jointCount, 1U);
  EXPECT_FALSE(s.areJointsContradictory);
  EXPECT_LT(s.offJoints.distance, 1e-9);
  EXPECT_LT(s.offJoints.angle, 1e-9);
  // The part turns with the hand and stays on the axis; the coupling draws the hand back to it.
  EXPECT_LT(glm::length(glm::dvec2(s.proxy.translation)), 1e-9);
  EXPECT_NEAR(rotationVector(s.proxy.rotation).z, 0.2, 1e-6);
  const glm::dvec3 expected = -s.coupling.stiffness * aside;
  EXPECT_GT(glm::length(expected), 0.0);
  EXPECT_LT(glm::distance(s.unclampedWrench.force, expected), 1e-6 * glm::length(expected));
  EXPECT_LT(glm::length(s.unclampedWrench.torque), 1e-9);
}

TEST_F(ServoTickWithProxy, JointsThatContradictEachOtherAreToldAndNotFelt) {
  auto scene = std::make_shared<ServoScene>(*scene_);
  const RigidTransform start = scene->moving.worldFromPart;
  JointSet::Placed far = test::keptAt(JointKind::ToPoint, start, start.translation);
  far.place.x = 0.5;
  scene->setJoints(
      test::jointSetOf({test::keptAt(JointKind::ToPoint, start, start.translation), far}, start));
  setScene(scene);
  const ServoSnapshot& s = hold(start, 20);
  EXPECT_TRUE(s.areJointsContradictory);
  EXPECT_EQ(s.jointCount, 0U);
  EXPECT_EQ(s.unclampedWrench.force, glm::dvec3(0.0));
}

TEST_F(ServoTickWithProxy, FreeMotionAndRestAreFeltAsExactlyNothing) {
  for (int i = 0; i < 500; ++i) {
    const ServoSnapshot& s =
        tick({glm::angleAxis(0.002 * i, glm::dvec3(0, 0, 1)),
              {0.05 * std::sin(0.01 * i), 0.0, 0.2 + 0.01 * (1.0 - std::cos(0.02 * i))}});
    ASSERT_EQ(s.proxy.translation, s.handle.translation);
    ASSERT_EQ(s.wrench.force, glm::dvec3(0.0)) << i;
    ASSERT_EQ(s.wrench.torque, glm::dvec3(0.0)) << i;
  }
}

TEST_F(ServoTickWithProxy, LettingGoTakesTheHandleToThePartAndLeadsItOnFromThere) {
  parameters_.haptics.coupling = {.isAutomatic = false, .stiffness = 500.0};
  tick(at({0.0, 0.0, 0.2}));
  // What rests is a hundredth of the margin within it.
  const double slack = 0.02 * kMargin;
  // Its bottom is 8 mm in the floor, where the part does not follow.
  const double rest = hold(at({0.0, 0.0, 0.092}), 300).proxy.translation.z;
  ASSERT_NEAR(rest, 0.1 + kMargin, slack);
  ASSERT_GT(snapshot_->unclampedWrench.force.z, 500.0 * 8e-3);
  const ServoSnapshot& free = letGo(at({0.0, 0.0, 0.092}));
  EXPECT_NEAR(free.handle.translation.z, rest, slack);
  EXPECT_NEAR(free.proxy.translation.z, rest, slack);
  EXPECT_LT(glm::length(free.unclampedWrench.force), 500.0 * slack) << "not even damping of the way back";
  // Up by 2 mm from there, at once: not by what it had pressed before.
  EXPECT_NEAR(hold(at({0.0, 0.0, 0.094}), 300).proxy.translation.z, rest + 2e-3, slack);
}

TEST_F(ServoTickWithProxy, ThePressedHandIsPushedBackByTheCouplingsStiffness) {
  parameters_.haptics.coupling = {.isAutomatic = false, .stiffness = 500.0};
  const ServoSnapshot& s = hold(at({0.0, 0.0, 0.1 + kMargin - 0.01}), 600);
  EXPECT_NEAR(s.proxy.translation.z, 0.1 + kMargin, 0.02 * kMargin);
  EXPECT_NEAR(s.wrench.force.z, 500.0 * 0.01, 500.0 * 0.02 * kMargin);
  EXPECT_NEAR(s.wrench.force.x, 0.0, 1e-9);
  EXPECT_EQ(s.mode, HapticMode::Proxy);
  EXPECT_GE(s.contactCount, 1U);
  double held = 0.0;
  for (std::size_t i = 0; i < s.storedContacts; ++i) {
    EXPECT_EQ(s.contacts[i].other, PartId{2});
    EXPECT_NEAR(s.contacts[i].direction.z, 1.0, 1e-9);
    held += s.contacts[i].force;
  }
  EXPECT_NEAR(held, s.wrench.force.z, 0.05);
}

/// Force and torque were clamped apart: a peg pressed hard and askew in its hole dragged by 7 % of the force.
TEST_F(ServoTickWithProxy, APressBeyondTheMaxForceActsThroughTheContact) {
  parameters_.limits.maxForce = 4.0;
  tick(at({0.0, 0.0, 0.2}));
  // Tilted, and one edge 20 mm in the floor.
  const glm::dquat tilt = glm::angleAxis(0.5, glm::dvec3(1, 0, 0));
  const ServoSnapshot& s = press({tilt, {0.0, 0.0, 0.1 * (std::cos(0.5) + std::sin(0.5)) - 0.02}});
  const glm::dvec3 edge = s.proxy.rotation * glm::dvec3(0.0, -0.1, -0.1);
  ASSERT_NEAR((s.proxy.translation + edge).z, kMargin, 0.02 * kMargin);
  ASSERT_GT(s.unclampedWrench.force.z, 1.1 * 4.0);
  EXPECT_TRUE(s.isClamped);
  EXPECT_LE(glm::length(s.wrench.force), 4.0);
  const double torque = edge.y * s.wrench.force.z;
  EXPECT_GT(std::abs(torque), 0.05);
  EXPECT_NEAR(s.wrench.torque.x, torque, 0.01 * std::abs(torque));
}

/// The proxy stopped where the turn to the hand had no part left along what was free, which for a large turn is not where
/// the torque has none.
TEST_F(ServoTickWithProxy, ALargeTurnAgainstAContactIsNotFeltAlongWhatIsFree) {
  auto scene = std::make_shared<ServoScene>(*scene_);
  const PartGeometryPtr box = test::solidGeometryOf(test::boxMesh({0.08, 0.2, 0.05}));
  box->tree();
  scene->setMoving({PartId{1}, box, at({0.0, 0.0, 0.2})});
  setScene(scene);
  parameters_.limits.maxForce = 100.0;
  tick(at({0.0, 0.0, 0.2}));
  // Pressed flat on the floor, so that it may turn about z alone.
  const glm::dquat tilt = rotationOf({0.35, 0.3, 0.4});
  const ServoSnapshot& s = press({tilt, {0.0, 0.0, 0.025 - 0.04}});
  ASSERT_NEAR((s.proxy.rotation * glm::dvec3(0.0, 0.0, 1.0)).z, 1.0, 1e-6);
  EXPECT_GT(glm::length(s.wrench.torque), 0.05);
  EXPECT_LT(std::abs(s.wrench.torque.z), 1e-3 * glm::length(s.wrench.torque));
}

TEST_F(ServoTickWithProxy, StiffnessIsHeldToTheBoundOfTheDevice) {
  parameters_.haptics.coupling = {.isAutomatic = false, .stiffness = 1e5};
  const ServoSnapshot& s = tick(at({0.0, 0.0, 0.2}));
  EXPECT_TRUE(s.coupling.isHeldToBound);
  EXPECT_LE(s.coupling.stiffness, stiffnessBound(parameters_.limits.damping, 0.0, kPeriod));
  EXPECT_GT(s.coupling.stiffness, 0.0);
}

TEST_F(ServoTickWithProxy, APressedHandIsFadedInAndNeverJoltedByTheSlewLimit) {
  parameters_.limits.forceSlew = 100.0;
  double before = 0.0;
  for (int i = 0; i < 800; ++i) {
    const double force = tick(at({0.0, 0.0, 0.09})).wrench.force.z;
    EXPECT_LE(std::abs(force - before), 100.0 * kPeriod + 1e-12) << i;
    before = force;
  }
  EXPECT_GT(before, 5.0);
}

TEST_F(ServoTickWithProxy, StaleInputFadesToNothingAndComesBack) {
  hold(at({0.0, 0.0, 0.095}), 600);
  const double full = snapshot_->wrench.force.z;
  ASSERT_GT(full, 1.0);
  for (int i = 0; i < 200; ++i)
    tick(at({0.0, 0.0, 0.095}), 0.001 * i);
  EXPECT_EQ(snapshot_->wrench.force.z, 0.0);
  hold(at({0.0, 0.0, 0.095}), 600);
  EXPECT_NEAR(snapshot_->wrench.force.z, full, 1e-6);
}

/// The part went 17 mm into the floor when a hand that pressed changed to springs.
TEST_F(ServoTickWithProxy, AChangeOfModeBringsTheHandleBackToThePart) {
  // Its bottom is 10 mm in the floor, where the part does not follow.
  hold(at({0.0, 0.0, 0.09}), 300);
  const double rest = snapshot_->proxy.translation.z;
  ASSERT_GT(rest, 0.1);
  ASSERT_GT(snapshot_->wrench.force.z, 1.0);
  parameters_.haptics.mode = HapticMode::Springs;
  const ServoSnapshot& s = hold(at({0.0, 0.0, 0.09}), 5);
  EXPECT_EQ(s.mode, HapticMode::Springs);
  EXPECT_NEAR(s.handle.translation.z, rest, 1e-12);
  EXPECT_NEAR(s.proxy.translation.z, rest, 1e-12);
  hold(at({0.0, 0.0, 0.092}), 5);
  EXPECT_NEAR(s.proxy.translation.z, rest + 2e-3, 1e-12) << "it leads on from there";
  hold(at({0.0, 0.0, 0.09}), 5);
  parameters_.haptics.mode = HapticMode::Proxy;
  hold(at({0.0, 0.0, 0.09}), 100);
  EXPECT_EQ(s.overlappingCount, 0U);
  EXPECT_NEAR(s.proxy.translation.z, rest, 0.02 * kMargin);
}

TEST_F(ServoTickWithProxy, AChangeOfModeRampsTheForceUpFromZero) {
  hold(at({0.0, 0.0, 0.101 + kMargin}), 600);
  parameters_.haptics.mode = HapticMode::Springs;
  const double first = glm::length(tick(at({0.0, 0.0, 0.101 + kMargin})).wrench.force);
  EXPECT_LT(first, 1e-6);
  EXPECT_GT(glm::length(hold(at({0.0, 0.0, 0.101 + kMargin}), 400).wrench.force), 0.1);
}

TEST_F(ServoTickWithProxy, ModesChangeLiveAndAPartThatSpringsLeftInsideIsReleased) {
  tick(at({0.0, 0.0, 0.2}));
  parameters_.haptics.mode = HapticMode::Springs;
  tick(at({0.0, 0.0, 0.2}));
  const ServoSnapshot& s = hold(at({0.0, 0.0, 0.09}), 5);
  EXPECT_EQ(s.mode, HapticMode::Springs);
  EXPECT_EQ(s.proxy.translation.z, 0.09) << "through the floor, as springs let it";
  parameters_.haptics.mode = HapticMode::Proxy;
  hold(at({0.0, 0.0, 0.09}), 10);
  EXPECT_EQ(s.overlappingCount, 1U);
  EXPECT_EQ(s.overlapping[0], PartId{2});
  EXPECT_EQ(s.proxy.translation.z, 0.09);
  hold(at({0.0, 0.0, 0.15}), 100);
  EXPECT_EQ(s.overlappingCount, 0U);
  hold(at({0.0, 0.0, 0.05}), 100);
  EXPECT_NEAR(s.proxy.translation.z, 0.1 + kMargin, 0.02 * kMargin);
}

TEST_F(ServoTickWithProxy, WhileClutchedThePartStaysAndNothingIsFelt) {
  hold(at({0.0, 0.0, 0.095}), 600);
  const RigidTransform there = snapshot_->handle;
  for (int i = 0; i < 100; ++i)
    tick(at({0.001 * i, 0.0, 0.095}), 0.0, true);
  EXPECT_EQ(snapshot_->handle.translation, there.translation);
  EXPECT_EQ(snapshot_->wrench.force, glm::dvec3(0.0));
  hold(at({0.099, 0.0, 0.095}), 600);
  EXPECT_NEAR(snapshot_->handle.translation.x, 0.0, 1e-12) << "goes on from where it was";
  EXPECT_GT(snapshot_->wrench.force.z, 1.0);
}

TEST_F(ServoTickWithProxy, LockedAxesAndScaleActOnTheHandle) {
  tick(at({0.0, 0.0, 0.2}));
  parameters_.haptics.mapping.scale = 0.5;
  parameters_.haptics.mapping.translationLocks = {true, false, false};
  tick(at({0.0, 0.0, 0.2}));
  const ServoSnapshot& s = hold(at({0.1, 0.1, 0.2}), 100);
  EXPECT_NEAR(s.proxy.translation.x, 0.0, 1e-12);
  EXPECT_NEAR(s.proxy.translation.y, 0.05, 1e-12);
}

TEST_F(ServoTickWithProxy, WeightHangsInTheHandAndRestsOnTheFloor) {
  auto heavy = std::make_shared<ServoScene>(*scene_);
  heavy->mass = 0.2;
  setScene(heavy);
  parameters_.haptics.weight.hasWeight = true;
  const double weight = 0.2 * 9.80665;
  hold(at({0.0, 0.0, 0.3}), 800);
  EXPECT_NEAR(snapshot_->wrench.force.z, -weight, 1e-6);
  EXPECT_NEAR(snapshot_->proxy.translation.z, 0.3 - weight / snapshot_->coupling.stiffness, 1e-9);
  // Set down: a hand at the part's own height feels none of it.
  const double rest = 0.1 + kMargin;
  hold(at({0.0, 0.0, rest}), 800);
  EXPECT_NEAR(snapshot_->wrench.force.z, 0.0, 0.02 * kMargin * snapshot_->coupling.stiffness);
}

TEST_F(ServoTickWithProxy, InertiaResistsAndThePartComesToRestAtTheHand) {
  auto heavy = std::make_shared<ServoScene>(*scene_);
  heavy->mass = 0.5;
  setScene(heavy);
  parameters_.haptics.weight.hasInertia = true;
  hold(at({0.0, 0.0, 0.3}), 1500);
  tick(at({0.002, 0.0, 0.3}));
  EXPECT_LT(snapshot_->proxy.translation.x, 0.001) << "it lags behind a jerk";
  EXPECT_LT(snapshot_->wrench.force.x, -0.5) << "which the hand feels";
  hold(at({0.002, 0.0, 0.3}), 3000);
  EXPECT_NEAR(snapshot_->proxy.translation.x, 0.002, 5e-5) << "within a decay of mass over damping";
}

TEST_F(ServoTickWithProxy, AFaultSilencesAndHoldsThePartUntilReset) {
  hold(at({0.0, 0.0, 0.095}), 400);
  ASSERT_GT(snapshot_->wrench.force.z, 1.0);
  const RigidTransform before = snapshot_->proxy;
  RigidTransform bad = at({0.0, 0.0, 0.095});
  bad.translation.x = std::numeric_limits<double>::quiet_NaN();
  const ServoSnapshot& s = tick(bad);
  EXPECT_EQ(s.fault, ServoFault::PoseNotFinite);
  EXPECT_EQ(s.wrench.force, glm::dvec3(0.0));
  EXPECT_EQ(s.deviceWrench.force, glm::dvec3(0.0));
  hold(at({0.3, 0.0, 0.3}), 20);
  EXPECT_EQ(s.fault, ServoFault::PoseNotFinite) << "latched";
  EXPECT_EQ(s.proxy.translation, before.translation);
  EXPECT_NE(std::string(faultReason(s.fault)), "");
  tick_.reset();
  EXPECT_EQ(hold(at({0.0, 0.0, 0.3}), 3).fault, ServoFault::None);
}

TEST_F(ServoTickWithProxy, WhatIsFeltIsThereBeforeWhatIsShownAndDoesNotChangeByIt) {
  hold(at({0.0, 0.0, 0.095}), 400);
  tick_.feel(tracked_, parameters_, {.pose = at({0.0, 0.0, 0.094})}, kPeriod, *snapshot_);
  const ServoSnapshot felt = *snapshot_;
  EXPECT_GT(felt.deviceWrench.force.z, 1.0);
  EXPECT_EQ(felt.lmdCount, 0U) << "nobody has looked for minima yet";
  EXPECT_EQ(felt.contactCount, 0U);

  tick_.show(tracked_, parameters_, *snapshot_);
  EXPECT_EQ(snapshot_->deviceWrench.force, felt.deviceWrench.force);
  EXPECT_EQ(snapshot_->deviceWrench.torque, felt.deviceWrench.torque);
  EXPECT_LT(snapshot_->proxy.translation.z, felt.proxy.translation.z)
      << "it follows once the wrench is known";
  EXPECT_EQ(snapshot_->lmdCount, 1U);
  EXPECT_NEAR(snapshot_->distance, snapshot_->proxy.translation.z - 0.1, 1e-9)
      << "the cube's gap to the floor";
  EXPECT_GT(snapshot_->contactCount, 0U);
}

/// A tick cannot look at all minima of crowded bodies: the nearest may be missing.
TEST_F(ServoTickWithProxy, ADistanceThatIsOnlyABoundIsSaidToBeOne) {
  EXPECT_FALSE(hold(at({0.0, 0.0, 0.103}), 5).isDistanceBound);
  auto ringed = std::make_shared<ServoScene>();
  const test::RingedPair pair{.detail = 4};
  ringed->setMoving({PartId{1}, test::geometryOf(pair.rod()), {}});
  ringed->bodies.push_back({PartId{2}, test::geometryOf(pair.tube()), {}});
  setScene(ringed);
  tick_.reset();
  LmdScratch scratch;
  std::vector<Lmd> lmds(1U << 15);
  int bounds = 0;
  for (int i = 0; i < 30; ++i) {
    const ServoSnapshot& s = tick(at({0.0002 * i, 0.0, 0.0}));
    const LmdResult all = findLmds(ringed->bodies[0].geometry->tree(), ringed->moving.geometry->tree(),
                                   s.proxy, parameters_.haptics.springs.cutoff, scratch, lmds);
    ASSERT_GT(all.count, 0U);
    if (s.isDistanceBound)
      EXPECT_LE(s.distance, lmds[0].distance + 1e-12) << i;
    else
      EXPECT_NEAR(s.distance, lmds[0].distance, 1e-12) << i;
    bounds += s.isDistanceBound ? 1 : 0;
  }
  EXPECT_GT(bounds, 0);
}

TEST_F(ServoTickWithProxy, TicksThatNobodyIsShownAreFeltAllTheSame) {
  hold(at({0.0, 0.0, 0.095}), 400);
  const glm::dvec3 force = snapshot_->wrench.force;
  for (int i = 0; i < 20; ++i)
    tick_.feel(tracked_, parameters_, {.pose = at({0.0, 0.0, 0.095})}, kPeriod, *snapshot_);
  EXPECT_NEAR(snapshot_->wrench.force.z, force.z, 1e-6 * force.z);
  EXPECT_EQ(snapshot_->fault, ServoFault::None);
}

TEST_F(ServoTickWithProxy, ABadPoseOfAnotherBodyIsAFaultBeforeAnythingIsFelt) {
  hold(at({0.0, 0.0, 0.095}), 400);
  const RigidTransform before = snapshot_->proxy;
  auto broken = std::make_shared<ServoScene>(*scene_);
  broken->bodies[0].worldFromPart.translation.z = std::numeric_limits<double>::quiet_NaN();
  tracked_.scene = broken;
  tick_.feel(tracked_, parameters_, {.pose = at({0.0, 0.0, 0.09})}, kPeriod, *snapshot_);
  EXPECT_EQ(snapshot_->fault, ServoFault::PoseNotFinite);
  EXPECT_EQ(snapshot_->deviceWrench.force, glm::dvec3(0.0));
  EXPECT_EQ(snapshot_->proxy.translation, before.translation);
}

TEST_F(ServoTickWithProxy, SenselessSettingsAreAFault) {
  const ServoParameters good = parameters_;
  const auto faultWith = [&](auto change) {
    parameters_ = good;
    change(parameters_);
    tick_.reset();
    return tick(at({0.0, 0.0, 0.2})).fault;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, std::numeric_limits<double>::infinity(), -1.0}) {
    EXPECT_EQ(faultWith([&](ServoParameters& p) { p.haptics.proxy.margin = bad; }),
              ServoFault::ParametersInvalid);
    EXPECT_EQ(faultWith([&](ServoParameters& p) { p.haptics.proxy.friction = bad; }),
              ServoFault::ParametersInvalid);
    EXPECT_EQ(faultWith([&](ServoParameters& p) { p.haptics.coupling.stiffness = bad; }),
              ServoFault::ParametersInvalid);
    EXPECT_EQ(faultWith([&](ServoParameters& p) { p.haptics.mapping.scale = bad; }),
              ServoFault::ParametersInvalid);
    EXPECT_EQ(faultWith([&](ServoParameters& p) { p.limits.damping = bad; }), ServoFault::ParametersInvalid);
  }
  EXPECT_EQ(faultWith([&](ServoParameters& p) { p.haptics.weight.gravity.x = nan; }),
            ServoFault::ParametersInvalid);
  EXPECT_EQ(faultWith([](ServoParameters&) {}), ServoFault::None);
}

TEST_F(ServoTickWithProxy, AHandThatPressesAndLetsGoGetsNoMoreThanTheDevicesDampingTakes) {
  // A sampled spring gives more than it took, by K T / 2 for each speed squared and second: within the bound
  // of stability that is less than the device's own damping.
  double taken = 0.0, before = 0.11;
  for (int i = 0; i < 4000; ++i) {
    const double height = 0.11 - 0.01 * (1.0 - std::cos(0.004 * i));
    const double energy = tick(at({0.0, 0.0, height})).energyToHand;
    taken += parameters_.limits.damping * (height - before) * (height - before) / kPeriod;
    before = height;
    ASSERT_LE(energy, taken + 1e-12) << i;
  }
  EXPECT_GT(taken, 1e-4);
}

TEST_F(ServoTickWithProxy, TicksInContactAllocateNothing) {
  hold(at({0.0, 0.0, 0.09}), 50);
  test::resetAllocationCount();
  test::startCountingAllocations();
  for (int i = 0; i < 50; ++i) {
    tick_.run(tracked_, parameters_, {.pose = at({0.001 * i, 0.0, 0.09 - 0.001 * i})}, kPeriod, *snapshot_);
  }
  test::stopCountingAllocations();
  EXPECT_EQ(test::countedAllocations(), 0U);
}

}  // namespace
}  // namespace nearfit::servo_tick_proxy_test
