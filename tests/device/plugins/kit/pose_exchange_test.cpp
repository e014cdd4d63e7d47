#include "device/plugins/kit/pose_exchange.h"

#include <gtest/gtest.h>

namespace nearfit::pose_exchange_test {
namespace {

constexpr double kNoTorque[3] = {0.0, 0.0, 0.0};
/// A deadline in the past: only an answer that is already there counts.
constexpr Nanoseconds kNow = 0;

void answer(plugin::PoseExchange& exchange, double force) {
  const double along[3] = {force, 0.0, 0.0};
  ASSERT_EQ(exchange.write(along, kNoTorque), 0);
}

TEST(PoseExchange, AnAnswerToAPoseIsTold) {
  plugin::PoseExchange exchange;
  exchange.publish({}, monotonicNow());
  EXPECT_FALSE(exchange.waitForWrench(kNow));
  answer(exchange, 1.0);
  EXPECT_TRUE(exchange.waitForWrench(kNow));
  EXPECT_FALSE(exchange.waitForWrench(kNow)) << "once";
}

TEST(PoseExchange, AnAnswerToThePoseBeforeIsNone) {
  // One answer that came too late once made all later ones count a pose too early: each force was a sample late.
  plugin::PoseExchange exchange;
  exchange.publish({}, monotonicNow());
  EXPECT_FALSE(exchange.waitForWrench(kNow));
  answer(exchange, 1.0);
  for (int pose = 0; pose < 3; ++pose) {
    exchange.publish({}, monotonicNow());
    EXPECT_FALSE(exchange.waitForWrench(kNow)) << pose;
    answer(exchange, 2.0);
  }
  EXPECT_TRUE(exchange.waitForWrench(kNow));
}

}  // namespace
}  // namespace nearfit::pose_exchange_test
