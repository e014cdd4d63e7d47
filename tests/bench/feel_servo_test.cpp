#include "tests/bench/feel_servo.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "device/servo/servo_loop.h"
#include "tests/support/servo_fixtures.h"

namespace nearfit::bench::feel_servo_test {
namespace {

ServoParameters proxyParameters() {
  ServoParameters parameters;
  parameters.haptics.springs.cutoff = 0.1;
  parameters.haptics.proxy.margin = 1e-3;
  return parameters;
}

FeelServo servoAt(const RigidTransform& start, ListArrival arrival) {
  const std::shared_ptr<ServoScene> scene = test::coneOverFloor();
  scene->moving.worldFromPart = start;
  return {scene, proxyParameters(), arrival, BenchClock::Thread};
}

class FeelServoOfBothArrivals : public testing::TestWithParam<ListArrival> {};

TEST_P(FeelServoOfBothArrivals, ThePartFollowsDownToTheMarginAndStaysThere) {
  FeelServo servo = servoAt(test::tipAt(0.5), GetParam());
  for (int i = 0; i <= 700; ++i) {
    const double height = 0.5 - 1e-3 * i;
    const ServoSnapshot& snapshot = servo.tick(test::tipAt(height), ServoLoop::kPeriod);
    EXPECT_FALSE(snapshot.isWaiting) << i;
    EXPECT_GT(snapshot.proxy.translation.z, 0.0) << i;
    // As far as the floor and its margin let it.
    EXPECT_NEAR(snapshot.proxy.translation.z, std::max(height, 1e-3), 1e-4) << i;
    EXPECT_GE(servo.tickTime(), 0.0);
  }
  EXPECT_FALSE(servo.refreshTimes().empty());
}

INSTANTIATE_TEST_SUITE_P(Arrivals, FeelServoOfBothArrivals,
                         testing::Values(ListArrival::AtOnce, ListArrival::InTime));

TEST(FeelServo, AnOverlapAtTheStartIsRefused) {
  FeelServo servo = servoAt(test::tipAt(-0.1), ListArrival::AtOnce);
  EXPECT_THROW(servo.tick(test::tipAt(-0.1), ServoLoop::kPeriod), Error);
}

TEST(FeelServo, AFaultIsRefused) {
  FeelServo servo = servoAt(test::tipAt(0.5), ListArrival::AtOnce);
  EXPECT_THROW(servo.tick(test::tipAt(0.4), -1.0), Error);
}

}  // namespace
}  // namespace nearfit::bench::feel_servo_test
