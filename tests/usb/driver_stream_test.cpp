#include <gtest/gtest.h>

#include "tests/usb/driver_fixture.h"
#include "tests/usb/pace.h"

namespace nearfit::driver_stream_test {
namespace {

using test::eventually;

class DriverStreams : public test::EachDriver {};

TEST_P(DriverStreams, FiveThousandReportsAreEachTakenAndAnsweredWithACommand) {
  constexpr int kCount = 5000;
  bringUp();
  const std::uint64_t posesBefore = device->counters().poses, commandsBefore = bench->commands();
  test::Pace pace(bench->traits().rate);
  for (int i = 0; i < kCount; ++i) {
    pace.wait();
    bench->hold(i);
    ASSERT_TRUE(bench->round(*device, push, handle)) << i;
    bench->expectHeld(*device, handle, i);
    ASSERT_FALSE(HasFailure()) << i;
    ASSERT_EQ(device->state(), DeviceState::Armed) << i << ": " << device->stateNote();
    ASSERT_TRUE(handle.isArmed) << i;
  }
  EXPECT_EQ(device->counters().poses, posesBefore + kCount);
  EXPECT_EQ(device->counters().rejected, 0U);
  EXPECT_EQ(device->counters().missing, 0U);
  if (!pushes()) return;
  EXPECT_EQ(bench->commands(), commandsBefore + kCount) << "each is a command of its own";
  // The last answers the pose before it: the same once more, from where the handle is.
  ASSERT_TRUE(bench->round(*device, push, handle));
  bench->expectTold(push, handle);
  EXPECT_TRUE(bench->isPushing());
}

TEST_P(DriverStreams, ForcesGoOutOnlyWhileItIsArmed) {
  if (!pushes()) return;  // It has none.
  bringUp();
  ASSERT_TRUE(bench->round(*device, push, handle));
  ASSERT_TRUE(bench->round(*device, push, handle));
  EXPECT_TRUE(handle.isArmed);
  EXPECT_TRUE(bench->isPushing());
  device->disarm();
  ASSERT_TRUE(bench->round(*device, push, handle));
  EXPECT_FALSE(handle.isArmed);
  EXPECT_FALSE(bench->isPushing());
  device->arm();
  ASSERT_TRUE(bench->round(*device, push, handle));
  ASSERT_TRUE(bench->round(*device, push, handle));
  EXPECT_TRUE(bench->isPushing());
  bench->stopStreaming();
  device->stop();
  EXPECT_FALSE(bench->isPushing()) << "it was told so before it was closed";
}

TEST_P(DriverStreams, AStallOfItsReportsIsClearedAndNoneIsLost) {
  bringUp();
  const std::uint64_t before = device->counters().poses;
  for (int i = 0; i < 10; ++i) {
    emulated().stall(bench->traits().in);
    bench->hold(i);
    ASSERT_TRUE(bench->round(*device, push, handle));
    bench->expectHeld(*device, handle, i);
  }
  EXPECT_EQ(emulated().haltsCleared(), 10U);
  EXPECT_EQ(device->counters().poses, before + 10);
  EXPECT_EQ(device->state(), DeviceState::Armed);
}

TEST_P(DriverStreams, AStallOfItsCommandsIsClearedAndOnlyThatOneIsLost) {
  if (!pushes()) return;  // It takes no commands.
  bringUp();
  const std::uint64_t before = bench->commands();
  for (unsigned i = 0; i < 10; ++i) {
    emulated().stall(bench->traits().out);
    device->sendWrench(push);
    ASSERT_TRUE(eventually([&] { return emulated().haltsCleared() == i + 1; }));
    ASSERT_TRUE(bench->round(*device, push, handle));
  }
  EXPECT_EQ(bench->commands(), before + 10);
  EXPECT_TRUE(bench->isPushing());
  EXPECT_EQ(device->state(), DeviceState::Armed);
}

INSTANTIATE_TEST_SUITE_P(All, DriverStreams, testing::ValuesIn(test::kDriverKinds), test::nameOf);

}  // namespace
}  // namespace nearfit::driver_stream_test
