#include "tests/stress/press_trial.h"

#include <gtest/gtest.h>

namespace nearfit::stress::press_trial_test {
namespace {

TEST(PressedHand, ComesToRestInContactsOfAllKinds) {
  for (const PressScene& scene : pressScenes()) {
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

}  // namespace
}  // namespace nearfit::stress::press_trial_test
