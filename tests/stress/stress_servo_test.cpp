#include "tests/stress/stress_servo.h"

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include "tests/bench/feel_servo.h"
#include "tests/stress/stress_scene.h"
#include "tests/support/ringed_pair.h"

namespace nearfit::stress::stress_servo_test {
namespace {

// The bench's servo once did not pass on that the proxy starved: a nut stood still there that moved
// elsewhere.
TEST(StressServo, IsTheBenchesServoWhereListsAreThereAtOnce) {
  const test::RingedPair pair{.detail = 4};
  const StressScene scene = stressScene({{pair.tube()}}, pair.rod(), {}, 0.008);
  ServoParameters parameters;
  parameters.haptics.proxy.margin = scene.margin;
  parameters.haptics.springs.cutoff = 2.6 * scene.margin;
  StressServo servo(scene.scene, parameters, 1);
  servo.setArrival(Arrival::AtOnce);
  bench::FeelServo bench(scene.scene, parameters, bench::ListArrival::AtOnce, bench::BenchClock::Wall);
  std::size_t starved = 0;
  for (int i = 0; i < 60; ++i) {
    // Turned, held, and turned faster than lists reach.
    const double angle = i < 20 ? 1e-3 * i : i < 30 ? 0.02 : 0.02 + 0.05 * (i - 30);
    const RigidTransform hand{glm::angleAxis(angle, glm::dvec3(0.0, 0.0, 1.0)), glm::dvec3(0.0)};
    const ServoSnapshot& a = servo.tick({.pose = hand}, 1e-3);
    const ServoSnapshot& b = bench.tick(hand, 1e-3);
    starved += a.isStarved ? 1 : 0;
    ASSERT_EQ(a.isStarved, b.isStarved) << i;
    ASSERT_EQ(a.proxy.rotation, b.proxy.rotation) << i;
    ASSERT_EQ(a.proxy.translation, b.proxy.translation) << i;
  }
  EXPECT_GT(starved, 0U);
  EXPECT_LT(starved, 55U);
}

}  // namespace
}  // namespace nearfit::stress::stress_servo_test
