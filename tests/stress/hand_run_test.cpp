// The short form of the adversarial hand: the same as `nearfit-stress hand`, with fewer ticks.
#include "tests/stress/hand_run.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "core/haptics/passivity_controller.h"
#include "tests/stress/stress_servo.h"

namespace nearfit::stress::hand_run_test {
namespace {

/// Under sanitizers a tick takes ten times as long.
#ifdef NEARFIT_SANITIZED
constexpr std::uint64_t kShare = 12;
#else
constexpr std::uint64_t kShare = 1;
#endif

class AdversarialHand : public testing::TestWithParam<const char*> {};

TEST_P(AdversarialHand, NeverBringsThePartIntoTheScene) {
  const StressScene scene = chosenScenes(stressScenes({}), {GetParam()}).front().make();
  const HandRunResult result = runHand(scene, {.ticks = 16000 / kShare, .seed = 20});
  EXPECT_FALSE(result.failure) << *result.failure;
  EXPECT_EQ(result.meetings, 0U);
  EXPECT_GT(result.certified, result.ticks / 10);
  EXPECT_LE(result.extremes.quaternionError, kQuaternionError);
  EXPECT_GT(result.extremes.inContact, 0U);
  // The servo's account of energy is that of one who only sees what goes over the border.
  EXPECT_LT(result.ledgerError, 1e-9);
  EXPECT_TRUE(!scene.isEnergyBound || result.energyGain <= kMaxEnergyGain);
}

INSTANTIATE_TEST_SUITE_P(Stress, AdversarialHand,
                         testing::Values("peg-bore", "wedge-jam", "needle-grid", "slot-1um", "thin-wall",
                                         "thin-wall-inside", "closed-box", "sheet-box", "rings",
                                         "overlapping", "crowd", "tiny", "huge", "far", "far-mesh",
                                         "far-fine", "box-hole"),
                         [](const auto& of) {
                           std::string name = of.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// A part that may go a micrometre in a tick is left far behind, and finds a body between itself and the hand: what was
// felt ahead of it came back at once, and gave the hand 0.2 J.
TEST(AdversarialHandFarAway, GainsLittleWhereWhatItFeltAheadComesBack) {
  const StressScene scene = chosenScenes(stressScenes({}), {"far-fine"}).front().make();
  const HandRunResult result = runHand(scene, {.ticks = 120'000 / kShare, .seed = 1, .certifyEvery = 0});
  EXPECT_FALSE(result.failure) << *result.failure;
  EXPECT_LE(result.energyGain, kMaxEnergyGain);
}

TEST(AdversarialHandOnSprings, GetsAForceWithinAllLimitsAndThePartIsWhereItIs) {
  for (const StressMode mode : {StressMode::Spring, StressMode::Printed, StressMode::Grouped}) {
    for (const char* name : {"peg-bore", "thin-wall", "sheet-box", "rings", "crowd"}) {
      const StressScene scene = chosenScenes(stressScenes({}), {name}).front().make();
      const HandRunResult result = runHand(scene, {.ticks = 8000 / kShare, .seed = 20, .mode = mode});
      EXPECT_FALSE(result.failure) << nameOf(mode) << ", " << name << ": " << *result.failure;
      EXPECT_EQ(result.certified, 0U) << "the part may go through";
      EXPECT_EQ(result.extremes.lag, 0.0);
      EXPECT_GT(result.extremes.inContact, 0U) << name;
      EXPECT_GT(result.extremes.forceStep, 0.0);
      EXPECT_GT(result.extremes.heldTicks, 0U) << name << ": stiffer than the device bears, now and then";
      EXPECT_LT(result.ledgerError, 1e-9);
    }
  }
}

TEST(TickChecks, FindAPartOnSpringsThatIsNotWhereTheHandIs) {
  const auto now = std::make_unique<ServoSnapshot>();
  now->mode = HapticMode::Springs;
  const ServoParameters parameters;
  EXPECT_FALSE(faultOf(*now, *now, parameters, 1e-3));
  now->overlappingCount = 1;
  EXPECT_FALSE(faultOf(*now, *now, parameters, 1e-3)) << "springs let parts overlap";
  now->proxy.translation.x = 1e-9;
  EXPECT_TRUE(faultOf(*now, *now, parameters, 1e-3));
  TickExtremes extremes;
  const StressScene scene = linkedRings(0.1, 1e-4);
  const auto before = std::make_unique<ServoSnapshot>(*now);
  now->unclampedWrench.force = {3.0, 0.0, 4.0};
  extremes.addStep(*scene.scene, *before, *now);
  EXPECT_EQ(extremes.forceStep, 5.0);
  EXPECT_NEAR(extremes.lag, 1e-9, 1e-15);
}

TEST(StressServo, ANumberThatIsNoneLatchesAFaultAndThePartStays) {
  const StressScene scene = linkedRings(0.1, 1e-4);
  StressServo servo(scene.scene, {}, 1);
  const RigidTransform start = scene.scene->moving.worldFromPart;
  servo.tick({.pose = start}, 1e-3);
  RigidTransform bad = start;
  bad.rotation.y = std::numeric_limits<double>::quiet_NaN();
  const ServoSnapshot& s = servo.tick({.pose = bad}, 1e-3);
  EXPECT_EQ(s.fault, ServoFault::PoseNotFinite);
  servo.tick({.pose = start}, 1e-3);
  EXPECT_EQ(s.fault, ServoFault::PoseNotFinite);
  EXPECT_EQ(s.proxy.translation, start.translation);
  EXPECT_EQ(s.wrench.force, glm::dvec3(0.0));
}

}  // namespace
}  // namespace nearfit::stress::hand_run_test
