#include "tests/stress/press_trial.h"

#include <gtest/gtest.h>

namespace nearfit::stress::press_trial_test {
namespace {

bool isOfOpenSheets(const PressScene& scene) {
  return scene.name == "open-sheet" || scene.name == "cup-in-coil";
}

const PressScene& flat() {
  static const PressScene scene = pressScenes().front();
  return scene;
}

TEST(PressedHand, ComesToRestInContactsOfAllKinds) {
  for (const PressScene& scene : pressScenes()) {
    if (isOfOpenSheets(scene)) continue;  // In a test of their own.
    for (const double stiffness : {1.0, 0.0}) {
      const PressOptions options{.stiffness = stiffness};
      const PressResult result = press(scene, options);
      EXPECT_TRUE(isAtRest(result, options))
          << scene.name << ", " << stiffness << " N/m: " << result.handle << " m, " << result.force << " N";
      EXPECT_GT(result.meanForce, 0.0) << scene.name << ": it presses";
      EXPECT_TRUE(result.isKept) << scene.name << ": on its side";
    }
  }
}

TEST(PressedHand, ComesToRestWithASlowAndStutteringServo) {
  const std::vector<PressScene> scenes = pressScenes();
  for (const double period : {0.2e-3, 10e-3}) {
    // Longer where the period is, until that is known.
    const double seconds = 2.0 + 400.0 * period;
    const PressOptions options{.period = period, .isRough = true, .friction = 0.3, .seconds = seconds};
    for (const std::size_t i : {0U, 2U, 4U}) {
      const PressResult result = press(scenes[i], options);
      EXPECT_TRUE(isAtRest(result, options))
          << scenes[i].name << ", " << period << " s: " << result.handle << " m, " << result.force << " N";
    }
  }
}

TEST(PressedHand, ComesToRestOnOpenSheets) {
  int seen = 0;
  for (const PressScene& scene : pressScenes()) {
    if (!isOfOpenSheets(scene)) continue;
    ++seen;
    const PressOptions options{};
    const PressResult result = press(scene, options);
    EXPECT_TRUE(isAtRest(result, options))
        << scene.name << ": " << result.handle << " m, " << result.force << " N";
    EXPECT_GT(result.meanForce, 0.0) << scene.name << ": it presses";
  }
  EXPECT_EQ(seen, 2);
}

TEST(PressedHand, ComesToRestAtTenKilonewtonsAMetreWhereTheDeviceBearsThem) {
  // 2 b / T = 12,500 N/m.
  const PressOptions options{.stiffness = 1e4, .damping = 6.25};
  const PressResult result = press(flat(), options);
  EXPECT_EQ(result.stiffness, 1e4);
  EXPECT_TRUE(isAtRest(result, options)) << result.handle << " m, " << result.force << " N";
}

TEST(PressedHand, OnSpringsAsStiffAsTheDeviceBearsIsNotShakenAtLowRatesEither) {
  for (const StressMode mode : {StressMode::Spring, StressMode::Printed, StressMode::Grouped}) {
    for (const double rate : {1000.0, 100.0}) {
      const PressOptions options{.mode = mode, .period = 1.0 / rate, .seconds = 2.0 + 400.0 / rate};
      const PressResult result = press(flat(), options);
      EXPECT_FALSE(isShaken(result)) << nameOf(mode) << " at " << rate << " Hz: " << result.handle << " m";
      EXPECT_LT(result.springShare, 1.0) << nameOf(mode) << ": held back";
      EXPECT_EQ(result.lag, 0.0) << "the part is where the hand is";
    }
  }
}

TEST(PressedHand, OnASpringBeyondTheBoundAtAHundredHertzIsShaken) {
  // The servo is told of a damping that the device has not, and lets 4 N/mm through: K T / 2 is 20 N s/m, where hand and
  // grip have 5.
  const PressOptions told{
      .stiffness = 4000.0, .mode = StressMode::Spring, .toldDamping = 1e3, .period = 10e-3, .seconds = 6.0};
  const PressResult shaken = press(flat(), told);
  EXPECT_EQ(shaken.springShare, 1.0);
  EXPECT_TRUE(isShaken(shaken)) << shaken.handle << " m";
  EXPECT_FALSE(isAtRest(shaken, told));
  EXPECT_GT(shaken.forceStep, 0.1);
  // What it has: 2 b / T = 200 N/m.
  PressOptions honest = told;
  honest.toldDamping = 0.0;
  const PressResult held = press(flat(), honest);
  EXPECT_FALSE(isShaken(held)) << held.handle << " m";
  EXPECT_LT(held.springShare, 0.1);
}

}  // namespace
}  // namespace nearfit::stress::press_trial_test
